//! The movement primitive against numbers of an independent program (Python, NumPy and SciPy): `data/dmp.json`.

// helpers of tests may stop at the first surprise, as tests do
#![allow(clippy::unwrap_used)]

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector, dvector};
use serde_json::Value;
use skills::basis::GaussianBasis;
use skills::canonical::CanonicalSystem;
use skills::regression::{Lwr, RegressionConfig, Ridge};
use skills::time_law::minimum_jerk;
use skills::{Dmp, DmpConfig, DmpForm, MovementPrimitive, Rollout, RolloutRequest, Trajectory};

/// Both programs work in double precision; the normal equations of ten bases lose some six of its sixteen digits.
const VECTORS: f64 = 1e-9;
/// Activation that is kept as zero: e^{−60} of the largest.
const NEGLIGIBLE: f64 = 1e-26;
/// Distance to the solution by an adaptive solver with f continuous in time, mm: the file's steps interpolate f linearly
/// over 0.01 s.
const ODE_MM: f64 = 2e-2;

fn file() -> Value {
    serde_json::from_str(include_str!("data/dmp.json")).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

fn indices() -> Vec<usize> {
    numbers(&file()["sample_idx"]).iter().map(|index| *index as usize).collect()
}

// 200 mm in 2 s, mm: 200·mj(r) + 30·sin(3πr)·16(r(1 − r))²
fn demonstration() -> Trajectory {
    let position = |row: usize| {
        let r = row as f64 / 200.0;
        200.0 * minimum_jerk(r) + 30.0 * (3.0 * std::f64::consts::PI * r).sin() * 16.0 * (r * (1.0 - r)).powi(2)
    };
    Trajectory::uniform(0.01, DMatrix::from_fn(201, 1, |row, _| position(row))).unwrap()
}

fn learn(form: DmpForm, regression: RegressionConfig) -> Dmp {
    let vectors = file();
    let config = DmpConfig {
        form,
        bases: vectors["n"].as_u64().unwrap() as usize,
        alpha: number(&vectors["alpha"]),
        gamma: number(&vectors["gamma"]),
        regression,
        overlap: Some(0.5),
    };
    Dmp::learn(&config, &[demonstration()]).unwrap()
}

fn ridge() -> RegressionConfig {
    RegressionConfig::Ridge(Ridge { lambda: number(&file()["lam"]) })
}

fn lwr() -> RegressionConfig {
    RegressionConfig::Lwr(Lwr {})
}

fn rollout(dmp: &Dmp, start: f64, goal: f64) -> Rollout {
    dmp.rollout(&RolloutRequest::new(dvector![start], dvector![goal], 2.0, 0.01)).unwrap()
}

fn assert_column(found: &DMatrix<f64>, rows: &[usize], expected: &Value) {
    let expected = numbers(expected);
    assert_eq!(rows.len(), expected.len());
    for (row, expected) in rows.iter().zip(expected) {
        assert_relative_eq!(found[(*row, 0)], expected, max_relative = VECTORS, epsilon = VECTORS);
    }
}

fn assert_weights(dmp: &Dmp, expected: &Value) {
    let expected = DVector::from_vec(numbers(expected));
    let difference = (dmp.weights().column(0) - &expected).amax() / expected.amax();
    assert!(difference < VECTORS, "weights differ by {difference:e} of the largest");
}

fn rms(rollout: &Rollout) -> f64 {
    let difference = rollout.positions().samples() - demonstration().samples();
    (difference.norm_squared() / difference.len() as f64).sqrt()
}

#[test]
fn centers_and_widths_agree_with_the_reference() {
    let vectors = file();
    let basis = GaussianBasis::uniform_in_time(10, CanonicalSystem::new(number(&vectors["gamma"])), 0.5);
    for (i, (center, width)) in numbers(&vectors["centres"]).into_iter().zip(numbers(&vectors["widths"])).enumerate() {
        assert_relative_eq!(basis.centers()[i], center, max_relative = VECTORS);
        assert_relative_eq!(basis.widths()[i], width, max_relative = VECTORS);
    }
}

#[test]
fn activations_agree_with_the_reference() {
    let vectors = file();
    let basis = GaussianBasis::uniform_in_time(10, CanonicalSystem::new(number(&vectors["gamma"])), 0.5);
    for (phase, expected) in vectors["psi_at"].as_object().unwrap() {
        let design = basis.design_matrix(&dvector![phase.parse().unwrap()]);
        for (i, expected) in numbers(expected).into_iter().enumerate() {
            assert_relative_eq!(design[(0, i)], expected, max_relative = VECTORS, epsilon = NEGLIGIBLE);
        }
    }
}

#[test]
fn the_demonstration_is_that_of_the_reference() {
    assert_column(demonstration().samples(), &indices(), &file()["x"]);
}

#[test]
fn derivatives_give_the_forcing_targets_of_the_reference() {
    let (x, tau) = (demonstration(), 2.0);
    let (velocity, acceleration) = (x.first_derivative(), x.second_derivative());
    let targets = DMatrix::from_fn(201, 1, |row, _| {
        let pull = 25.0 * (6.25 * (200.0 - x.samples()[(row, 0)]) - tau * velocity[(row, 0)]);
        tau * tau * acceleration[(row, 0)] - pull
    });
    assert_column(&targets, &indices(), &file()["Ftarget"]);
}

#[test]
fn locally_weighted_weights_agree_with_the_reference() {
    assert_weights(&learn(DmpForm::Eq1Literal, lwr()), &file()["w_lwr"]);
}

#[test]
fn ridge_weights_agree_with_the_reference() {
    assert_weights(&learn(DmpForm::Eq1Literal, ridge()), &file()["w_ridge"]);
}

#[test]
fn residual_weights_agree_with_the_reference() {
    assert_weights(&learn(DmpForm::Residual, ridge()), &file()["residual_dmp"]["w"]);
}

#[test]
fn the_locally_weighted_rollout_agrees_with_the_reference() {
    let rollout = rollout(&learn(DmpForm::Eq1Literal, lwr()), 0.0, 200.0);
    assert_column(rollout.positions().samples(), &indices(), &file()["x_lwr"]);
    assert_relative_eq!(rms(&rollout), number(&file()["rms_lwr"]), max_relative = VECTORS);
}

#[test]
fn the_ridge_rollout_agrees_with_the_reference_in_position_and_velocity() {
    let rollout = rollout(&learn(DmpForm::Eq1Literal, ridge()), 0.0, 200.0);
    assert_column(rollout.positions().samples(), &indices(), &file()["x_ridge"]);
    assert_relative_eq!(rms(&rollout), number(&file()["rms_ridge"]), max_relative = VECTORS);
    // the reference keeps v = τẋ of Eq. (1)
    assert_column(&(rollout.velocities() * 2.0), &indices(), &file()["v_ridge"]);
}

#[test]
fn the_rollout_lies_within_its_step_error_of_an_adaptive_solver() {
    let rollout = rollout(&learn(DmpForm::Eq1Literal, ridge()), 0.0, 200.0);
    for (row, expected) in indices().into_iter().zip(numbers(&file()["ode_reference"])) {
        assert!((rollout.positions().samples()[(row, 0)] - expected).abs() < ODE_MM);
    }
}

#[test]
fn the_literal_rollout_to_another_start_and_goal_agrees_with_the_reference() {
    let rollout = rollout(&learn(DmpForm::Eq1Literal, ridge()), 10.0, 150.0);
    assert_column(rollout.positions().samples(), &indices(), &file()["x_eq1_newgoal"]);
}

#[test]
fn residual_rollouts_agree_with_the_reference() {
    let dmp = learn(DmpForm::Residual, ridge());
    let vectors = &file()["residual_dmp"];
    assert_column(rollout(&dmp, 0.0, 200.0).positions().samples(), &indices(), &vectors["x_demo"]);
    assert_column(rollout(&dmp, 10.0, 150.0).positions().samples(), &indices(), &vectors["x_new"]);
}
