//! Cost of planning: RRT* by number of nodes, the tool level on its path, making a plan of skills and verifying it.
//!
//! The search is O(n log n) in its nodes: time over n·log n should stay level from 350 to 5600 of them.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

#[path = "../tests/tool_use/shown.rs"]
#[allow(dead_code, clippy::unwrap_used, reason = "the demonstrations of the tests, of which some serve here")]
mod shown;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::Point2;
use skills::PrimitiveConfig;
use skills::baseline::{FreeSpace, RrtStarConfig, TwoLevelConfig, TwoLevelProblem, shortcut};
use skills::outline::{Outline, PlacedOutline};
use skills::plan::{ChainTolerances, Setting};
use skills::tool_use::{Orientation, PushProblem, SkillLibrary};

use shown::{Script, disc, stick};

const START: Point2<f64> = Point2::new(0.060, 0.080);
const GOAL: Point2<f64> = Point2::new(-0.055, 0.110);

/// The obstacle of the paper's first experiment.
fn obstacle() -> PlacedOutline {
    let shape = Outline::Box { width_m: 0.030, height_m: 0.040 };
    PlacedOutline { shape, position_m: [0.0, 0.100], angle_rad: 0.0 }
}

fn space() -> FreeSpace {
    FreeSpace::new([-0.078, 0.012], [0.078, 0.168], 0.027, &[obstacle()]).expect("a valid space")
}

fn rrt_star(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("rrt star");
    let space = space();
    for nodes in [350, 700, 1400, 2800, 5600] {
        let config = RrtStarConfig { nodes, ..RrtStarConfig::default() };
        group.bench_function(BenchmarkId::new("nodes", nodes), |bench| {
            bench.iter(|| config.search(&space, START, GOAL).expect("a search"));
        });
    }
    let found = RrtStarConfig::default().search(&space, START, GOAL).expect("a search");
    group.bench_function("shortcut", |bench| bench.iter(|| shortcut(&found.path, &space, 0.002).expect("a path")));
    let (tool, obstacles) = (stick(), [obstacle()]);
    let problem = TwoLevelProblem { tool: &tool, object_radius_m: 0.012, obstacles: &obstacles, workspace_m: None };
    let config = TwoLevelConfig::default();
    group.bench_function("tool level", |bench| bench.iter(|| config.plan(&problem, &found.path).expect("a path")));
    group.finish();
}

fn chain(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("plan of skills");
    let (tool, object) = (stick(), disc());
    let demonstrations = [Script::default().demonstration("shown").0];
    let (library, _) =
        SkillLibrary::learn(&PrimitiveConfig::default(), &demonstrations, &tool, &object).expect("skills to learn");
    let problem = PushProblem {
        start_world: Point2::new(0.065, 0.050),
        goal_world: Point2::new(-0.055, 0.125),
        home_world: Point2::new(0.100, 0.010),
        park_world: Point2::new(-0.060, 0.020),
        object: &object,
        tool: &tool,
        orientation: Orientation::Fixed,
        push_speed_m_per_s: 0.02,
        free_speed_m_per_s: 0.08,
        time_step_s: 0.002,
    };
    group.bench_function("made", |bench| bench.iter(|| problem.plan(&library).expect("a plan")));
    let plan = problem.plan(&library).expect("a plan");
    let setting = Setting { tool: &tool, object: &object, obstacles: &[] };
    let tolerances = ChainTolerances::default();
    group.bench_function("verified", |bench| {
        bench.iter(|| plan.verify(Some(&setting), &tolerances).expect("a strict chain"));
    });
    group.finish();
}

criterion_group!(benches, rrt_star, chain);
criterion_main!(benches);
