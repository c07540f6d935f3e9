//! Cost of a transfer to the L-shaped tool of the paper: the search for phases, the reference path, the whole plan.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

#[path = "../tests/tool_use/shown.rs"]
#[allow(dead_code, clippy::unwrap_used, reason = "the demonstrations of the tests, of which some serve here")]
mod shown;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Point2;
use skills::PrimitiveConfig;
use skills::outline::{Outline, PlacedOutline};
use skills::tool::Tool;
use skills::tool::family::{Ell, ToolShape};
use skills::tool_use::SkillLibrary;
use skills::transfer::{Everywhere, PhaseSearch, Reference, SearchConfig, TransferConfig, TransferProblem, Workplace};

use shown::{Script, disc, stick};

const START: Point2<f64> = Point2::new(0.060, 0.080);
const GOAL: Point2<f64> = Point2::new(-0.055, 0.110);

fn transfer(criterion: &mut Criterion) {
    let shape = Ell::default();
    let tool = Tool { name: "l".into(), pieces: shape.pieces(), surfaces: shape.surfaces(), ..stick() };
    let outline = Outline::Box { width_m: 0.030, height_m: 0.040 };
    let obstacles = [PlacedOutline { shape: outline, position_m: [0.0, 0.100], angle_rad: 0.0 }];
    let (object, config) = (disc(), TransferConfig::default());
    let (shown, _) = Script::default().demonstration("shown");
    let (library, _) =
        SkillLibrary::learn(&PrimitiveConfig::default(), &[shown], &stick(), &object).expect("skills are learned");
    let workplace = Workplace {
        map_min: Point2::new(-0.09, 0.0),
        map_max: Point2::new(0.09, 0.18),
        obstacles: &obstacles,
        object_margin_m: config.object_margin_m,
        tool_margin_m: config.tool_margin_m,
        object: &object,
        object_angle_rad: 0.0,
        tool: &tool,
        tool_angle_rad: 0.0,
        tool_passes: false,
        reach: &Everywhere,
    };
    let problem = TransferProblem {
        workplace: workplace.clone(),
        config: &config,
        start_world: START,
        goal_world: GOAL,
        home_world: Point2::new(0.110, 0.130),
        park_world: Point2::new(-0.030, 0.010),
        sides: &[],
        push_speed_m_per_s: 0.02,
        free_speed_m_per_s: 0.06,
        time_step_s: 0.002,
    };
    let reference = || Reference::new(&workplace, &config, &library.intention, START, GOAL, &[]).expect("a reference");
    let points = reference().points();
    let mut group = criterion.benchmark_group("transfer");
    group.bench_function("reference", |bench| bench.iter(reference));
    for cell_m in [0.001, 0.002] {
        let search = SearchConfig { cell_m, ..SearchConfig::default() };
        group.bench_function(format!("search, cells of {cell_m} m"), |bench| {
            bench.iter(|| {
                let mut search = PhaseSearch::new(&workplace, &search, &points, START, GOAL).expect("a search");
                search.solve().expect("phases")
            });
        });
    }
    group.bench_function("whole plan", |bench| bench.iter(|| problem.plan(&library).expect("a plan")));
    group.finish();
}

criterion_group!(benches, transfer);
criterion_main!(benches);
