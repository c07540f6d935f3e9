//! Transfer of the shown pushes to an L-shaped tool: Experiment 1 of the paper, without physics.

use nalgebra::Point2;
use skills::outline::{Outline, PlacedOutline};
use skills::plan::{ActionKind, ChainTolerances, Setting};
use skills::primitive::PrimitiveConfig;
use skills::tool::{ContactSurface, SurfaceShape, Tool};
use skills::tool_use::SkillLibrary;
use skills::transfer::{Passage, RectangularReach, Side, Transfer, TransferConfig, TransferProblem, Workplace};

use crate::shown::{Script, disc, stick};

fn block(width_m: f64, height_m: f64, position_m: [f64; 2]) -> PlacedOutline {
    PlacedOutline { shape: Outline::Box { width_m, height_m }, position_m, angle_rad: 0.0 }
}

/// Tool 2 of the paper: 40 x 40 mm, 12 mm thick, held at its corner.
fn ell() -> Tool {
    let face = |name: &str, start_m, end_m| ContactSurface::new(name, SurfaceShape::Face { start_m, end_m });
    Tool {
        name: "ell".into(),
        description: String::new(),
        mass_kg: 0.01,
        friction: 0.3,
        pieces: vec![block(0.040, 0.012, [-0.014, 0.0]), block(0.012, 0.028, [0.0, -0.020])],
        surfaces: vec![
            face("bottom", [-0.034, -0.006], [-0.019, -0.006]),
            face("tip", [-0.034, 0.005], [-0.034, -0.005]),
            face("top", [-0.014, 0.006], [-0.034, 0.006]),
        ],
    }
}

fn library() -> SkillLibrary {
    let scripts =
        [0.0, 0.002, -0.002].map(|shift| Script { start: Point2::new(0.060 + shift, 0.055), ..Script::default() });
    let shown: Vec<_> = scripts.iter().map(|script| script.demonstration("shown").0).collect();
    SkillLibrary::learn(&PrimitiveConfig::default(), &shown, &stick(), &disc()).unwrap().0
}

fn transfer(library: &SkillLibrary, tool: &Tool, obstacles: &[PlacedOutline], config: &TransferConfig) -> Transfer {
    let object = disc();
    let problem = TransferProblem {
        workplace: Workplace {
            map_min: Point2::new(-0.09, 0.0),
            map_max: Point2::new(0.09, 0.18),
            obstacles,
            object_margin_m: config.object_margin_m,
            tool_margin_m: config.tool_margin_m,
            object: &object,
            object_angle_rad: 0.0,
            tool,
            tool_angle_rad: 0.0,
            tool_passes: false,
            reach: &RectangularReach { min_m: [-0.12, -0.02], max_m: [0.12, 0.16] },
        },
        config,
        start_world: Point2::new(0.060, 0.080),
        goal_world: Point2::new(-0.055, 0.110),
        home_world: Point2::new(0.110, 0.130),
        park_world: Point2::new(-0.030, 0.010),
        sides: &[],
        push_speed_m_per_s: 0.02,
        free_speed_m_per_s: 0.06,
        time_step_s: 0.002,
    };
    problem.plan(library).unwrap()
}

#[test]
fn the_papers_task_is_planned_as_the_paper_shows() {
    let (tool, obstacles, config) = (ell(), [block(0.03, 0.04, [0.0, 0.10])], TransferConfig::default());
    let library = library();
    let found = transfer(&library, &tool, &obstacles, &config);
    let surfaces: Vec<&str> =
        found.phases.phases.iter().map(|phase| tool.surfaces[phase.hold.surface].name.as_str()).collect();
    assert_eq!(surfaces, ["bottom", "tip", "top"]);
    assert_eq!(found.flips.len(), 2);
    assert_eq!(found.reference.passages, [Passage { obstacle: 0, side: Side::Below }]);
    assert_eq!(found.reference.refusal, None);
    let setting = Setting { tool: &tool, object: &disc(), obstacles: &obstacles };
    let tolerances = ChainTolerances {
        gap_m: config.approach_gap_m + 1e-4,
        // the way is C¹: twice the default for motions twice as far apart
        velocity_m_per_s: 2e-3,
        ..ChainTolerances::default()
    };
    let report = found.plan.verify(Some(&setting), &tolerances).unwrap();
    println!("{:?}", report.largest_acceleration_jump_m_per_s2());
    let end = found.plan.actions().last().unwrap().object.end().point();
    assert!((end - Point2::new(-0.055, 0.110)).norm() < 1e-9);
    let clearance = |point: &Point2<f64>| obstacles[0].signed_distance_m(point) - 0.012;
    for action in found.plan.actions() {
        let least =
            action.object.motions().iter().map(|motion| clearance(&motion.point())).fold(f64::INFINITY, f64::min);
        println!("{} {:.2} s least {least}", action.name, action.tool.duration_s());
        assert!(least >= 0.015, "{}: {least}", action.name);
        if let ActionKind::ObjectOperating(push) = action.kind {
            println!("   {push:?}");
        }
    }
    for path in [&found.reference.generalized, &found.reference.constrained] {
        let least =
            path.samples().row_iter().map(|row| clearance(&Point2::new(row[0], row[1]))).fold(f64::INFINITY, f64::min);
        println!("reference least {least} end {:?}", path.end().as_slice());
    }
    println!(
        "{:?} flips {:?}",
        found.reference.certificate.as_ref().map(|c| c.holds()),
        found
            .flips
            .iter()
            .map(|f| (f.k2, f.own_share, f.duration_s(), f.certificate.middle_clearance_m))
            .collect::<Vec<_>>()
    );
}
