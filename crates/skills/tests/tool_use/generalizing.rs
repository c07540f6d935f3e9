//! Skills carried over to other tasks: turned, with pushes that are not needed, with surfaces used twice, with any ends.

use approx::assert_relative_eq;
use nalgebra::{Point2, Rotation2, Vector2};
use proptest::prelude::*;
use skills::DmpForm;
use skills::tool_use::{Orientation, PushProblem};

use crate::planning::{
    EXACT_M, ONE, SEVERAL, SHORTEST_PUSH_M, assert_clear, assert_near, assert_sound, learn, names, problem, pushes,
};
use crate::shown::{HEAD, SIDE, Script};

#[test]
fn a_task_that_is_turned_turns_the_whole_plan() {
    let (about, turn) = (Point2::new(0.02, 0.07), Rotation2::new(25_f64.to_radians()));
    let turned = |point: Point2<f64>| about + turn * (point - about);
    let straight = PushProblem { orientation: Orientation::WithTask, ..problem() };
    let rotated = PushProblem {
        start_world: turned(straight.start_world),
        goal_world: turned(straight.goal_world),
        home_world: turned(straight.home_world),
        park_world: turned(straight.park_world),
        ..straight.clone()
    };
    let (plan, rotated) = (straight.plan(&SEVERAL).unwrap(), rotated.plan(&SEVERAL).unwrap());
    assert_eq!(names(&plan), names(&rotated));
    for (action, rotated) in plan.actions().iter().zip(rotated.actions()) {
        assert_eq!(action.tool.motions().len(), rotated.tool.motions().len());
        for (before, after) in action.tool.motions().iter().zip(rotated.tool.motions()) {
            assert_near(turned(before.point()), after.point(), EXACT_M);
            assert_relative_eq!(after.position.z - before.position.z, turn.angle(), epsilon = EXACT_M);
            assert_relative_eq!(turn * before.velocity.xy(), after.velocity.xy(), epsilon = EXACT_M);
            assert_relative_eq!(turn * before.acceleration.xy(), after.acceleration.xy(), epsilon = 1e-6);
        }
        for (before, after) in action.object.motions().iter().zip(rotated.object.motions()) {
            assert_near(turned(before.point()), after.point(), EXACT_M);
        }
    }
}

#[test]
fn a_tool_that_turns_with_the_task_stretches_all_pushes_alike() {
    let with_task = PushProblem { orientation: Orientation::WithTask, ..problem() };
    let plan = with_task.plan(&ONE).unwrap();
    let lengths: Vec<f64> = pushes(&plan).iter().map(|(_, push)| (push.to_world - push.from_world).norm()).collect();
    let shown: Vec<f64> = ONE.pushes.iter().map(|push| push.displacement.norm()).collect();
    assert_relative_eq!(lengths[0] / lengths[1], shown[0] / shown[1], max_relative = 1e-6);
}

#[test]
fn a_push_that_the_task_does_not_need_is_left_out_with_its_hold() {
    for library in [&*ONE, &*SEVERAL] {
        let ahead = PushProblem { goal_world: Point2::new(0.065, 0.125), ..problem() };
        let plan = ahead.plan(library).unwrap();
        assert_eq!(names(&plan), ["approach head", "push head", "withdraw"]);
        assert_sound(&ahead, &plan);
        assert_near(plan.actions()[2].object.end().point(), ahead.goal_world, EXACT_M);
        assert_clear(&plan);

        let (start_world, goal_world) = (Point2::new(0.065, 0.090), Point2::new(-0.055, 0.090));
        // as far below the object as it was shown
        let park_world = Point2::new(-0.060, -0.020);
        let aside = PushProblem { start_world, goal_world, park_world, ..problem() };
        let plan = aside.plan(library).unwrap();
        assert_eq!(names(&plan), ["approach side", "push side", "withdraw"]);
        assert_sound(&aside, &plan);
        assert_near(plan.actions()[2].object.end().point(), aside.goal_world, EXACT_M);
        assert_clear(&plan);
    }
}

#[test]
fn a_displacement_too_short_for_a_push_or_too_small_a_pull_is_left() {
    for aside_m in [-0.0019, 0.0019] {
        let problem = PushProblem { goal_world: Point2::new(0.065 + aside_m, 0.125), ..problem() };
        let plan = problem.plan(&ONE).unwrap();
        assert_eq!(names(&plan), ["approach head", "push head", "withdraw"]);
        assert_near(plan.actions()[2].object.end().point(), Point2::new(0.065, 0.125), EXACT_M);
    }
}

#[test]
fn one_push_can_be_planned_for_a_start_that_a_camera_saw() {
    let library = learn(DmpForm::Residual, &[Script { pushes: vec![(HEAD, 0.06)], ..Script::default() }]);
    let seen = PushProblem {
        start_world: Point2::new(0.0604, 0.055),
        goal_world: Point2::new(0.060, 0.120),
        park_world: Point2::new(0.100, 0.010),
        ..problem()
    };
    let plan = seen.plan(&library).unwrap();
    assert_sound(&seen, &plan);
    assert_near(plan.actions()[2].object.end().point(), seen.goal_world, SHORTEST_PUSH_M);
}

#[test]
fn a_surface_that_is_used_twice_shares_as_it_was_shown() {
    let script = Script { pushes: vec![(HEAD, 0.02), (SIDE, 0.08), (HEAD, 0.04)], ..Script::default() };
    let plan = problem().plan(&learn(DmpForm::Residual, &[script])).unwrap();
    assert_sound(&problem(), &plan);
    let lengths: Vec<f64> = pushes(&plan).iter().map(|(_, push)| (push.to_world - push.from_world).norm()).collect();
    // 15 mm more than shown are shared alike
    assert_relative_eq!(lengths.iter().sum::<f64>(), 0.195, epsilon = EXACT_M);
    assert_relative_eq!(lengths[2] - lengths[0], 0.02, epsilon = 0.001);
}

fn place() -> impl Strategy<Value = Point2<f64>> {
    (-0.3f64..0.3, -0.3f64..0.3).prop_map(|(x, y)| Point2::new(x, y))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_task_has_a_sound_plan_or_is_refused(
        start in place(), goal in place(), home in place(), park in place(), with_task in any::<bool>(),
    ) {
        let orientation = if with_task { Orientation::WithTask } else { Orientation::Fixed };
        let problem = PushProblem {
            start_world: start, goal_world: goal, home_world: home, park_world: park, orientation, ..problem()
        };
        match problem.plan(&ONE) {
            Ok(plan) => {
                assert_sound(&problem, &plan);
                let missed = (plan.actions().last().unwrap().object.end().point() - goal).norm();
                prop_assert!(missed <= SHORTEST_PUSH_M);
                let way = goal - start;
                prop_assert!(with_task || (way.x < SHORTEST_PUSH_M && way.y > -SHORTEST_PUSH_M));
            }
            Err(refusal) => {
                prop_assert!(refusal.to_string().starts_with("plan push: "));
                // the stick pushes to the left and forward
                let way = goal - start;
                prop_assert!(way.norm() < SHORTEST_PUSH_M || way.x > 0.0 || way.y < 0.0, "{refusal}");
                prop_assert!(!with_task || way.norm() < SHORTEST_PUSH_M, "{refusal}");
            }
        }
    }

    #[test]
    fn a_push_in_any_direction_is_reached_with_the_task(angle in 0.0f64..6.3, length in 0.01f64..0.2) {
        let goal = problem().start_world + Vector2::new(angle.cos(), angle.sin()) * length;
        let problem = PushProblem { goal_world: goal, orientation: Orientation::WithTask, ..problem() };
        assert_sound(&problem, &problem.plan(&ONE).unwrap());
    }
}
