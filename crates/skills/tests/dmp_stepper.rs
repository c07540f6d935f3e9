//! The movement primitive inside a control loop: same bits as a rollout, goal and duration changed on the way.

// helpers of tests may stop at the first surprise, as tests do
#![allow(clippy::unwrap_used)]

mod common;

use approx::assert_abs_diff_eq;
use common::{learn, request};
use skills::{DmpForm, DmpStepper, MovementPrimitive, RolloutRequest, SkillError};

/// Step of the loop, s.
const STEP_S: f64 = 0.001;
/// End error of the primitive at a quarter of the duration after its end, mm.
const SETTLED_MM: f64 = 0.005;
/// Rounding of positions of some hundred mm, mm.
const ROUNDING_MM: f64 = 1e-10;
/// All forms.
const FORMS: [DmpForm; 3] = [DmpForm::Residual, DmpForm::Eq1Literal, DmpForm::Scaled];

fn run(stepper: &mut DmpStepper, until_progress: f64) {
    while stepper.progress() < until_progress - 1e-9 {
        stepper.step(STEP_S).unwrap();
    }
}

fn started(form: DmpForm) -> DmpStepper {
    learn(form).stepper(&request(0.0, 200.0, 2.0, STEP_S)).unwrap()
}

#[test]
fn stepping_equals_the_rollout_bit_for_bit() {
    for form in FORMS {
        let dmp = learn(form);
        // the duration is no multiple of the step
        let request = RolloutRequest { settle_s: 0.3, ..request(3.0, 80.0, 1.2345, 0.01) };
        let rollout = dmp.rollout(&request).unwrap();
        let mut stepper = dmp.stepper(&request).unwrap();
        for (row, step_s) in request.time_steps_s().enumerate() {
            stepper.step(step_s).unwrap();
            assert_eq!(stepper.position()[0].to_bits(), rollout.positions().samples()[(row + 1, 0)].to_bits());
            assert_eq!(stepper.velocity()[0].to_bits(), rollout.velocities()[(row + 1, 0)].to_bits());
            assert_eq!(stepper.acceleration()[0].to_bits(), rollout.accelerations()[(row + 1, 0)].to_bits());
        }
        assert_abs_diff_eq!(stepper.elapsed_s(), rollout.positions().end_time_s(), epsilon = 1e-12);
    }
}

#[test]
fn setting_the_same_goal_again_changes_nothing_but_rounding() {
    let (mut changed, mut left) = (started(DmpForm::Residual), started(DmpForm::Residual));
    run(&mut changed, 0.4);
    run(&mut left, 0.4);
    changed.change_goal(&[200.0]).unwrap();
    run(&mut changed, 1.0);
    run(&mut left, 1.0);
    assert_abs_diff_eq!(changed.position()[0], left.position()[0], epsilon = ROUNDING_MM);
    assert_abs_diff_eq!(changed.velocity()[0], left.velocity()[0], epsilon = 10.0 * ROUNDING_MM);
}

#[test]
fn a_goal_changed_on_the_way_is_reached() {
    for form in FORMS {
        for when in [0.1, 0.5, 0.9, 1.1] {
            let mut stepper = started(form);
            run(&mut stepper, when);
            stepper.change_goal(&[-50.0]).unwrap();
            assert_eq!(stepper.goal()[0], -50.0);
            // the literal attractor alone leaves (1 + 12.5·1.4)e^{−12.5·1.4} of the change 1.4 durations later
            run(&mut stepper, 2.5);
            assert_abs_diff_eq!(stepper.position()[0], -50.0, epsilon = SETTLED_MM);
        }
    }
}

#[test]
fn a_goal_changed_by_mid_motion_is_reached_in_the_same_time() {
    let mut stepper = started(DmpForm::Residual);
    run(&mut stepper, 0.5);
    stepper.change_goal(&[320.0]).unwrap();
    run(&mut stepper, 1.0);
    assert_abs_diff_eq!(stepper.position()[0], 320.0, epsilon = SETTLED_MM);
}

#[test]
fn a_change_of_goal_keeps_position_velocity_and_acceleration_of_the_residual_form() {
    let mut stepper = started(DmpForm::Residual);
    run(&mut stepper, 0.45);
    let before = stepper.clone();
    stepper.change_goal(&[900.0]).unwrap();
    assert_abs_diff_eq!(stepper.position()[0], before.position()[0], epsilon = ROUNDING_MM);
    assert_abs_diff_eq!(stepper.velocity()[0], before.velocity()[0], epsilon = ROUNDING_MM);
    assert_abs_diff_eq!(stepper.acceleration()[0], before.acceleration()[0], epsilon = 10.0 * ROUNDING_MM);
}

#[test]
fn a_change_of_goal_steps_the_acceleration_of_literal_equation_1() {
    let mut stepper = started(DmpForm::Eq1Literal);
    run(&mut stepper, 0.45);
    let before = stepper.clone();
    stepper.change_goal(&[400.0]).unwrap();
    assert_abs_diff_eq!(stepper.position()[0], before.position()[0], epsilon = ROUNDING_MM);
    assert_abs_diff_eq!(stepper.velocity()[0], before.velocity()[0], epsilon = ROUNDING_MM);
    // αβ(g_new − g)/τ² = 25·6.25·200/4 mm/s²
    assert_abs_diff_eq!(stepper.acceleration()[0] - before.acceleration()[0], 7812.5, epsilon = 1e-8);
}

#[test]
fn a_goal_that_moves_every_step_is_followed_to_its_end() {
    let mut stepper = started(DmpForm::Residual);
    while stepper.progress() < 1.5 {
        let goal = 200.0 + 60.0 * stepper.progress().min(1.0);
        stepper.change_goal(&[goal]).unwrap();
        stepper.step(STEP_S).unwrap();
        assert!(stepper.acceleration()[0].abs() < 5000.0, "{} mm/s²", stepper.acceleration()[0]);
    }
    run(&mut stepper, 2.5);
    assert_abs_diff_eq!(stepper.position()[0], 260.0, epsilon = SETTLED_MM);
}

#[test]
fn a_changed_duration_keeps_position_and_velocity_and_stretches_what_is_left() {
    for form in FORMS {
        let mut stepper = started(form);
        run(&mut stepper, 0.5);
        let before = stepper.clone();
        stepper.change_duration(4.0).unwrap();
        assert_abs_diff_eq!(stepper.position()[0], before.position()[0], epsilon = ROUNDING_MM);
        assert_abs_diff_eq!(stepper.velocity()[0], before.velocity()[0], epsilon = 10.0 * ROUNDING_MM);
        run(&mut stepper, 1.0);
        // half of 2 s, then half of 4 s
        assert_abs_diff_eq!(stepper.elapsed_s(), 3.0, epsilon = STEP_S);
        run(&mut stepper, 1.5);
        assert_abs_diff_eq!(stepper.position()[0], 200.0, epsilon = SETTLED_MM);
    }
}

#[test]
fn a_coupling_that_is_held_moves_the_rest_by_its_quotient_by_the_stiffness() {
    let mut stepper = started(DmpForm::Residual);
    while stepper.progress() < 3.0 {
        stepper.step_with_coupling(STEP_S, &[156.25]).unwrap();
    }
    // Δu = αβ moves the rest by one mm, Eq. (6); the forcing term has decayed by s(3T) = 1e-6
    assert_abs_diff_eq!(stepper.position()[0], 201.0, epsilon = 1e-3);
    run(&mut stepper, 5.0);
    assert_abs_diff_eq!(stepper.position()[0], 200.0, epsilon = 1e-3);
}

#[test]
fn a_coupling_of_zero_changes_nothing() {
    let (mut coupled, mut free) = (started(DmpForm::Residual), started(DmpForm::Residual));
    for _ in 0..500 {
        coupled.step_with_coupling(STEP_S, &[0.0]).unwrap();
        free.step(STEP_S).unwrap();
    }
    assert_eq!(coupled, free);
}

#[test]
fn bad_input_is_refused_and_leaves_the_motion_as_it_was() {
    let mut stepper = started(DmpForm::Residual);
    run(&mut stepper, 0.3);
    let before = stepper.clone();
    for step_s in [0.0, -0.1, 1e-300, 1e300, f64::NAN, f64::INFINITY] {
        assert!(matches!(stepper.step(step_s), Err(SkillError::InvalidArgument { argument: "time_step_s", .. })));
    }
    assert!(stepper.change_duration(0.0).is_err());
    assert!(stepper.change_goal(&[f64::NAN]).is_err());
    assert!(stepper.change_goal(&[1.0, 2.0]).is_err());
    assert!(stepper.step_with_coupling(STEP_S, &[]).is_err());
    assert_eq!(stepper, before);
}
