//! Tasks that cannot be planned are refused with what is in the way, and degenerate ones never break the planner.

use nalgebra::Point2;
use skills::tool_use::{Orientation, PlanError, PushProblem};
use skills::{DmpForm, SkillError};

use crate::planning::{ONE, SHORTEST_PUSH_M, assert_sound, learn, problem};
use crate::shown::{SIDE, Script, stick};

/// Rounding of lengths of some centimeters.
const ROUNDING_M: f64 = 1e-9;

fn refused(problem: &PushProblem<'_>) -> PlanError {
    problem.plan(&ONE).unwrap_err()
}

#[test]
fn a_goal_that_needs_a_pull_is_refused_by_surface_and_length() {
    let right = PushProblem { goal_world: Point2::new(0.095, 0.125), ..problem() };
    let error = refused(&right);
    assert!(error.to_string().contains("-0.0300 m of push with the surface 'side'"), "{error}");
    let PlanError::Pull { surface, length_m } = error else { panic!("{error}") };
    assert!(surface == "side" && (length_m + 0.03).abs() < ROUNDING_M, "{surface} {length_m}");

    let back = PushProblem { goal_world: Point2::new(-0.055, 0.030), ..problem() };
    let PlanError::Pull { surface, length_m } = refused(&back) else { panic!("a surface cannot pull") };
    assert!(surface == "head" && (length_m + 0.02).abs() < ROUNDING_M, "{surface} {length_m}");
}

#[test]
fn a_goal_in_a_missing_direction_is_refused_by_what_is_missing() {
    let library = learn(DmpForm::Residual, &[Script { pushes: vec![(SIDE, 0.1)], ..Script::default() }]);
    let PlanError::Directions { miss_m } = problem().plan(&library).unwrap_err() else {
        panic!("a direction is missing")
    };
    assert!((miss_m - 0.075).abs() < ROUNDING_M, "{miss_m}");
    let with_task = PushProblem { orientation: Orientation::WithTask, ..problem() };
    assert_sound(&with_task, &with_task.plan(&library).unwrap());
}

#[test]
fn an_object_at_its_goal_is_refused() {
    for orientation in [Orientation::Fixed, Orientation::WithTask] {
        for off_m in [0.0, 0.0019] {
            let start_world = problem().goal_world + nalgebra::Vector2::new(off_m, 0.0);
            let error = refused(&PushProblem { start_world, orientation, ..problem() });
            assert!(matches!(error, PlanError::AtGoal { least_m: SHORTEST_PUSH_M, .. }), "{error}");
        }
    }
}

#[test]
fn a_tool_without_the_surface_that_was_shown_is_refused() {
    let mut short = stick();
    short.surfaces.pop();
    let error = refused(&PushProblem { tool: &short, ..problem() });
    assert_eq!(error, PlanError::Surface { surface: 1, tool: "stick".into(), surfaces: 1 });
    short.surfaces.clear();
    let error = refused(&PushProblem { tool: &short, ..problem() });
    assert_eq!(error, PlanError::Surface { surface: 0, tool: "stick".into(), surfaces: 0 });
}

#[test]
fn numbers_that_are_none_are_refused_by_name() {
    let argument = |problem: &PushProblem<'_>| match refused(problem) {
        PlanError::Skill(SkillError::InvalidArgument { argument, .. }) => argument,
        other => panic!("{other}"),
    };
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let place = Point2::new(0.0, bad);
        assert_eq!(argument(&PushProblem { start_world: place, ..problem() }), "start_world");
        assert_eq!(argument(&PushProblem { goal_world: place, ..problem() }), "goal_world");
        assert_eq!(argument(&PushProblem { home_world: place, ..problem() }), "home_world");
        assert_eq!(argument(&PushProblem { park_world: place, ..problem() }), "park_world");
    }
    for bad in [f64::NAN, f64::INFINITY, 0.0, -0.02] {
        assert_eq!(argument(&PushProblem { push_speed_m_per_s: bad, ..problem() }), "push_speed_m_per_s");
        assert_eq!(argument(&PushProblem { free_speed_m_per_s: bad, ..problem() }), "free_speed_m_per_s");
        assert_eq!(argument(&PushProblem { time_step_s: bad, ..problem() }), "time_step_s");
    }
}

#[test]
fn a_plan_of_endless_length_is_refused_before_it_is_made() {
    for problem in [
        PushProblem { push_speed_m_per_s: 1e-12, ..problem() },
        PushProblem { free_speed_m_per_s: 1e-300, ..problem() },
        PushProblem { time_step_s: 1e-12, ..problem() },
        PushProblem { home_world: Point2::new(-1e9, 1e9), ..problem() },
    ] {
        let error = refused(&problem);
        assert!(matches!(error, PlanError::Skill(SkillError::InvalidArgument { .. })), "{error}");
    }
}

#[test]
fn home_and_park_may_be_anywhere_even_at_the_hold() {
    for place in [problem().start_world, problem().goal_world, Point2::new(5.0, -5.0)] {
        let problem = PushProblem { home_world: place, park_world: place, ..problem() };
        assert_sound(&problem, &problem.plan(&ONE).unwrap());
    }
}
