//! What a movement primitive promises: reproduction, generalization, order of the step, refusal of bad input.

// helpers of tests may stop at the first surprise, as tests do
#![allow(clippy::unwrap_used)]

mod common;

use approx::{assert_abs_diff_eq, assert_relative_eq};
use common::{config, demonstration, last, learn, locally_weighted, request, rms, rollout, sampled, weave_mm};
use nalgebra::{DMatrix, DVector, dmatrix};
use proptest::prelude::*;
use skills::time_law::minimum_jerk;
use skills::{Dmp, DmpConfig, DmpForm, MovementPrimitive, PrimitiveConfig, RolloutRequest, SkillError, Trajectory};

/// Rounding of positions of some hundred mm over a thousand steps, mm.
const ROUNDING_MM: f64 = 1e-9;
/// Reproduction of 200 mm by 50 bases found by an independent program on its worst of four demonstrations, mm (rms).
const LWR_MM: f64 = 0.28;
/// As [`LWR_MM`] for ridge regression, mm (rms).
const RIDGE_MM: f64 = 0.0066;
/// End error of a demonstration that rests, at a quarter of the duration after its end, mm.
const SETTLED_MM: f64 = 0.005;

fn reproduction_rms(config: &DmpConfig) -> f64 {
    let dmp = Dmp::learn(config, &[demonstration()]).unwrap();
    rms(&(rollout(&dmp, 0.0, 200.0, 2.0, 0.002).positions().samples() - demonstration().samples()))
}

#[test]
fn ridge_reproduces_a_demonstration_of_200_mm() {
    for form in [DmpForm::Residual, DmpForm::Eq1Literal, DmpForm::Scaled] {
        let found = reproduction_rms(&config(form));
        assert!(found < RIDGE_MM, "{form:?}: {found} mm");
    }
}

#[test]
fn locally_weighted_regression_reproduces_a_demonstration_of_200_mm() {
    for form in [DmpForm::Residual, DmpForm::Eq1Literal] {
        let found = reproduction_rms(&locally_weighted(form));
        assert!(found < LWR_MM, "{form:?}: {found} mm");
    }
}

#[test]
fn endpoints_stay_fixed() {
    let dmp = learn(DmpForm::Residual);
    for (start, goal) in [(0.0, 200.0), (10.0, 150.0), (-70.0, 1000.0), (5.0, 5.0)] {
        let request = RolloutRequest { settle_s: 0.5, ..request(start, goal, 2.0, 0.01) };
        let rollout = dmp.rollout(&request).unwrap();
        assert_eq!(rollout.positions().start()[0], start);
        assert_abs_diff_eq!(last(&rollout), goal, epsilon = SETTLED_MM);
    }
}

#[test]
fn the_end_error_of_the_residual_form_does_not_depend_on_start_and_goal() {
    let dmp = learn(DmpForm::Residual);
    let error = |start, goal| last(&rollout(&dmp, start, goal, 2.0, 0.01)) - goal;
    for (start, goal) in [(10.0, 150.0), (-70.0, 1000.0), (5.0, 5.0)] {
        assert_abs_diff_eq!(error(start, goal), error(0.0, 200.0), epsilon = ROUNDING_MM);
    }
}

#[test]
fn a_goal_at_the_start_keeps_the_demonstrated_weave() {
    let found = rollout(&learn(DmpForm::Residual), 7.0, 7.0, 2.0, 0.01);
    for (row, x) in found.positions().samples().iter().enumerate() {
        let r = row as f64 / 200.0;
        let weave = weave_mm(r) - 200.0 * minimum_jerk(r);
        // ten times the root mean square of the reproduction
        assert_abs_diff_eq!(*x, 7.0 + weave, epsilon = 10.0 * RIDGE_MM);
    }
}

#[test]
fn a_doubled_goal_steps_the_initial_acceleration_of_literal_equation_1() {
    let dmp = learn(DmpForm::Eq1Literal);
    let initial = |goal| rollout(&dmp, 0.0, goal, 2.0, 0.01).accelerations()[(0, 0)];
    // αβ(g_new − g_demo)/τ² = 25·6.25·200/4 mm/s²
    assert_relative_eq!(initial(400.0) - initial(200.0), 7812.5, max_relative = 1e-12);
}

#[test]
fn a_doubled_goal_leaves_the_initial_acceleration_of_the_residual_form() {
    let dmp = learn(DmpForm::Residual);
    let initial = |goal| rollout(&dmp, 0.0, goal, 2.0, 0.01).accelerations()[(0, 0)];
    assert_eq!(initial(400.0), initial(200.0));
}

#[test]
fn the_scaled_form_scales_and_mirrors_the_shape_with_the_displacement() {
    let dmp = learn(DmpForm::Scaled);
    let demonstrated = rollout(&dmp, 0.0, 200.0, 2.0, 0.01);
    let mirrored = rollout(&dmp, 0.0, -400.0, 2.0, 0.01);
    let expected = demonstrated.positions().samples() * -2.0;
    assert_abs_diff_eq!(mirrored.positions().samples(), &expected, epsilon = ROUNDING_MM);
    assert_abs_diff_eq!(last(&rollout(&dmp, 3.0, 3.0, 2.0, 0.01)), 3.0, epsilon = ROUNDING_MM);
}

#[test]
fn the_scaled_form_refuses_a_demonstration_that_returns_to_its_start() {
    let bump = sampled(1.0, 101, |r| (r * (1.0 - r)).powi(2));
    let error = Dmp::learn(&config(DmpForm::Scaled), &[demonstration(), bump]).unwrap_err();
    assert!(matches!(error, SkillError::NoDisplacement { demonstration: 1, coordinate: 0, .. }));
}

#[test]
fn doubling_the_duration_scales_time_exactly() {
    for form in [DmpForm::Residual, DmpForm::Eq1Literal, DmpForm::Scaled] {
        let dmp = learn(form);
        let (short, long) = (rollout(&dmp, 10.0, 90.0, 2.0, 0.01), rollout(&dmp, 10.0, 90.0, 4.0, 0.02));
        assert_eq!(short.positions().samples(), long.positions().samples());
        assert_eq!(short.velocities(), &(long.velocities() * 2.0));
        assert_eq!(short.accelerations(), &(long.accelerations() * 4.0));
    }
}

#[test]
fn halving_the_step_quarters_the_error_of_the_hold() {
    let dmp = learn(DmpForm::Residual);
    let end = |step_s: f64| {
        let rollout = rollout(&dmp, 0.0, 200.0, 2.0, step_s);
        // common instants of all grids
        rollout.positions().at(1.0)[0]
    };
    let exact = end(0.0005);
    let errors = [0.02, 0.01, 0.005].map(|step_s| (end(step_s) - exact).abs());
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.8..2.2).contains(&order), "order {order} from errors {errors:?}");
    }
}

#[test]
fn velocity_and_acceleration_are_the_derivatives_of_the_position() {
    let dmp = learn(DmpForm::Residual);
    let rollout = rollout(&dmp, 0.0, 350.0, 1.7, 0.001);
    let inside = rollout.positions().len() - 4;
    let velocity = rollout.positions().first_derivative() - rollout.velocities();
    let acceleration = rollout.positions().second_derivative() - rollout.accelerations();
    // central differences over 1 ms of a motion whose peak is some 500 mm/s and 3000 mm/s², away from their one-sided ends
    assert!(velocity.rows(2, inside).amax() < 0.1, "{}", velocity.rows(2, inside).amax());
    assert!(acceleration.rows(2, inside).amax() < 10.0, "{}", acceleration.rows(2, inside).amax());
}

#[test]
fn demonstrations_that_differ_symmetrically_average() {
    let above = sampled(2.0, 401, |r| 100.0 * minimum_jerk(r) + 320.0 * (r * (1.0 - r)).powi(2));
    let below = sampled(2.0, 401, |r| 100.0 * minimum_jerk(r) - 320.0 * (r * (1.0 - r)).powi(2));
    for config in [config(DmpForm::Residual), locally_weighted(DmpForm::Residual)] {
        let dmp = Dmp::learn(&config, &[above.clone(), below.clone()]).unwrap();
        let found = rollout(&dmp, 0.0, 100.0, 2.0, 0.005);
        let expected = sampled(2.0, 401, |r| 100.0 * minimum_jerk(r));
        assert_abs_diff_eq!(found.positions().samples(), expected.samples(), epsilon = ROUNDING_MM);
    }
}

#[test]
fn demonstrations_of_one_shape_at_other_places_and_speeds_teach_that_shape() {
    let shape = |r: f64| weave_mm(r) - 200.0 * minimum_jerk(r);
    let demonstrations = [
        sampled(2.0, 1001, weave_mm),
        sampled(0.8, 501, |r| 40.0 - 90.0 * minimum_jerk(r) + shape(r)),
        sampled(5.0, 2001, |r| -10.0 + shape(r)),
    ];
    let dmp = Dmp::learn(&config(DmpForm::Residual), &demonstrations).unwrap();
    let found = rollout(&dmp, 0.0, 200.0, 2.0, 0.002);
    assert!(rms(&(found.positions().samples() - demonstration().samples())) < RIDGE_MM);
}

#[test]
fn a_denser_recording_does_not_outvote_another() {
    let above = sampled(2.0, 2001, |r| 320.0 * (r * (1.0 - r)).powi(2));
    let below = sampled(2.0, 201, |r| -320.0 * (r * (1.0 - r)).powi(2));
    let dmp = Dmp::learn(&config(DmpForm::Residual), &[above, below]).unwrap();
    // 1 % of the 20 mm by which either departs: the ends of the sparser one stand for a hundredth more
    assert!(rollout(&dmp, 0.0, 0.0, 2.0, 0.005).positions().samples().amax() < 0.2);
}

#[test]
fn a_demonstration_that_rests_settles_at_the_goal() {
    for form in [DmpForm::Residual, DmpForm::Eq1Literal] {
        let dmp = learn(form);
        assert!(!dmp.fades_before_end());
        let found = dmp.rollout(&RolloutRequest { settle_s: 0.5, ..request(0.0, 200.0, 2.0, 0.01) }).unwrap();
        assert_eq!(found.positions().end_time_s(), 2.5);
        assert_abs_diff_eq!(last(&found), 200.0, epsilon = SETTLED_MM);
    }
}

#[test]
fn a_demonstration_that_ends_in_motion_is_reported_and_faded() {
    // 200 mm in 2 s, cut at 188 mm/s of speed
    let moving = sampled(2.0, 1001, |r| 188.0 * r * r + 12.0 * r * r * r * r);
    let dmp = Dmp::learn(&config(DmpForm::Residual), &[moving]).unwrap();
    // (2·188 + 4·12)/2 mm/s to the error of one-sided differences
    assert_relative_eq!(dmp.end_speed(), 212.0, max_relative = 1e-4);
    assert!(dmp.fades_before_end());
    let found = dmp.rollout(&RolloutRequest { settle_s: 0.5, ..request(0.0, 200.0, 2.0, 0.002) }).unwrap();
    let overshoot = found.positions().samples().max() - 200.0;
    // an unfaded term overshoots by some 30 mm
    assert!(overshoot < 10.0, "{overshoot} mm");
    let stay = dmp.rollout(&RolloutRequest { settle_s: 4.0, ..request(0.0, 200.0, 2.0, 0.002) }).unwrap();
    assert_abs_diff_eq!(last(&stay), 200.0, epsilon = 1e-3);
}

#[test]
fn a_start_velocity_is_taken_up_exactly() {
    let request = RolloutRequest {
        start_velocity: Some(DVector::from_element(1, 30.0)),
        settle_s: 0.5,
        ..request(0.0, 200.0, 2.0, 0.01)
    };
    let found = learn(DmpForm::Residual).rollout(&request).unwrap();
    assert_eq!(found.velocities()[(0, 0)], 30.0);
    assert_abs_diff_eq!(last(&found), 200.0, epsilon = SETTLED_MM);
}

#[test]
fn coordinates_do_not_influence_each_other() {
    let plane = DMatrix::from_fn(201, 2, |row, k| weave_mm(row as f64 / 200.0) * [1.0, -3.0][k]);
    let plane = Trajectory::uniform(0.01, plane).unwrap();
    let both = Dmp::learn(&config(DmpForm::Residual), &[plane]).unwrap();
    let request = RolloutRequest::new(DVector::zeros(2), DVector::from_vec(vec![200.0, -600.0]), 2.0, 0.01);
    let both = both.rollout(&request).unwrap();
    let alone = Dmp::learn(&config(DmpForm::Residual), &[sampled(2.0, 201, weave_mm)]).unwrap();
    let alone = rollout(&alone, 0.0, 200.0, 2.0, 0.01);
    for row in 0..201 {
        let x = alone.positions().samples()[(row, 0)];
        assert_abs_diff_eq!(both.positions().samples()[(row, 0)], x, epsilon = ROUNDING_MM);
        assert_abs_diff_eq!(both.positions().samples()[(row, 1)], -3.0 * x, epsilon = 10.0 * ROUNDING_MM);
    }
}

#[test]
fn a_demonstration_that_is_not_a_number_is_refused() {
    let error = Trajectory::uniform(0.1, dmatrix![0.0; f64::NAN; 1.0]).unwrap_err();
    assert!(matches!(error, SkillError::NonFinite { row: 1, column: 0, .. }));
}

#[test]
fn a_demonstration_whose_derivatives_overflow_is_refused() {
    let huge = Trajectory::uniform(0.1, dmatrix![-1e308; 1e308; -1e308; 1e308]).unwrap();
    let error = Dmp::learn(&DmpConfig::default(), &[huge]).unwrap_err();
    assert!(matches!(error, SkillError::NonFinite { operation: "learn primitive", .. }));
}

// the speed at the end is saved with the primitive, and no file of one that is not finite could be read again
#[test]
fn a_demonstration_whose_speed_overflows_at_its_end_is_refused() {
    let shown = Trajectory::uniform(1.0, DMatrix::from_fn(50, 2, |row, _| 1e298 * row as f64)).unwrap();
    let refused = Dmp::learn(&DmpConfig::default(), &[shown]);
    assert!(matches!(refused, Err(SkillError::InvalidArgument { argument: "end_speed", .. })), "{refused:?}");
}

#[test]
fn no_demonstration_and_unequal_dimensions_are_refused() {
    let config = PrimitiveConfig::default();
    assert_eq!(config.learn(&[]).unwrap_err(), SkillError::NoDemonstrations);
    let plane = Trajectory::uniform(1.0, dmatrix![0.0, 0.0; 1.0, 1.0]).unwrap();
    let error = config.learn(&[demonstration(), plane]).unwrap_err();
    assert_eq!(error, SkillError::DemonstrationDimension { demonstration: 1, found: 2, expected: 1 });
}

#[test]
fn invalid_options_are_refused_with_their_path_when_learning() {
    let config = PrimitiveConfig::Dmp(DmpConfig { bases: 0, ..DmpConfig::default() });
    let error = config.learn(&[demonstration()]).unwrap_err();
    assert!(matches!(error, SkillError::InvalidConfig(error) if error.field == "dmp.bases"));
}

#[test]
fn two_samples_are_enough_to_learn_from() {
    let line = Trajectory::uniform(1.0, dmatrix![0.0; 1.0]).unwrap();
    let dmp = PrimitiveConfig::default().learn(&[line]).unwrap();
    let request = RolloutRequest { settle_s: 1.0, ..request(2.0, 5.0, 1.0, 0.01) };
    assert_abs_diff_eq!(last(&dmp.rollout(&request).unwrap()), 5.0, epsilon = 1e-2);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn rollouts_are_finite_and_begin_at_the_start(
        start in -1e4f64..1e4, goal in -1e4f64..1e4, duration_s in 1e-3f64..1e3, steps in 1u32..300,
        form in prop::sample::select(vec![DmpForm::Residual, DmpForm::Eq1Literal, DmpForm::Scaled]),
    ) {
        let time_step_s = duration_s / f64::from(steps);
        let request = RolloutRequest { settle_s: duration_s, ..request(start, goal, duration_s, time_step_s) };
        // `Rollout` refuses what is not finite
        let found = learn(form).rollout(&request).unwrap();
        prop_assert_eq!(found.positions().start()[0], start);
        prop_assert_eq!(found.positions().len(), 2 * steps as usize + 1);
    }

    #[test]
    fn the_residual_form_moves_with_its_start_and_goal(shift in -1e3f64..1e3, goal in -500.0f64..500.0) {
        let dmp = learn(DmpForm::Residual);
        let (here, there) = (rollout(&dmp, 0.0, goal, 2.0, 0.02), rollout(&dmp, shift, goal + shift, 2.0, 0.02));
        let difference = there.positions().samples() - here.positions().samples();
        prop_assert!((difference.add_scalar(-shift)).amax() < ROUNDING_MM);
    }
}
