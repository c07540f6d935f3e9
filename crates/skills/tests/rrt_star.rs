//! RRT* and two-level planning on the map of the paper's first experiment: what its comparison counts, over many seeds.

#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

use std::sync::LazyLock;

use nalgebra::Point2;
use skills::SkillError;
use skills::baseline::{
    FreeSpace, PathMeasures, RrtStar, RrtStarConfig, ToolTurning, TwoLevelConfig, TwoLevelProblem, shortcut,
};
use skills::outline::{Outline, PlacedOutline};
use skills::tool::{ContactSurface, SurfaceShape, Tool};

const SEEDS: u64 = 40;
/// Looks along a path lie this far apart, m; a distance changes no faster than the place.
const LOOK_M: f64 = 1e-4;
/// The searches with the paper's parameters.
static FOUND: LazyLock<Vec<RrtStar>> =
    LazyLock::new(|| (0..SEEDS).map(|seed| search(&RrtStarConfig::default(), &space(), seed)).collect());

fn start() -> Point2<f64> {
    Point2::new(0.060, 0.080)
}

fn goal() -> Point2<f64> {
    Point2::new(-0.055, 0.110)
}

fn obstacle() -> PlacedOutline {
    let shape = Outline::Box { width_m: 0.030, height_m: 0.040 };
    PlacedOutline { shape, position_m: [0.0, 0.100], angle_rad: 0.0 }
}

/// The object, of radius 12 mm, stays inside the map and keeps 15 mm from the obstacle.
fn space() -> FreeSpace {
    FreeSpace::new([-0.078, 0.012], [0.078, 0.168], 0.027, &[obstacle()]).unwrap()
}

fn search(config: &RrtStarConfig, space: &FreeSpace, seed: u64) -> RrtStar {
    RrtStarConfig { seed, ..config.clone() }.search(space, start(), goal()).unwrap()
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    (numbers[(numbers.len() - 1) / 2] + numbers[numbers.len() / 2]) / 2.0
}

/// Tool 2 of the paper: an L of 40 × 40 mm; bottom, tip and top of its arm push down, to the left and up.
fn corner() -> Tool {
    let arm = |width_m, height_m, position_m| PlacedOutline {
        shape: Outline::Box { width_m, height_m },
        position_m,
        angle_rad: 0.0,
    };
    let face = |name: &str, start_m, end_m| ContactSurface::new(name, SurfaceShape::Face { start_m, end_m });
    Tool {
        name: "corner".into(),
        description: String::new(),
        mass_kg: 0.007,
        friction: 0.3,
        pieces: vec![arm(0.040, 0.012, [-0.014, 0.0]), arm(0.012, 0.028, [0.0, -0.020])],
        surfaces: vec![
            face("bottom", [-0.034, -0.006], [-0.019, -0.006]),
            face("tip", [-0.034, 0.005], [-0.034, -0.005]),
            face("top", [-0.014, 0.006], [-0.034, 0.006]),
        ],
    }
}

#[test]
fn the_paper_s_parameters_always_reach_the_goal_but_never_meet_it() {
    for found in &*FOUND {
        assert!(found.reached && found.measures.goal_error_m <= 0.002);
        assert_eq!((found.counts.nodes, found.branches.len()), (1400, 1399));
        assert!(found.path[0] == start() && found.measures.nodes == found.path.len());
    }
    // the shortest way into the tolerance ends short of the goal itself, up to a lucky seed
    let missed = FOUND.iter().filter(|found| found.measures.goal_error_m > 1e-6).count();
    assert!(missed as u64 * 2 > SEEDS, "{missed}");
}

#[test]
fn the_paper_s_count_of_points_comes_of_its_parameters() {
    // an independent Python program found medians of 25 nodes and 17.0 cm; the paper states 22 points. Bands are twice the
    // spread of the median over samples of six seeds, as many as that program ran: nodes err by 2, the length by 5 mm
    let of = |measure: fn(&PathMeasures) -> f64| median(FOUND.iter().map(|found| measure(&found.measures)).collect());
    let (nodes, length_m) = (of(|measures| measures.nodes as f64), of(|measures| measures.length_m));
    assert!((21.0..=29.0).contains(&nodes), "{nodes}");
    assert!((0.160..=0.180).contains(&length_m), "{length_m}");
    let points: Vec<usize> = FOUND.iter().map(|found| found.measures.trajectory_points()).collect();
    assert!(points.iter().any(|points| *points <= 22) && points.iter().any(|points| *points >= 22), "{points:?}");
    // no way is shorter than the straight lines over a point straight below the obstacle at its clearance
    let below = Point2::new(0.0, 0.053);
    let least_m = (start() - below).norm() + (goal() - below).norm() - 0.002;
    assert!(FOUND.iter().all(|found| found.measures.length_m > least_m));
}

#[test]
fn every_path_and_shortcut_keeps_its_clearance_at_a_dense_look() {
    for found in &*FOUND {
        let short = shortcut(&found.path, &space(), 0.002).unwrap();
        for pair in found.path.windows(2).chain(short.windows(2)) {
            let looks = ((pair[1] - pair[0]).norm() / LOOK_M).ceil().max(1.0) as usize;
            for look in 0..=looks {
                let at = pair[0] + (pair[1] - pair[0]) * (look as f64 / looks as f64);
                assert!(obstacle().signed_distance_m(&at) >= 0.027 - 1e-12, "{at}");
                assert!(at.x.abs() <= 0.078 && (0.012..=0.168).contains(&at.y), "{at}");
            }
        }
    }
}

#[test]
fn a_shortcut_needs_few_of_the_points_and_is_no_longer() {
    let mut points = Vec::new();
    for found in &*FOUND {
        let measures = PathMeasures::new(&shortcut(&found.path, &space(), 0.002).unwrap(), &goal());
        assert!(measures.length_m <= found.measures.length_m && measures.goal_error_m == found.measures.goal_error_m);
        points.push(measures.trajectory_points() as f64);
    }
    // the task itself asks for few: the paper's count is that of its sampling
    assert!(median(points.clone()) <= 8.0, "{points:?}");
}

#[test]
fn the_same_seed_grows_the_same_tree_and_another_one_another() {
    assert_eq!(search(&RrtStarConfig::default(), &space(), 7), FOUND[7]);
    assert!(FOUND[7].branches != FOUND[8].branches);
}

#[test]
fn more_nodes_of_one_seed_never_lengthen_the_way() {
    // the smaller tree is the beginning of the larger one, and rewiring only shortens
    for seed in 0..SEEDS / 4 {
        let lengths = [700, 1400, 2800].map(|nodes| {
            let found = search(&RrtStarConfig { nodes, ..RrtStarConfig::default() }, &space(), seed);
            if found.reached { found.measures.length_m } else { f64::INFINITY }
        });
        assert!(lengths.windows(2).all(|pair| pair[1] <= pair[0] + 1e-12), "{lengths:?}");
    }
}

#[test]
fn the_work_per_node_stays_level_as_the_tree_grows() {
    // neighbors are limited in number, so that only finding them grows, with log n in a k-d tree
    let per_node = |nodes: usize| {
        let counts = search(&RrtStarConfig { nodes, ..RrtStarConfig::default() }, &space(), 3).counts;
        (counts.checked_ways as f64 / nodes as f64, counts.samples as f64 / nodes as f64)
    };
    let (few, many) = (per_node(700), per_node(5600));
    assert!(many.0 <= 8.0 && many.0 < 1.5 * few.0 && many.1 < 1.5 * few.1, "{few:?} {many:?}");
}

#[test]
fn the_cost_of_a_node_is_the_length_of_its_way() {
    for found in &*FOUND {
        // a tree: every branch begins where another one ends, or at the root
        let mut at = *found.path.last().unwrap();
        let mut length_m = 0.0;
        while at != start() {
            let branch = found.branches.iter().find(|branch| branch[1] == at).unwrap();
            length_m += (at - branch[0]).norm();
            at = branch[0];
        }
        assert!((length_m - found.measures.length_m).abs() < 1e-12);
    }
}

#[test]
fn a_goal_that_is_not_reached_is_approached_and_said_to_be_missed() {
    let few = search(&RrtStarConfig { nodes: 50, ..RrtStarConfig::default() }, &space(), 0);
    assert!(!few.reached && few.measures.goal_error_m > 0.002);
    // a wall all across: the samples run out on this side
    let wall =
        PlacedOutline { shape: Outline::Box { width_m: 0.01, height_m: 0.2 }, position_m: [0.0, 0.09], angle_rad: 0.0 };
    let split = FreeSpace::new([-0.078, 0.012], [0.078, 0.168], 0.012, &[wall]).unwrap();
    let found = search(&RrtStarConfig { samples_per_node: 2, ..RrtStarConfig::default() }, &split, 0);
    assert!(!found.reached && found.path.iter().all(|place| place.x >= 0.017 - 1e-12));
}

#[test]
fn searches_that_make_no_sense_are_refused_by_field() {
    let field = |config: RrtStarConfig, from, to| match config.search(&space(), from, to) {
        Err(SkillError::InvalidConfig(error)) => error.field,
        other => panic!("{other:?}"),
    };
    let default = RrtStarConfig::default;
    assert_eq!(field(RrtStarConfig { step_m: 0.0, ..default() }, start(), goal()), "step_m");
    assert_eq!(field(RrtStarConfig { goal_bias: 1.5, ..default() }, start(), goal()), "goal_bias");
    assert_eq!(field(RrtStarConfig { nodes: 0, ..default() }, start(), goal()), "nodes");
    assert_eq!(field(RrtStarConfig { samples_per_node: 0, ..default() }, start(), goal()), "samples_per_node");
    assert_eq!(field(RrtStarConfig { neighbor_radius_m: f64::NAN, ..default() }, start(), goal()), "neighbor_radius_m");
    assert_eq!(field(default(), Point2::new(0.0, 0.1), goal()), "start");
    assert_eq!(field(default(), start(), Point2::new(0.5, f64::NAN)), "goal");
}

#[test]
fn two_level_planning_on_sampled_paths_breaks_its_phases() {
    let (tool, obstacles) = (corner(), [obstacle()]);
    let workspace_m = Some(([-0.12, 0.0], [0.12, 0.16]));
    let problem = TwoLevelProblem { tool: &tool, object_radius_m: 0.012, obstacles: &obstacles, workspace_m };
    let (mut reachable, mut points) = (0, Vec::new());
    let mut phases = Vec::new();
    for found in &*FOUND {
        let fixed = TwoLevelConfig::default().plan(&problem, &found.path).unwrap().measures();
        assert_eq!(fixed.trajectory_points, found.measures.trajectory_points());
        assert!(!fixed.is_continuous());
        phases.push(fixed.phases as f64);
        reachable += usize::from(fixed.unreachable == 0);
        let turning = TwoLevelConfig { turning: ToolTurning::WithHeading, ..TwoLevelConfig::default() };
        let turned = turning.plan(&problem, &found.path).unwrap().measures();
        // a tool that is turned along each segment jumps wherever the heading does
        assert!(turned.pose_jumps >= turned.heading_jumps && turned.unreachable <= fixed.unreachable);
        points.push(fixed.trajectory_points as f64);
    }
    // the paper shows three phases; where headings waver about 45° there are more
    assert!((3.0..=5.0).contains(&median(phases)));
    // the paper's "may yes": headings between the normals cannot be pushed
    assert_eq!(reachable, 0);
    assert!((18.0..=30.0).contains(&median(points)));
    // the paper's own path: three surfaces, four points, nothing unreachable
    let shown = [[0.060, 0.080], [0.060, 0.053], [-0.055, 0.053], [-0.055, 0.110]].map(Point2::from);
    let plan = TwoLevelConfig::default().plan(&problem, &shown).unwrap();
    let measures = plan.measures();
    assert_eq!((measures.phases, measures.trajectory_points, measures.unreachable), (3, 4, 0), "{plan:?}");
    assert!(measures.is_continuous());
}
