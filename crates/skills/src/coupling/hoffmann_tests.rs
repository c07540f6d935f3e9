//! Hoffmann's obstacle term against the reference program and its closed-form properties.

use std::f64::consts::PI;

use approx::{assert_abs_diff_eq, assert_relative_eq};
use proptest::prelude::*;
use serde_json::Value;

use super::*;

/// A few roundings.
const ROUNDING: f64 = 1e-12;
/// Rounding of a closed form that both programs evaluate in double precision.
const VECTORS: f64 = 1e-9;
/// The reference program adds this to each norm under its arc cosine.
const GUARD: f64 = 1e-9;

fn term(gamma: f64, beta: f64, obstacles: &[&[f64]]) -> Hoffmann {
    Hoffmann::new(gamma, beta, obstacles.iter().map(|obstacle| obstacle.to_vec()).collect()).unwrap()
}

fn evaluate(term: &Hoffmann, position: &[f64], velocity: &[f64], duration_s: f64) -> Vec<f64> {
    let mut sum = vec![0.0; position.len()];
    term.add_to(&MotionState { position, velocity, elapsed_s: 0.0, duration_s }, &mut sum);
    sum
}

// φ e^{−βφ}·γ‖v‖ for a unit velocity along x and an obstacle at the angle φ
fn magnitude(term: &Hoffmann) -> f64 {
    let sum = evaluate(term, &[0.0, 0.0], &[1.0, 0.0], 1.0);
    sum[0].hypot(sum[1])
}

#[test]
fn an_obstacle_ahead_on_the_left_turns_the_motion_right() {
    let sum = evaluate(&term(2.0, 0.5, &[&[1.0, 1.0]]), &[0.0, 0.0], &[3.0, 0.0], 1.0);
    assert_abs_diff_eq!(sum[0], 0.0, epsilon = ROUNDING);
    assert_relative_eq!(sum[1], -2.0 * 3.0 * PI / 4.0 * (-PI / 8.0).exp(), max_relative = ROUNDING);
}

#[test]
fn the_term_agrees_with_the_reference_program() {
    let file: Value = serde_json::from_str(include_str!("../../tests/data/identification.json")).unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    let vector = |value: &Value| value.as_array().unwrap().iter().map(number).collect::<Vec<_>>();
    let (gamma, beta) = (number(&file["true"][0]), number(&file["true"][1]));
    let cases = file["hoffmann"].as_array().unwrap();
    assert_eq!(cases.len(), 3);
    for case in cases {
        let (x, v, o) = (vector(&case["x"]), vector(&case["v"]), vector(&case["o"]));
        let mut direction = [0.0; 2];
        let angle = Hoffmann::features(&x, &v, &o, &mut direction);
        // cos φ of the file is v·d/((‖v‖ + guard)(‖d‖ + guard)), which moves φ by guard·(1/‖v‖ + 1/‖d‖)/tan φ
        let distance = (o[0] - x[0]).hypot(o[1] - x[1]);
        let moved = GUARD * (1.0 / v[0].hypot(v[1]) + 1.0 / distance) / angle.tan();
        assert_abs_diff_eq!(angle + moved, number(&case["phi"]), epsilon = VECTORS);
        // the law itself at the file's angle
        let angle_of_file = number(&case["phi"]);
        let decay = gamma * (-beta * angle_of_file).exp();
        for (k, along) in direction.into_iter().enumerate() {
            let regressor = along * angle_of_file / angle;
            assert_abs_diff_eq!(regressor, vector(&case["Rv_phi"])[k], epsilon = VECTORS);
            assert_abs_diff_eq!(regressor * decay, vector(&case["du"])[k], epsilon = VECTORS);
        }
    }
}

#[test]
fn the_term_is_zero_at_rest_on_the_obstacle_and_where_the_plane_is_undefined() {
    let term = term(60.0, 2.5, &[&[1.0, 0.0]]);
    assert_eq!(evaluate(&term, &[0.0, 0.0], &[0.0, 0.0], 2.0), [0.0, 0.0]);
    assert_eq!(evaluate(&term, &[1.0, 0.0], &[1.0, 0.3], 2.0), [0.0, 0.0]);
    assert_eq!(evaluate(&term, &[0.0, 0.0], &[5.0, 0.0], 2.0), [0.0, 0.0]);
    assert_eq!(evaluate(&term, &[0.0, 0.0], &[-5.0, 0.0], 2.0), [0.0, 0.0]);
}

#[test]
fn the_term_vanishes_continuously_as_the_angle_does() {
    for angle in [1e-3, 1e-9, 1e-15, 1e-200] {
        assert_relative_eq!(magnitude(&term(60.0, 2.5, &[&[1.0, angle]])), 60.0 * angle, max_relative = 3e-3);
    }
}

#[test]
fn the_term_is_greatest_over_the_angle_at_one_over_beta() {
    let at = |angle: f64| magnitude(&term(60.0, 2.5, &[&[angle.cos(), angle.sin()]]));
    let greatest = at(0.4);
    assert_relative_eq!(greatest, 60.0 * 0.4 * (-1f64).exp(), max_relative = ROUNDING);
    for step in 1..3000 {
        let angle = f64::from(step) * 1e-3;
        assert!(at(angle) <= greatest + ROUNDING, "{angle}");
    }
}

#[test]
fn the_term_does_not_depend_on_the_distance() {
    let near = magnitude(&term(60.0, 2.5, &[&[1e-3, 1e-3]]));
    assert_relative_eq!(near, magnitude(&term(60.0, 2.5, &[&[1e3, 1e3]])), max_relative = ROUNDING);
}

#[test]
fn the_term_scales_with_the_duration_so_that_the_path_does_not_change() {
    // the same path in twice the time: half the velocity, the same v = τẋ
    let term = term(60.0, 2.5, &[&[0.7, 0.2]]);
    let (fast, slow) = (evaluate(&term, &[0.0; 2], &[1.0, 0.4], 1.0), evaluate(&term, &[0.0; 2], &[0.5, 0.2], 2.0));
    for (fast, slow) in fast.iter().zip(slow) {
        assert_relative_eq!(*fast, slow, max_relative = ROUNDING);
    }
}

#[test]
fn obstacles_add_up_and_a_post_leaves_the_height_alone() {
    let [a, b] = [[0.7, 0.2], [0.5, -0.4]];
    let state = ([0.0, 0.0, 0.0], [1.0, 0.1, 0.8]);
    let both = evaluate(&term(60.0, 2.5, &[&a, &b]), &state.0, &state.1, 1.0);
    let one = evaluate(&term(60.0, 2.5, &[&a]), &state.0, &state.1, 1.0);
    let other = evaluate(&term(60.0, 2.5, &[&b]), &state.0, &state.1, 1.0);
    for k in 0..3 {
        assert_relative_eq!(both[k], one[k] + other[k], max_relative = ROUNDING);
    }
    assert_eq!(both[2], 0.0);
    let flat = evaluate(&term(60.0, 2.5, &[&a]), &state.0[..2], &state.1[..2], 1.0);
    assert_eq!(&one[..2], flat);
}

#[test]
fn a_state_that_is_not_a_number_shows() {
    let term = term(60.0, 2.5, &[&[1.0, 0.3]]);
    for (x, v) in [([0.0, 0.0], [f64::NAN; 2]), ([f64::NAN, 0.0], [1.0, 0.0]), ([0.0, 0.0], [1.0, f64::NAN])] {
        assert!(evaluate(&term, &x, &v, 1.0).iter().any(|value| value.is_nan()));
    }
}

#[test]
fn evaluation_does_not_allocate() {
    let term = term(60.0, 2.5, &[&[1.0, 0.2, 0.1], &[2.0, 0.0, 0.4]]);
    let state = MotionState { position: &[0.0; 3], velocity: &[1.0, 0.5, 0.2], elapsed_s: 0.0, duration_s: 1.0 };
    let mut sum = [0.0; 3];
    let counted = allocation_counter::measure(|| term.add_to(&state, &mut sum));
    assert_eq!(counted.count_total, 0);
    assert!(sum.iter().all(|value| *value != 0.0));
}

#[test]
fn values_outside_their_range_are_refused_by_name() {
    let named = |result: Result<Hoffmann, SkillError>| match result {
        Err(SkillError::InvalidArgument { argument, .. }) => argument,
        other => panic!("{other:?}"),
    };
    assert_eq!(named(Hoffmann::new(-1.0, 1.0, vec![])), "gamma");
    assert_eq!(named(Hoffmann::new(1.0, f64::NAN, vec![])), "beta");
    let dimension = Hoffmann::new(1.0, 1.0, vec![vec![0.0]]);
    assert!(matches!(dimension, Err(SkillError::Dimension { found: 1, expected: 2, .. })));
    let infinite = Hoffmann::new(1.0, 1.0, vec![vec![0.0; 2], vec![0.0, f64::INFINITY]]);
    assert!(matches!(infinite, Err(SkillError::NonFinite { row: 1, column: 1, .. })));
}

#[test]
fn the_term_is_perpendicular_nearly_straight_away_from_an_obstacle() {
    // found by chance: the way back to the obstacle differs from the velocity's line by 1e-6 rad
    let (x, v) = ([0.08581884266281872, 0.5797302856591817], [-0.05035103713007999, 0.8593350929040825]);
    let mut direction = [0.0; 2];
    let angle = Hoffmann::features(&x, &v, &[0.11098280520813965, 0.15023322247473644], &mut direction);
    assert!(PI - angle < 1e-4);
    assert_abs_diff_eq!(direction[0] * v[0] + direction[1] * v[1], 0.0, epsilon = ROUNDING);
}

proptest! {
    #[test]
    fn the_term_is_perpendicular_to_the_velocity_and_points_away(
        x in prop::array::uniform4(-1f64..1.0), v in prop::array::uniform4(-1f64..1.0),
        o in prop::array::uniform4(-1f64..1.0), dimension in 2usize..=4,
    ) {
        let (x, v, o) = (&x[..dimension], &v[..dimension], &o[..dimension]);
        let mut direction = vec![0.0; dimension];
        let angle = Hoffmann::features(x, v, o, &mut direction);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let speed = dot(v, v).sqrt();
        prop_assert!(dot(&direction, v).abs() <= ROUNDING * speed * speed);
        // ‖Rvφ‖ = ‖v‖φ, and turned away from the obstacle
        prop_assert!((dot(&direction, &direction).sqrt() - speed * angle).abs() <= 1e-9 * speed);
        let way: Vec<f64> = o.iter().zip(x).map(|(o, x)| o - x).collect();
        prop_assert!(dot(&direction, &way) <= 0.0);
    }

    #[test]
    fn the_term_is_finite_for_velocities_of_any_size(exponent in -320f64..300.0, angle in 0f64..PI) {
        let speed = 10f64.powf(exponent);
        let term = term(60.0, 2.5, &[&[1.0, 0.3]]);
        let sum = evaluate(&term, &[0.0, 0.0], &[speed * angle.cos(), speed * angle.sin()], 1.0);
        prop_assert!(sum.iter().all(|value| value.is_finite()));
    }
}
