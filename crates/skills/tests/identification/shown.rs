//! From demonstrations rolled out past obstacles back to the skill and the obstacle term behind them.

use nalgebra::dvector;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use skills::primitive::{MovementPrimitive, RolloutRequest};
use skills::separation::model_based::{
    IdentificationConfig, IdentificationError, LogForm, ModelBasedConfig, ObstructedDemonstration, Separation, identify,
};
use skills::{Dmp, DmpConfig, DmpForm};

use crate::support::{DURATION_S, algorithm_one, demonstrate, errors, intention, measured};

const START: [f64; 2] = [0.0, 0.0];
const GOAL: [f64; 2] = [1.0, 0.0];
/// Relative error of the parameters that second differences over steps of 1/500 of the duration leave.
const DIFFERENCES: f64 = 0.01;

fn with(identification: IdentificationConfig) -> ModelBasedConfig {
    ModelBasedConfig { identification, ..ModelBasedConfig::default() }
}

fn in_form(form: DmpForm) -> ModelBasedConfig {
    ModelBasedConfig { primitive: DmpConfig { form, ..DmpConfig::default() }, ..ModelBasedConfig::default() }
}

fn worst_error(separation: &Separation) -> f64 {
    errors(separation.estimate.parameters).into_iter().fold(0.0, f64::max)
}

fn free_and_obstructed() -> [ObstructedDemonstration; 2] {
    [demonstrate(START, GOAL, None), demonstrate(START, GOAL, Some([0.5, 0.12]))]
}

fn from_everywhere() -> [ObstructedDemonstration; 4] {
    [
        demonstrate([0.0, 0.0], [1.0, 0.0], Some([0.5, 0.12])),
        demonstrate([0.1, -0.2], [1.0, 0.1], Some([0.6, -0.1])),
        demonstrate([-0.1, 0.1], [0.9, -0.1], Some([0.35, 0.15])),
        demonstrate([0.0, -0.1], [1.1, 0.0], None),
    ]
}

#[test]
fn an_obstacle_free_demonstration_makes_half_of_the_term_visible() {
    let shown = free_and_obstructed();
    let found = identify(&ModelBasedConfig::default(), &shown).unwrap();
    for sin_squared in found.estimate.sin_squared {
        assert!((sin_squared - 0.5).abs() < 0.01, "{sin_squared}");
    }
    assert!(worst_error(&found) < DIFFERENCES, "{:?}", found.estimate.parameters);
    // a round of Algorithm 1 then halves the error: only here it takes "a few steps"
    let rounds = identify(&with(algorithm_one(LogForm::Weighted)), &shown).unwrap();
    assert!(rounds.estimate.converged && rounds.estimate.history.len() < 40);
    assert!(worst_error(&rounds) < DIFFERENCES, "{:?}", rounds.estimate.parameters);
}

#[test]
fn the_more_alike_the_obstacles_the_less_is_visible() {
    let identified = |other: Option<[f64; 2]>| {
        let shown = [Some([0.5, 0.12]), other].map(|obstacle| demonstrate(START, GOAL, obstacle));
        let found = identify(&ModelBasedConfig::default(), &shown).unwrap();
        assert!(worst_error(&found) < DIFFERENCES, "{:?}", found.estimate.parameters);
        found.estimate.sin_squared[0]
    };
    let (free, across, beside) = (identified(None), identified(Some([0.35, -0.08])), identified(Some([0.4, 0.12])));
    assert!(beside < 0.5 * across && across < 0.95 * free, "{beside} {across} {free}");
}

#[test]
fn the_separated_skill_is_the_intention_from_other_starts_too() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let shown = from_everywhere().map(|shown| measured(&shown, 1e-5, &mut random));
    let separation = identify(&ModelBasedConfig::default(), &shown).unwrap();
    let request = RolloutRequest::new(dvector![0.2, 0.3], dvector![0.9, 0.6], DURATION_S, 0.01);
    let positions = |skill: &Dmp| skill.rollout(&request).unwrap().into_positions().samples().clone();
    let intended = positions(&intention());
    let error = (positions(&separation.skill) - &intended).amax();
    assert!(error < 1e-3, "{error}");
    // learned as shown, the turns stay in the skill
    let trajectories = shown.map(|shown| shown.trajectory);
    let mixed = (positions(&Dmp::learn(&DmpConfig::default(), &trajectories).unwrap()) - intended).amax();
    assert!(mixed > 20.0 * error, "{mixed}");
    // and the obstacle term turns the separated skill as it turned the intention
    let law = separation.coupling(vec![vec![0.4, 0.1]]).unwrap();
    assert_eq!((law.gamma(), law.beta()), (separation.estimate.parameters.gamma, separation.estimate.parameters.beta));
}

#[test]
fn the_form_of_equation_1_shares_its_forcing_term_between_equal_displacements_only() {
    let equal = identify(&in_form(DmpForm::Eq1Literal), &free_and_obstructed()).unwrap();
    assert!(worst_error(&equal) < DIFFERENCES, "{:?}", equal.estimate.parameters);
    let shown = from_everywhere();
    let residual = identify(&in_form(DmpForm::Residual), &shown).unwrap();
    assert!(worst_error(&residual) < DIFFERENCES, "{:?}", residual.estimate.parameters);
    // differing displacements: refused, or an error that the residual tells
    if let Ok(literal) = identify(&in_form(DmpForm::Eq1Literal), &shown) {
        assert!(literal.estimate.residual > 10.0 * residual.estimate.residual, "{:?}", literal.estimate);
    }
}

#[test]
fn a_goal_that_was_missed_and_not_told_biases_the_parameters() {
    let told = free_and_obstructed();
    let untold = told.clone().map(|shown| ObstructedDemonstration { goal: None, ..shown });
    let [told, untold] = [told, untold].map(|shown| identify(&ModelBasedConfig::default(), &shown).unwrap());
    assert!(worst_error(&untold) > 4.0 * worst_error(&told), "{:?}", untold.estimate.parameters);
}

#[test]
fn noise_hurts_the_literal_form_most_and_variable_projection_least() {
    let shown = [Some([0.5, 0.12]), Some([0.35, -0.08])].map(|obstacle| demonstrate(START, GOAL, obstacle));
    let median = |identification: IdentificationConfig| -> [f64; 2] {
        let config = with(identification);
        let found: Vec<[f64; 2]> = (0..8)
            .map(|seed| {
                let mut random = ChaCha8Rng::seed_from_u64(seed);
                let shown = shown.clone().map(|shown| measured(&shown, 1e-4, &mut random));
                match identify(&config, &shown) {
                    Ok(found) => errors(found.estimate.parameters),
                    // an estimate all the same, only not one to be used
                    Err(IdentificationError::Misfit { .. }) => [f64::INFINITY; 2],
                    Err(other) => panic!("{other}"),
                }
            })
            .collect();
        [0, 1].map(|k| {
            let mut errors: Vec<f64> = found.iter().map(|errors| errors[k]).collect();
            errors.sort_by(f64::total_cmp);
            0.5 * (errors[3] + errors[4])
        })
    };
    let literal = median(algorithm_one(LogForm::LiteralLog));
    let projected = median(algorithm_one(LogForm::Projected));
    let weighted = median(algorithm_one(LogForm::Weighted));
    let projection = median(IdentificationConfig::default());
    for k in [0, 1] {
        assert!(literal[k] > 3.0 * weighted[k] && projected[k] > 3.0 * weighted[k]);
        assert!(weighted[k] > 2.0 * projection[k]);
        assert!(literal[k] > 0.1 && projection[k] < 0.05);
    }
}
