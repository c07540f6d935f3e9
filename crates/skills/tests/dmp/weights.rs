//! How demonstrations and samples weigh in Eq. (4), and why it has to sum over samples (erratum E16).

use approx::assert_abs_diff_eq;
use nalgebra::{DMatrix, DVector};
use skills::basis::GaussianBasis;
use skills::canonical::CanonicalSystem;
use skills::regression::{ForcingSamples, Lwr, Recursive, RecursiveFit, Regression, RegressionConfig, Ridge};
use skills::time_law::minimum_jerk;
use skills::{Dmp, DmpConfig, DmpForm, SkillError, Trajectory};

use super::common::{demonstration, rollout, sampled};

/// Some thousand roundings of positions of 100 mm, mm.
const ROUNDING_MM: f64 = 1e-9;
/// The square roots of a Cholesky factor round differently for a doubled matrix; relative to the largest weight.
const SQUARE_ROOTS: f64 = 1e-12;

fn configs() -> [DmpConfig; 4] {
    let with = |regression| DmpConfig { regression, ..DmpConfig::default() };
    [
        DmpConfig::default(),
        with(RegressionConfig::Lwr(Lwr {})),
        with(RegressionConfig::Recursive(Recursive::default())),
        DmpConfig { form: DmpForm::Scaled, ..DmpConfig::default() },
    ]
}

fn bent(by_mm: f64) -> Trajectory {
    sampled(2.0, 401, |r| 100.0 * minimum_jerk(r) + by_mm * (4.0 * r * (1.0 - r)).powi(3))
}

// ends in motion, and, for the scaled form, where it started
fn unfit() -> Trajectory {
    sampled(1.0, 301, |r| 50.0 * (std::f64::consts::TAU * r).sin())
}

#[test]
fn a_weight_of_zero_leaves_a_demonstration_out() {
    for config in configs() {
        let both = Dmp::learn_weighted(&config, &[bent(20.0), unfit()], &[3.0, 0.0]).unwrap();
        assert_eq!(both, Dmp::learn_weighted(&config, &[bent(20.0)], &[3.0]).unwrap());
        assert!(!both.fades_before_end());
    }
}

#[test]
fn doubling_all_weights_changes_nothing_but_rounding() {
    for config in configs() {
        let of = |weights: &[f64]| Dmp::learn_weighted(&config, &[bent(20.0), bent(-5.0)], weights).unwrap();
        let (once, twice) = (of(&[0.3, 0.7]), of(&[0.6, 1.4]));
        let difference = (once.weights() - twice.weights()).amax() / once.weights().amax();
        assert!(difference < SQUARE_ROOTS, "{difference:e}");
        assert_eq!(of(&[1.0, 1.0]), Dmp::learn(&config, &[bent(20.0), bent(-5.0)]).unwrap());
    }
}

#[test]
fn weights_blend_demonstrations_in_their_ratio() {
    for config in configs() {
        let blend = Dmp::learn_weighted(&config, &[bent(20.0), bent(-20.0)], &[3.0, 1.0]).unwrap();
        let expected = Dmp::learn(&config, &[bent(10.0)]).unwrap();
        let [found, expected] = [blend, expected].map(|dmp| rollout(&dmp, 0.0, 100.0, 2.0, 0.01));
        let difference = found.positions().samples() - expected.positions().samples();
        assert_abs_diff_eq!(difference.amax(), 0.0, epsilon = ROUNDING_MM);
    }
}

#[test]
fn weights_that_are_none_are_refused_by_name() {
    let named = |weights: &[f64]| match Dmp::learn_weighted(&DmpConfig::default(), &[bent(1.0), bent(2.0)], weights) {
        Err(SkillError::InvalidArgument { argument, .. }) => argument,
        other => panic!("{other:?}"),
    };
    assert_eq!(named(&[1.0]), "number of weights");
    assert_eq!(named(&[1.0, -1.0]), "weight");
    assert_eq!(named(&[f64::NAN, 1.0]), "weight");
    assert_eq!(named(&[0.0, 0.0]), "sum of weights");
}

// three demonstrations of f = s(1 + 2 sin 4s) + a level of its own, at `instants` each
fn shown(instants: &[f64]) -> ForcingSamples {
    let count = instants.len();
    let phases = DVector::from_fn(3 * count, |m, _| instants[m % count]);
    let value = |m: usize| phases[m] * (1.0 + 2.0 * (4.0 * phases[m]).sin() + 0.5 * (m / count) as f64);
    let targets = DMatrix::from_fn(3 * count, 1, |m, _| value(m));
    ForcingSamples { weights: DVector::repeat(3 * count, 1.0), phases, targets }
}

fn basis() -> GaussianBasis {
    GaussianBasis::uniform_in_time(10, CanonicalSystem::new(100f64.ln()), 0.5)
}

// Σ over all samples of (F − f(s))²
fn sum_of_squares(weights: &DMatrix<f64>, samples: &ForcingSamples) -> f64 {
    (basis().design_matrix(&samples.phases) * weights - &samples.targets).norm_squared()
}

#[test]
fn equation_4_as_printed_sums_over_demonstrations_and_does_not_determine_the_weights() {
    let instants: Vec<f64> = (0..200).map(|m| 0.01f64.powf(f64::from(m) / 199.0)).collect();
    // printed: one term per demonstration j; three equations for ten weights, whichever instant is meant
    let printed = shown(&[0.3]);
    let undetermined = SkillError::Undetermined { samples: 3, bases: 10 };
    assert_eq!(Ridge { lambda: 0.0 }.fit(&printed, &basis()), Err(undetermined));
    // used: the terms of all samples; the weights are unique and no others do better
    let used = Ridge { lambda: 0.0 }.fit(&shown(&instants), &basis()).unwrap();
    let least = sum_of_squares(&used, &shown(&instants));
    for i in 0..10 {
        for change in [-0.1, 0.1] {
            let mut other = used.clone();
            other[(i, 0)] += change;
            assert!(sum_of_squares(&other, &shown(&instants)) > least);
        }
    }
}

#[test]
fn equation_4_as_printed_has_another_minimum_in_locally_weighted_regression() {
    let instants: Vec<f64> = (0..200).map(|m| 0.01f64.powf(f64::from(m) / 199.0)).collect();
    let printed = Lwr {}.fit(&shown(&[0.3]), &basis()).unwrap();
    let used = Lwr {}.fit(&shown(&instants), &basis()).unwrap();
    // printed: every basis takes the mean of F/s at the one instant, 1 + 2 sin 1.2 + 0.5, so the shape is lost
    let mean = 1.5 + 2.0 * 1.2f64.sin();
    printed.iter().for_each(|weight| assert_abs_diff_eq!(*weight, mean, epsilon = 1e-12));
    assert!(used.max() - used.min() > 2.0);
    let all = shown(&instants);
    assert!(sum_of_squares(&used, &all) < 0.7 * sum_of_squares(&printed, &all));
}

#[test]
fn weights_absorbed_on_line_make_a_primitive() {
    let config = DmpConfig { regression: RegressionConfig::Lwr(Lwr {}), ..DmpConfig::default() };
    let dmp = Dmp::learn(&config, &[bent(20.0)]).unwrap();
    // a second run is taken in sample by sample: residual form, so Eq. (5) of x − mj is αβξ + ατξ̇ + τ²ξ̈
    let mut fit = RecursiveFit::new(&Recursive::default(), dmp.basis().clone(), 1).unwrap();
    for m in 0..=400 {
        let r = f64::from(m) / 400.0;
        let (b, rate) = (4.0 * r * (1.0 - r), 4.0 - 8.0 * r);
        let bend = [b.powi(3), 3.0 * b * b * rate, 6.0 * b * rate * rate - 24.0 * b * b].map(|value| -20.0 * value);
        fit.absorb(dmp.canonical().phase(r), &[156.25 * bend[0] + 25.0 * bend[1] + bend[2]], 1.0).unwrap();
    }
    let updated = dmp.with_weights(fit.weights().clone()).unwrap();
    let [found, expected] = [updated, Dmp::learn(&config, &[bent(-20.0)]).unwrap()]
        .map(|dmp| rollout(&dmp, 0.0, 100.0, 2.0, 0.005).into_positions());
    // differences of the batch over 1/400 of the motion
    assert_abs_diff_eq!((found.samples() - expected.samples()).amax(), 0.0, epsilon = 0.02);
    assert!(dmp.with_weights(DMatrix::zeros(3, 1)).is_err());
    assert!(dmp.with_weights(DMatrix::repeat(50, 1, f64::NAN)).is_err());
}

#[test]
fn the_recursive_regression_learns_the_primitive_of_the_batch() {
    let of = |regression| {
        let config = DmpConfig { regression, ..DmpConfig::default() };
        Dmp::learn(&config, &[demonstration()]).unwrap()
    };
    let (batch, recursive) = (of(RegressionConfig::Lwr(Lwr {})), of(RegressionConfig::Recursive(Recursive::default())));
    // 6e-10 was measured with a covariance that begins finite; here it begins infinite
    let difference = (batch.weights() - recursive.weights()).amax() / batch.weights().amax();
    assert!(difference < 1e-12, "{difference:e}");
}
