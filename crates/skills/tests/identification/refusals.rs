//! What is refused, and how.

use nalgebra::{DMatrix, DVector};
use skills::SkillError;
use skills::regression::ForcingSamples;
use skills::separation::model_based::{
    AlgorithmOneConfig, IdentificationConfig, IdentificationData, IdentificationError, LogForm, ModelBasedConfig,
    ObstructedDemonstration, Parameters, VariableProjectionConfig, estimate, identify,
};

use crate::support::{TRUTH, algorithm_one, config, demonstrate, direction, samples};

#[test]
fn one_demonstration_is_refused_with_the_remedy() {
    let shown = [demonstrate([0.0, 0.0], [1.0, 0.0], Some([0.5, 0.05]))];
    let refused = identify(&ModelBasedConfig::default(), &shown).unwrap_err();
    assert!(
        matches!(refused, IdentificationError::NotIdentifiable { found, expected } if found < 2e-3 && expected == 1e-2)
    );
    assert!(refused.to_string().ends_with("add an obstacle-free demonstration or one past another obstacle"));
}

#[test]
fn copies_of_one_demonstration_are_refused_like_one() {
    let shown = vec![demonstrate([0.0, 0.0], [1.0, 0.0], Some([0.5, 0.05])); 4];
    let refused = identify(&ModelBasedConfig::default(), &shown).unwrap_err();
    assert!(matches!(refused, IdentificationError::NotIdentifiable { .. }));
}

#[test]
fn demonstrations_without_an_obstacle_are_refused() {
    let free = demonstrate([0.0, 0.0], [1.0, 0.0], None);
    let refused = identify(&ModelBasedConfig::default(), &[free.clone(), free]).unwrap_err();
    assert_eq!(refused, IdentificationError::NoObstacle);
    let refused = identify(&ModelBasedConfig::default(), &[]).unwrap_err();
    assert_eq!(refused, IdentificationError::Skill(SkillError::NoDemonstrations));
}

#[test]
fn motions_that_turn_toward_their_obstacles_are_refused() {
    // the same samples with every direction reversed
    let data = samples(3, direction);
    let taken = ForcingSamples {
        phases: data.phases().clone(),
        targets: data.targets().clone(),
        weights: data.weights().clone(),
    };
    let reversed = IdentificationData::new(taken, -data.directions(), data.angles().clone()).unwrap();
    let refused = estimate(&config(IdentificationConfig::default()), &reversed).unwrap_err();
    assert!(matches!(refused, IdentificationError::Attracted { gamma, .. } if (gamma + 60.0).abs() < 1e-3));
}

#[test]
fn a_turn_that_grows_with_the_angle_is_refused() {
    // Δu = 60 n e^{+φ}: the decay that fits is −1
    let data = samples(3, direction);
    let growing = data.coupling(Parameters { gamma: 60.0, beta: -1.0 });
    let taken = ForcingSamples {
        phases: data.phases().clone(),
        targets: data.targets() - data.coupling(TRUTH) + growing,
        weights: data.weights().clone(),
    };
    let data = IdentificationData::new(taken, data.directions().clone(), data.angles().clone()).unwrap();
    let refused = estimate(&config(algorithm_one(LogForm::Weighted)), &data).unwrap_err();
    assert!(matches!(refused, IdentificationError::NegativeDecay { beta } if (beta + 1.0).abs() < 1e-3), "{refused:?}");
    let refused = estimate(&config(IdentificationConfig::default()), &data).unwrap_err();
    assert!(matches!(refused, IdentificationError::AtEdge { .. }), "{refused:?}");
}

#[test]
fn rounds_that_fit_worse_than_no_term_are_refused() {
    // stopped in the middle of overshooting, far above the truth
    let options = AlgorithmOneConfig { rounds: 1, eta: 0.01, initial_gamma: 1e6, ..AlgorithmOneConfig::default() };
    let options = config(IdentificationConfig::AlgorithmOne(options));
    let refused = estimate(&options, &samples(3, direction)).unwrap_err();
    assert!(
        matches!(refused, IdentificationError::Misfit { residual, residual_without } if residual > residual_without)
    );
}

#[test]
fn rounds_that_run_away_are_refused() {
    let form = LogForm::Projected;
    let options = AlgorithmOneConfig { form, initial_beta: 1e300, ..AlgorithmOneConfig::default() };
    let options = config(IdentificationConfig::AlgorithmOne(options));
    let refused = estimate(&options, &samples(3, direction)).unwrap_err();
    assert!(matches!(refused, IdentificationError::Diverged { round: 0 }), "{refused:?}");
}

#[test]
fn a_decay_outside_the_range_searched_is_refused() {
    for (least_beta, greatest_beta) in [(0.05, 1.0), (4.0, 50.0)] {
        let options = VariableProjectionConfig { least_beta, greatest_beta, ..VariableProjectionConfig::default() };
        let options = config(IdentificationConfig::VariableProjection(options));
        let refused = estimate(&options, &samples(3, direction)).unwrap_err();
        assert!(matches!(refused, IdentificationError::AtEdge { .. }), "{refused:?}");
    }
}

#[test]
fn obstacles_of_another_dimension_or_not_finite_are_refused() {
    let shown = demonstrate([0.0, 0.0], [1.0, 0.0], Some([0.5, 0.05]));
    let with = |obstacle: Vec<f64>| {
        let shown = ObstructedDemonstration { obstacle: Some(obstacle), ..shown.clone() };
        match identify(&ModelBasedConfig::default(), &[shown]) {
            Err(IdentificationError::Skill(error)) => error,
            other => panic!("{other:?}"),
        }
    };
    assert!(matches!(with(vec![0.5]), SkillError::Dimension { found: 1, expected: 2, .. }));
    assert!(matches!(with(vec![0.5; 3]), SkillError::Dimension { found: 3, expected: 2, .. }));
    assert!(matches!(with(vec![0.5, f64::NAN]), SkillError::NonFinite { row: 0, column: 1, .. }));
}

#[test]
fn samples_of_other_shapes_or_without_weight_are_refused() {
    let taken = |rows: usize, weight: f64| ForcingSamples {
        phases: DVector::repeat(rows, 0.5),
        targets: DMatrix::zeros(rows, 2),
        weights: DVector::repeat(rows, weight),
    };
    let built =
        |samples, rows, columns| IdentificationData::new(samples, DMatrix::zeros(rows, columns), DVector::zeros(rows));
    assert!(built(taken(3, 1.0), 3, 2).is_ok());
    assert!(matches!(built(taken(3, 1.0), 2, 2), Err(SkillError::RowCount { found: 2, .. })));
    assert!(matches!(built(taken(3, 1.0), 3, 1), Err(SkillError::Dimension { found: 1, expected: 2, .. })));
    assert!(matches!(built(taken(0, 1.0), 0, 2), Err(SkillError::RowCount { found: 0, .. })));
    for weight in [0.0, -1.0] {
        let refused = built(taken(3, weight), 3, 2);
        assert!(matches!(refused, Err(SkillError::InvalidArgument { argument: "weights", .. })), "{refused:?}");
    }
    assert!(matches!(built(taken(3, f64::NAN), 3, 2), Err(SkillError::NonFinite { .. })));
}
