//! The tool level on paths known by hand: fewest changes of surface, and what cannot be pushed.

use approx::assert_relative_eq;

use super::*;
use crate::outline::Outline;
use crate::tool::{ContactSurface, SurfaceShape};

/// A few roundings of lengths of some centimeters.
const ROUNDING_M: f64 = 1e-15;
const RADIUS_M: f64 = 0.012;

/// A bar along x that pushes backward with its lower side and forward with its upper one.
fn bar() -> Tool {
    let shape = Outline::Box { width_m: 0.04, height_m: 0.01 };
    let face = |name: &str, start_m, end_m| ContactSurface::new(name, SurfaceShape::Face { start_m, end_m });
    Tool {
        name: "bar".into(),
        description: String::new(),
        mass_kg: 0.01,
        friction: 0.3,
        pieces: vec![PlacedOutline { shape, position_m: [0.0, 0.0], angle_rad: 0.0 }],
        surfaces: vec![
            face("lower", [-0.015, -0.005], [0.015, -0.005]),
            face("upper", [0.015, 0.005], [-0.015, 0.005]),
            face("left", [-0.02, 0.004], [-0.02, -0.004]),
        ],
    }
}

fn problem(tool: &Tool) -> TwoLevelProblem<'_> {
    TwoLevelProblem { tool, object_radius_m: RADIUS_M, obstacles: &[], workspace_m: None }
}

fn path(places: &[[f64; 2]]) -> Vec<Point2<f64>> {
    places.iter().copied().map(Point2::from).collect()
}

/// Down, to the left, up: one surface for each.
const THREE_WAYS: [[f64; 2]; 4] = [[0.06, 0.08], [0.06, 0.053], [-0.055, 0.053], [-0.055, 0.11]];

#[test]
fn a_path_along_the_normals_takes_one_surface_for_each_way() {
    let plan = TwoLevelConfig::default().plan(&problem(&bar()), &path(&THREE_WAYS)).unwrap();
    let surfaces: Vec<_> = plan.phases().iter().map(|phase| (phase.surface, phase.segments)).collect();
    assert_eq!(surfaces, [(0, 1), (2, 1), (1, 1)]);
    let measures = plan.measures();
    // the four points of the paper's Table 2
    assert_eq!((measures.phases, measures.switches, measures.trajectory_points), (3, 2, 4));
    assert!(measures.is_continuous() && measures.unreachable == 0);
    // the tool is above, to the right and below; five places, the middle one is chosen for none is nearer
    let hold = plan.segments[0].hold;
    let above = hold.world_from_tool_start.translation.vector;
    assert_relative_eq!(above.y, 0.08 + RADIUS_M + 0.005, epsilon = ROUNDING_M);
    assert_relative_eq!(hold.world_from_tool_end.translation.vector.y, above.y - 0.027, epsilon = ROUNDING_M);
}

#[test]
fn a_heading_that_no_surface_faces_is_unreachable_and_says_by_how_much() {
    let to_the_right = path(&[[0.0, 0.0], [0.1, 0.0]]);
    let plan = TwoLevelConfig::default().plan(&problem(&bar()), &to_the_right).unwrap();
    let Some(Obstruction::Heading { least_rad }) = plan.segments[0].obstruction else { panic!("{plan:?}") };
    assert_relative_eq!(least_rad, std::f64::consts::FRAC_PI_2);
    // a tool that may be turned pushes anywhere
    let turned = TwoLevelConfig { turning: ToolTurning::WithHeading, ..TwoLevelConfig::default() };
    let plan = turned.plan(&problem(&bar()), &to_the_right).unwrap();
    assert_eq!((plan.measures().unreachable, plan.segments[0].obstruction), (0, None));
    assert_relative_eq!(plan.segments[0].hold.angle_rad, 0.0, epsilon = 1e-12);
}

#[test]
fn a_heading_is_pushed_up_to_the_friction_angle() {
    for (share, unreachable) in [(0.99, 0), (1.01, 1)] {
        let angle = 0.3_f64.atan() * share;
        let aslant = path(&[[0.0, 0.0], [0.1 * angle.sin(), 0.1 * angle.cos()]]);
        let plan = TwoLevelConfig::default().plan(&problem(&bar()), &aslant).unwrap();
        assert_eq!(plan.measures().unreachable, unreachable);
        let wide = TwoLevelConfig { push_angle_rad: Some(0.4), ..TwoLevelConfig::default() };
        assert_eq!(wide.plan(&problem(&bar()), &aslant).unwrap().measures().unreachable, 0);
    }
}

#[test]
fn bends_inside_a_phase_are_counted_as_jumps() {
    let bent = path(&[[0.0, 0.0], [0.0, 0.02], [0.004, 0.04], [0.004, 0.06]]);
    let fixed = TwoLevelConfig::default().plan(&problem(&bar()), &bent).unwrap().measures();
    assert_eq!((fixed.phases, fixed.trajectory_points, fixed.heading_jumps, fixed.pose_jumps), (1, 4, 2, 0));
    let turning = TwoLevelConfig { turning: ToolTurning::WithHeading, ..TwoLevelConfig::default() };
    let turned = turning.plan(&problem(&bar()), &bent).unwrap().measures();
    assert_eq!((turned.phases, turned.heading_jumps, turned.pose_jumps), (1, 2, 2));
    assert!(!fixed.is_continuous() && !turned.is_continuous());
}

#[test]
fn a_surface_is_kept_where_changing_it_would_point_better() {
    // 45° could be pushed by either surface with so wide an angle; the second segment is nearer to the other surface
    let wide = TwoLevelConfig { push_angle_rad: Some(0.9), ..TwoLevelConfig::default() };
    let aslant = path(&[[0.0, 0.0], [0.0, 0.02], [-0.012, 0.03], [-0.012, 0.05]]);
    let plan = wide.plan(&problem(&bar()), &aslant).unwrap();
    assert_eq!((plan.measures().switches, plan.measures().unreachable), (0, 0));
}

#[test]
fn obstacles_and_the_workspace_bar_poses_and_say_so() {
    let tool = bar();
    let up = path(&[[0.0, 0.05], [0.0, 0.1]]);
    // below the object, where the tool has to be
    let block =
        PlacedOutline { shape: Outline::Box { width_m: 0.2, height_m: 0.01 }, position_m: [0.0, 0.02], angle_rad: 0.0 };
    let obstacles = [block];
    let blocked = TwoLevelProblem { obstacles: &obstacles, ..problem(&tool) };
    let plan = TwoLevelConfig::default().plan(&blocked, &up).unwrap();
    assert_eq!(plan.segments[0].obstruction, Some(Obstruction::Obstacle));
    let fenced = TwoLevelProblem { workspace_m: Some(([-1.0, 0.04], [1.0, 1.0])), ..problem(&tool) };
    let plan = TwoLevelConfig::default().plan(&fenced, &up).unwrap();
    assert_eq!(plan.segments[0].obstruction, Some(Obstruction::Workspace));
    // a block at the side bars some places on the surface only
    let post = PlacedOutline { shape: Outline::Disc { radius_m: 0.005 }, position_m: [0.035, 0.06], angle_rad: 0.0 };
    let obstacles = [post];
    let beside = TwoLevelProblem { obstacles: &obstacles, ..problem(&tool) };
    let plan = TwoLevelConfig::default().plan(&beside, &up).unwrap();
    assert!(plan.segments[0].obstruction.is_none());
    assert!(plan.segments[0].hold.world_from_tool_start.translation.vector.x < 0.005);
}

#[test]
fn problems_that_are_none_are_refused() {
    let tool = bar();
    let field = |config: TwoLevelConfig, problem: &TwoLevelProblem<'_>| match config.plan(problem, &path(&THREE_WAYS)) {
        Err(SkillError::InvalidConfig(error)) => error.field,
        other => panic!("{other:?}"),
    };
    let default = TwoLevelConfig::default;
    assert_eq!(field(TwoLevelConfig { places: 0, ..default() }, &problem(&tool)), "places");
    assert_eq!(field(TwoLevelConfig { push_angle_rad: Some(2.0), ..default() }, &problem(&tool)), "push_angle_rad");
    assert_eq!(field(TwoLevelConfig { clearance_m: -1.0, ..default() }, &problem(&tool)), "clearance_m");
    let turning = ToolTurning::Fixed { angle_rad: f64::NAN };
    assert_eq!(field(TwoLevelConfig { turning, ..default() }, &problem(&tool)), "turning.fixed.angle_rad");
    assert_eq!(field(default(), &TwoLevelProblem { object_radius_m: 0.0, ..problem(&tool) }), "object_radius_m");
    let nowhere = Some(([f64::NAN; 2], [0.0; 2]));
    assert_eq!(field(default(), &TwoLevelProblem { workspace_m: nowhere, ..problem(&tool) }), "workspace_m");
    for places in [&[][..], &[[0.0, 0.0]], &[[0.0, 0.0], [0.0, 0.0]]] {
        assert!(matches!(default().plan(&problem(&tool), &path(places)), Err(SkillError::RowCount { .. })));
    }
    let bad = path(&[[0.0, 0.0], [f64::NAN, 0.0]]);
    assert!(matches!(default().plan(&problem(&tool), &bad), Err(SkillError::NonFinite { row: 1, .. })));
}
