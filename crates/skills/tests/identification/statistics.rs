//! What is told of the error of an estimate, against the spread of estimates.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use skills::regression::ForcingSamples;
use skills::separation::model_based::{IdentificationConfig, IdentificationData, estimate};

use crate::support::{TRUTH, config, direction, normal, samples};

/// Estimates drawn.
const DRAWS: usize = 400;
/// Four standard errors of a standard deviation of 400 draws, 1/√800 each.
const SPREAD: f64 = 0.15;
/// Standard deviation of the noise in F, a few hundredths of its size.
const NOISE: f64 = 0.05;

#[test]
fn the_spread_of_estimates_under_noise_is_the_predicted_covariance() {
    let data = samples(3, direction);
    let config = config(IdentificationConfig::default());
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let (mut squares, mut predicted, mut residual) = ([0.0; 2], [0.0; 2], 0.0);
    for _ in 0..DRAWS {
        let noisy = ForcingSamples {
            phases: data.phases().clone(),
            targets: data.targets().map(|target| target + NOISE * normal(&mut random)),
            weights: data.weights().clone(),
        };
        let noisy = IdentificationData::new(noisy, data.directions().clone(), data.angles().clone()).unwrap();
        let found = estimate(&config, &noisy).unwrap();
        let errors = [(found.parameters.gamma / TRUTH.gamma).ln(), found.parameters.beta - TRUTH.beta];
        for k in [0, 1] {
            squares[k] += errors[k] * errors[k] / DRAWS as f64;
            predicted[k] += found.covariance[(k, k)] / DRAWS as f64;
        }
        residual += found.residual / DRAWS as f64;
    }
    for k in [0, 1] {
        let ratio = f64::sqrt(squares[k] / predicted[k]);
        assert!((ratio - 1.0).abs() < SPREAD, "{ratio}");
    }
    assert!((residual / NOISE - 1.0).abs() < 0.05, "{residual}");
}
