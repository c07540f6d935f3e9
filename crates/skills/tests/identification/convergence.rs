//! How fast Algorithm 1 converges, and that it always ends.

use approx::assert_relative_eq;
use proptest::prelude::*;
use skills::separation::model_based::{
    AlgorithmOneConfig, Estimate, IdentificationConfig, IdentificationError, LogForm, estimate,
};

use crate::support::{algorithm_one, config, direction, errors, samples};

/// What is left of the faster direction of convergence, and of the second order, after the rounds compared.
const FIRST_ORDER: f64 = 1e-3;

fn run(demonstrations: usize, options: AlgorithmOneConfig) -> Result<Estimate, IdentificationError> {
    estimate(&config(IdentificationConfig::AlgorithmOne(options)), &samples(demonstrations, direction))
}

#[test]
fn the_rate_of_convergence_is_the_predicted_one() {
    for demonstrations in [1, 2, 3, 4] {
        for eta in [0.5, 1.0] {
            let found =
                run(demonstrations, AlgorithmOneConfig { eta, tolerance: 1e-10, ..Default::default() }).unwrap();
            assert!(found.converged);
            let step = |k: usize| {
                let (from, to) = (found.history[k - 1], found.history[k]);
                (to.gamma / from.gamma).ln().hypot(to.beta - from.beta)
            };
            let last = found.history.len() - 1;
            assert_relative_eq!(step(last) / step(last - 1), found.contraction(eta), max_relative = FIRST_ORDER);
        }
    }
}

#[test]
fn rounds_that_run_out_are_reported() {
    let found = run(3, AlgorithmOneConfig { rounds: 3, ..Default::default() }).unwrap();
    assert_eq!((found.converged, found.history.len()), (false, 3));
    assert!(errors(found.parameters)[0] > 1e-3);
}

#[test]
fn variable_projection_needs_no_rounds_where_algorithm_1_needs_hundreds() {
    let rounds = run(1, AlgorithmOneConfig::default()).unwrap().history.len();
    assert!(rounds > 200, "{rounds}");
    let found = estimate(&config(IdentificationConfig::default()), &samples(1, direction)).unwrap();
    assert!(errors(found.parameters).iter().all(|error| *error < 1e-5), "{:?}", found.parameters);
}

proptest! {
    // each case is up to 60 rounds over 303 samples
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn algorithm_1_always_ends_within_its_rounds(
        initial_gamma in 1e-3f64..1e4, initial_beta in 0f64..50.0, eta in 0.01f64..1.99, form in 0usize..3,
        demonstrations in 1usize..4,
    ) {
        let form = [LogForm::LiteralLog, LogForm::Projected, LogForm::Weighted][form];
        let options =
            AlgorithmOneConfig { form, eta, rounds: 60, initial_gamma, initial_beta, ..Default::default() };
        if let Ok(found) = run(demonstrations, options) {
            prop_assert!(found.history.len() <= 60);
            prop_assert!(found.parameters.gamma.is_finite() && found.parameters.beta.is_finite());
            prop_assert!(found.converged || found.history.len() == 60);
        }
    }
}

#[test]
fn the_same_samples_give_the_same_bits() {
    let [a, b] = [(); 2].map(|()| estimate(&config(algorithm_one(LogForm::Weighted)), &samples(3, direction)).unwrap());
    assert_eq!(a, b);
}
