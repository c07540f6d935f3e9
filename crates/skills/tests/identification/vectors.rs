//! Against reference vectors made with an independent Python program: `data/identification.json`.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use serde_json::Value;
use skills::regression::{RegressionConfig, Ridge};
use skills::separation::model_based::{Estimate, IdentificationConfig, LogForm, estimate};

use crate::support::{TRUTH, algorithm_one, config, direction, samples};

/// Rounding of double precision in normal equations of eight bases.
const VECTORS: f64 = 1e-9;
/// The two programs search β differently, and end where its cost is flat to rounding.
const SEARCH: f64 = 1e-6;
/// The ridge of 1e-8 adds this to sin², which the file has without.
const RIDGE: f64 = 1e-6;

fn file() -> Value {
    serde_json::from_str(include_str!("../data/identification.json")).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

fn identified(demonstrations: usize, identification: IdentificationConfig) -> Estimate {
    estimate(&config(identification), &samples(demonstrations, direction)).unwrap()
}

fn without_ridge(demonstrations: usize) -> Estimate {
    let mut config = config(IdentificationConfig::default());
    config.primitive.regression = RegressionConfig::Ridge(Ridge { lambda: 0.0 });
    estimate(&config, &samples(demonstrations, direction)).unwrap()
}

#[test]
fn the_samples_are_those_of_the_reference_program() {
    let data = samples(3, direction);
    for (sample, targets) in file()["F0_samples"].as_array().unwrap().iter().enumerate() {
        for (k, target) in numbers(targets).into_iter().enumerate() {
            assert_abs_diff_eq!(data.targets()[(sample * 25, k)], target, epsilon = VECTORS);
        }
    }
    for (sample, angle) in numbers(&file()["phi0"]).into_iter().enumerate() {
        assert_abs_diff_eq!(data.angles()[sample * 25], angle, epsilon = VECTORS);
    }
}

#[test]
fn variable_projection_agrees_with_the_reference_program() {
    let found = identified(3, IdentificationConfig::default());
    let expected = numbers(&file()["varpro"]);
    assert!(found.converged);
    assert_relative_eq!(found.parameters.gamma, expected[0], max_relative = SEARCH);
    assert_relative_eq!(found.parameters.beta, expected[1], max_relative = SEARCH);
    assert_relative_eq!(found.parameters.gamma, TRUTH.gamma, max_relative = SEARCH);
}

#[test]
fn identifiability_agrees_with_the_reference_program() {
    for (demonstrations, name) in [(3, "sin2_3demos"), (1, "sin2_1demo")] {
        let found = without_ridge(demonstrations);
        let held = identified(demonstrations, IdentificationConfig::default());
        for (k, expected) in numbers(&file()[name]).into_iter().enumerate() {
            assert_relative_eq!(found.sin_squared[k], expected, max_relative = SEARCH);
            assert_abs_diff_eq!(held.sin_squared[k], expected, epsilon = RIDGE);
        }
    }
}

#[test]
fn algorithm_1_takes_the_steps_of_the_reference_program() {
    let found = identified(3, algorithm_one(LogForm::Weighted));
    for (found, expected) in found.history.iter().zip(file()["alg1_weighted_eta1_first5"].as_array().unwrap()) {
        let expected = numbers(expected);
        assert_abs_diff_eq!(found.gamma.ln(), expected[0], epsilon = VECTORS);
        assert_abs_diff_eq!(found.beta, expected[1], epsilon = VECTORS);
    }
    let last = numbers(&file()["alg1_final"]);
    let rounds = file()["alg1_iters"].as_u64().unwrap() as usize;
    assert_eq!((found.converged, found.history.len()), (true, rounds));
    assert_abs_diff_eq!(found.parameters.gamma.ln(), last[0], epsilon = SEARCH);
    assert_abs_diff_eq!(found.parameters.beta, last[1], epsilon = SEARCH);
    let rate = file()["rate_pred"].as_f64().unwrap();
    assert_abs_diff_eq!(found.contraction(1.0), rate, epsilon = RIDGE);
}
