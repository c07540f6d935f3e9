//! Cost of learning a tool flip, of its certified generalization, and of the factors of Eqs. (26) and (27).

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Isometry2, dvector};
use skills::DmpConfig;
use skills::outline::{Outline, PlacedOutline};
use skills::tool::{ContactSurface, SurfaceShape, Tool};
use skills::tool_flipping::factors::FactorKind;
use skills::tool_flipping::{FlipOptions, FlipTask, SecondFactor, ShownFlip, ToolFlip};

const MARGIN_M: f64 = 0.0035;

/// Tool 2 of the paper: an L of 40 x 40 mm.
fn l_tool() -> Tool {
    let bar = |width_m, height_m, position_m| PlacedOutline {
        shape: Outline::Box { width_m, height_m },
        position_m,
        angle_rad: 0.0,
    };
    let face = |name: &str, start_m, end_m| ContactSurface::new(name, SurfaceShape::Face { start_m, end_m });
    Tool {
        name: "L".into(),
        description: String::new(),
        mass_kg: 0.01,
        friction: 0.3,
        pieces: vec![bar(0.04, 0.012, [-0.014, 0.0]), bar(0.012, 0.04, [0.0, -0.014])],
        surfaces: vec![
            face("bottom", [-0.034, -0.006], [-0.019, -0.006]),
            face("tip", [-0.034, 0.005], [-0.034, -0.005]),
            face("top", [-0.014, 0.006], [-0.034, 0.006]),
        ],
    }
}

fn objects() -> [(&'static str, Outline); 3] {
    let vertices_m = vec![[-0.008, -0.006], [0.007, -0.007], [0.011, 0.002], [0.002, 0.009], [-0.007, 0.006]];
    [
        ("disc", Outline::Disc { radius_m: 0.012 }),
        ("box", Outline::Box { width_m: 0.016, height_m: 0.010 }),
        ("polygon", Outline::Polygon { vertices_m }),
    ]
}

fn task<'a>(tool: &'a Tool, object: &'a Outline, turn_rad: f64) -> FlipTask<'a> {
    let [bottom, tip, _] = tool.surfaces.as_slice() else { unreachable!("three surfaces") };
    FlipTask {
        tool,
        object,
        object_world: Isometry2::translation(0.06, 0.053),
        contacts: [bottom.middle(), tip.middle()],
        tool_angles_rad: [0.0, turn_rad],
        duration_s: 2.0,
    }
}

fn learning(criterion: &mut Criterion) {
    let (tool, [(_, disc), ..]) = (l_tool(), objects());
    let task = task(&tool, &disc, 0.0);
    let options = FlipOptions { margin_m: 0.007, k2: SecondFactor::Fixed(1.0), ..FlipOptions::default() };
    let track = task.flip(&options).and_then(|flip| Ok(flip.tool_track(0.01)?)).expect("a free flip");
    let poses: Vec<_> = track.motions().iter().map(|motion| motion.pose()).collect();
    let shown = ShownFlip {
        tool: &tool,
        object: &disc,
        object_world: task.object_world,
        tool_world: &poses,
        contacts: task.contacts,
    };
    let learn = || ToolFlip::learn(&DmpConfig::default(), &[shown], MARGIN_M).expect("a flip");
    criterion.bench_function("learn flip", |bencher| bencher.iter(learn));
    let skill = learn();
    criterion.bench_function("generalize learned flip, disc", |bencher| {
        bencher.iter(|| skill.generalize(black_box(&task), &FlipOptions::default()).expect("a free flip"));
    });
}

fn generalization(criterion: &mut Criterion) {
    let tool = l_tool();
    let whole = FlipOptions { k2: SecondFactor::Fixed(1.0), ..FlipOptions::default() };
    for (name, object) in &objects() {
        for (turns, turn_rad) in [("kept", 0.0), ("turned", 1.0)] {
            let task = task(&tool, object, turn_rad);
            criterion.bench_function(&format!("certified k2 = 1, {name}, {turns}"), |bencher| {
                bencher.iter(|| black_box(&task).flip(&whole).expect("a free flip"));
            });
            criterion.bench_function(&format!("smallest k2, {name}, {turns}"), |bencher| {
                bencher.iter(|| black_box(&task).flip(&FlipOptions::default()).expect("a free flip"));
            });
        }
    }
}

fn factors(criterion: &mut Criterion) {
    let (a, b) = (dvector![-3.0, 1.0], dvector![-1.0, 2.0]);
    for kind in [FactorKind::Literal, FactorKind::Complex, FactorKind::Similarity] {
        criterion.bench_function(&format!("factor {kind:?}"), |bencher| {
            bencher.iter(|| kind.factor(black_box(&a), black_box(&b), 1.0).expect("a factor"));
        });
    }
}

criterion_group!(benches, learning, generalization, factors);
criterion_main!(benches);
