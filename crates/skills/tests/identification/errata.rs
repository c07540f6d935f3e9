//! Where the printed equations fail, and what is used holds.

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use skills::basis::GaussianBasis;
use skills::canonical::CanonicalSystem;
use skills::regression::{ForcingSamples, Regression, Ridge};
use skills::separation::model_based::{IdentificationError, LogForm, estimate};

use crate::support::{BASES, SAMPLES, TRUTH, algorithm_one, angle, config, direction, errors, samples};

/// Effect of the ridge that holds the basis, 1e-8 of its mean, on the parameters.
const RIDGE: f64 = 1e-5;
/// A few roundings of logarithms and of two by two normal equations.
const ROUNDING: f64 = 1e-10;

#[test]
fn the_literal_logarithm_of_equation_11_loses_components_that_the_projection_keeps() {
    let data = samples(3, direction);
    let literal = estimate(&config(algorithm_one(LogForm::LiteralLog)), &data).unwrap();
    let projected = estimate(&config(algorithm_one(LogForm::Projected)), &data).unwrap();
    // n points in every direction, so half of its components have no logarithm
    assert!(literal.lost as f64 > 0.4 * (literal.used + literal.lost) as f64);
    assert!(errors(literal.parameters)[0] > 0.1, "{:?}", literal.parameters);
    assert_eq!(projected.lost, 0);
    assert!(errors(projected.parameters).iter().all(|error| *error < RIDGE), "{:?}", projected.parameters);
}

#[test]
fn the_literal_logarithm_of_equation_11_fails_on_a_turn_to_the_right_where_the_projection_holds() {
    // along x: a turn to the right has n = (0, −φ), of which no component has a logarithm
    let right = |j: usize, r: f64| [0.0, -angle(j, r) * r * (1.0 - r)];
    let data = samples(3, right);
    let literal = estimate(&config(algorithm_one(LogForm::LiteralLog)), &data);
    assert!(matches!(literal, Err(IdentificationError::EquationsLost { round: 0, used: 0, .. })), "{literal:?}");
    let weighted = estimate(&config(algorithm_one(LogForm::Weighted)), &data).unwrap();
    assert!(errors(weighted.parameters).iter().all(|error| *error < RIDGE), "{:?}", weighted.parameters);
}

#[test]
fn equation_14_needs_the_logarithm_of_the_direction_that_it_drops() {
    // the regression of T(Δu) on (1, −φ) alone, Δu known exactly and positive
    let fit = |transformed: &dyn Fn(f64, f64) -> f64| -> Vector2<f64> {
        let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
        for k in 1..100 {
            let r = f64::from(k) / 100.0;
            let angle = angle(0, r);
            let direction = angle * r * (1.0 - r);
            let regressor = Vector2::new(1.0, -angle);
            normal += regressor * regressor.transpose();
            right += regressor * transformed(TRUTH.gamma * direction * (-TRUTH.beta * angle).exp(), direction);
        }
        normal.cholesky().unwrap().solve(&right)
    };
    let used = fit(&|coupling, direction| coupling.ln() - direction.ln());
    assert_relative_eq!(used[0], TRUTH.gamma.ln(), max_relative = ROUNDING);
    assert_relative_eq!(used[1], TRUTH.beta, max_relative = ROUNDING);
    let printed = fit(&|coupling, _| coupling.ln());
    assert!((printed[1] / TRUTH.beta - 1.0).abs() > 0.2, "{printed}");
}

#[test]
fn equation_13_summed_over_demonstrations_alone_fits_nothing_but_one_instant() {
    let data = samples(3, direction);
    let canonical = CanonicalSystem::new(100f64.ln());
    let basis = GaussianBasis::uniform_in_time(BASES, canonical, 0.5);
    let intended = data.targets() - data.coupling(TRUTH);
    let error = |rows: &[usize]| {
        let chosen = ForcingSamples {
            phases: DVector::from_iterator(rows.len(), rows.iter().map(|row| data.phases()[*row])),
            targets: DMatrix::from_fn(rows.len(), 2, |row, k| intended[(rows[row], k)]),
            weights: DVector::repeat(rows.len(), 1.0),
        };
        let weights = Ridge::default().fit(&chosen, &basis).unwrap();
        (basis.design_matrix(data.phases()) * weights - &intended).norm() / intended.norm()
    };
    let everything: Vec<usize> = (0..3 * SAMPLES).collect();
    assert!(error(&everything) < RIDGE);
    // the printed sum: j = 1…N at one phase
    assert!(error(&[40, 40 + SAMPLES, 40 + 2 * SAMPLES]) > 0.5);
}
