//! Generalization chosen from demonstrations whose rule is known.

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector, Rotation2, Vector2, dvector};
use proptest::prelude::*;

use super::*;
use crate::primitive::{DmpConfig, PrimitiveConfig};

/// Rounding of positions of order one after a fit of condition 1e8.
const ROUNDING: f64 = 1e-7;
/// Reproduction of a shape of order one by 50 bases.
const FIT: f64 = 1e-3;

// a bump of the given height beside the straight way along `displacement`, from the origin
fn arched(displacement: Vector2<f64>, height: f64) -> Trajectory {
    let aside = Vector2::new(-displacement.y, displacement.x).normalize();
    let at = |row: usize| {
        let r = row as f64 / 200.0;
        displacement * minimum_jerk(r) + aside * (height * 16.0 * (r * (1.0 - r)).powi(2))
    };
    Trajectory::uniform(0.01, DMatrix::from_fn(201, 2, |row, k| at(row)[k])).unwrap()
}

fn only(rule: Rule) -> GeneralizingConfig {
    GeneralizingConfig { rules: vec![rule], ..GeneralizingConfig::default() }
}

fn to(goal: Vector2<f64>) -> RolloutRequest {
    RolloutRequest::new(DVector::zeros(2), dvector![goal.x, goal.y], 2.0, 0.01)
}

fn error(primitive: &Generalizing, expected: &Trajectory) -> f64 {
    let goal = expected.end();
    let found = primitive.rollout(&to(Vector2::new(goal[0], goal[1]))).unwrap();
    (found.positions().samples() - expected.samples()).amax()
}

#[test]
fn one_demonstration_under_the_translation_rule_is_the_residual_dmp() {
    let shown = arched(Vector2::new(1.0, 0.2), 0.3);
    let dmp = Dmp::learn(&DmpConfig::default(), std::slice::from_ref(&shown)).unwrap();
    let primitive = Generalizing::learn(&only(Rule::Translation), &[shown]).unwrap();
    let request = to(Vector2::new(0.5, 0.9));
    assert_eq!(primitive.rollout(&request).unwrap(), dmp.rollout(&request).unwrap());
}

#[test]
fn arches_that_turn_and_grow_with_their_displacement_are_found_to_be_similar() {
    let ways = [Vector2::new(1.0, 0.0), Vector2::new(0.0, 1.5), Vector2::new(-0.8, 0.3), Vector2::new(0.5, -0.5)];
    let shown: Vec<_> = ways.iter().map(|way| arched(*way, 0.3 * way.norm())).collect();
    let primitive = Generalizing::learn(&GeneralizingConfig::default(), &shown).unwrap();
    assert_eq!(primitive.chosen(), Rule::Similarity);
    let similar = primitive.scores().iter().find(|score| score.rule == Rule::Similarity).unwrap();
    assert!(similar.error.unwrap() < ROUNDING && similar.share > 0.99, "{similar:?}");
    let way = Vector2::new(-1.0, -1.0);
    assert!(error(&primitive, &arched(way, 0.3 * way.norm())) < FIT);
}

#[test]
fn arches_of_one_height_in_one_direction_are_found_to_be_translated() {
    let shown = [0.6, 0.9, 1.4, 2.0].map(|length| arched(Vector2::new(length, 0.0), 0.3));
    let primitive = Generalizing::learn(&GeneralizingConfig::default(), &shown).unwrap();
    assert_eq!(primitive.chosen(), Rule::Translation);
    assert!(error(&primitive, &arched(Vector2::new(1.1, 0.0), 0.3)) < FIT);
}

#[test]
fn heights_that_grow_linearly_with_the_distance_are_learned_by_the_linear_rule() {
    // not similar: the arch shrinks as the way grows
    let height = |length: f64| 0.9 - 0.3 * length;
    let shown = [0.6, 0.9, 1.4, 2.0, 2.3].map(|length| arched(Vector2::new(length, 0.0), height(length)));
    let config = GeneralizingConfig { shrinkage: 1e-6, ..GeneralizingConfig::default() };
    let primitive = Generalizing::learn(&config, &shown).unwrap();
    assert_eq!(primitive.chosen(), Rule::Linear);
    assert!(error(&primitive, &arched(Vector2::new(1.1, 0.0), height(1.1))) < FIT);
}

#[test]
fn two_ways_of_doing_it_are_kept_apart_by_the_local_rule() {
    let shown = [
        arched(Vector2::new(1.0, 0.00), 0.4),
        arched(Vector2::new(1.0, 0.02), 0.4),
        arched(Vector2::new(-1.0, 0.00), 0.4),
        arched(Vector2::new(-1.0, 0.02), 0.4),
        arched(Vector2::new(0.0, 1.00), -0.4),
        arched(Vector2::new(0.02, 1.0), -0.4),
    ];
    let primitive =
        Generalizing::learn(&GeneralizingConfig { neighborhood: 0.2, ..only(Rule::Local) }, &shown).unwrap();
    assert!(error(&primitive, &arched(Vector2::new(-1.0, 0.01), 0.4)) < 0.02);
    assert!(error(&primitive, &arched(Vector2::new(0.01, 1.0), -0.4)) < 0.02);
    let mean = Generalizing::learn(&only(Rule::Translation), &shown).unwrap();
    assert!(error(&mean, &arched(Vector2::new(0.01, 1.0), -0.4)) > 0.2);
}

#[test]
fn a_single_demonstration_is_half_translated_and_half_turned() {
    let shown = arched(Vector2::new(1.0, 0.0), 0.3);
    let primitive = Generalizing::learn(&GeneralizingConfig::default(), std::slice::from_ref(&shown)).unwrap();
    let rules: Vec<_> = primitive.scores().iter().map(|score| (score.rule, score.error, score.share)).collect();
    assert_eq!(rules, [(Rule::Translation, None, 0.5), (Rule::Similarity, None, 0.5)]);
    // the shown task is reproduced by either
    assert!(error(&primitive, &shown) < FIT);
    // a quarter turn moves half of the arch from y to −x
    let found = primitive.rollout(&to(Vector2::new(0.0, 1.0))).unwrap();
    let middle = found.positions().at(1.0);
    assert_relative_eq!(middle, dvector![-0.15, 0.5 + 0.15], epsilon = FIT);
}

#[test]
fn rules_that_need_more_demonstrations_give_way_to_the_translation() {
    let primitive = Generalizing::learn(&only(Rule::Linear), &[arched(Vector2::new(1.0, 0.0), 0.3)]).unwrap();
    assert_eq!(primitive.chosen(), Rule::Translation);
}

#[test]
fn a_saved_primitive_rolls_out_the_same_bits() {
    let shown = [0.6, 0.9, 1.4, 2.0].map(|length| arched(Vector2::new(length, 0.1 * length), 0.3));
    let primitive = Generalizing::learn(&GeneralizingConfig::default(), &shown).unwrap();
    let text = serde_json::to_string(&primitive.saved()).unwrap();
    let restored = serde_json::from_str::<SavedGeneralizing>(&text).unwrap().restore().unwrap();
    assert_eq!(restored, primitive);
    let request = to(Vector2::new(-0.4, 1.7));
    assert_eq!(restored.rollout(&request).unwrap(), primitive.rollout(&request).unwrap());
}

#[test]
fn a_damaged_file_is_refused() {
    let shown = [arched(Vector2::new(1.0, 0.0), 0.3), arched(Vector2::new(2.0, 0.0), 0.3)];
    let good = Generalizing::learn(&GeneralizingConfig::default(), &shown).unwrap().saved();
    let refused = |damage: fn(&mut SavedGeneralizing)| {
        let mut saved = good.clone();
        damage(&mut saved);
        saved.restore().unwrap_err()
    };
    assert!(matches!(refused(|saved| saved.weights.clear()), SkillError::NoDemonstrations));
    assert!(matches!(refused(|saved| saved.path_lengths.push(1.0)), SkillError::RowCount { .. }));
    assert!(matches!(refused(|saved| saved.weights[1][(0, 0)] = f64::NAN), SkillError::NonFinite { .. }));
    assert!(matches!(refused(|saved| saved.weights[1] = DMatrix::zeros(50, 3)), SkillError::Dimension { .. }));
    assert!(matches!(refused(|saved| saved.displacements[0] = DVector::zeros(1)), SkillError::Dimension { .. }));
    let not_finite = refused(|saved| saved.displacements[0][1] = f64::INFINITY);
    assert!(matches!(not_finite, SkillError::InvalidArgument { argument: "displacement", .. }));
    let shares = refused(|saved| saved.scores[0].share = 0.9);
    assert!(matches!(shares, SkillError::InvalidArgument { argument: "share", .. }));
    assert!(matches!(refused(|saved| saved.config.shrinkage = 0.0), SkillError::InvalidConfig(_)));
}

#[test]
fn nothing_to_learn_from_and_unequal_dimensions_are_refused() {
    let config = PrimitiveConfig::Generalizing(GeneralizingConfig::default());
    assert_eq!(config.learn(&[]).unwrap_err(), SkillError::NoDemonstrations);
    let line = Trajectory::uniform(1.0, DMatrix::from_column_slice(2, 1, &[0.0, 1.0])).unwrap();
    let error = config.learn(&[arched(Vector2::new(1.0, 0.0), 0.3), line]).unwrap_err();
    assert!(matches!(error, SkillError::DemonstrationDimension { demonstration: 1, found: 1, expected: 2 }));
}

#[test]
fn samples_whose_squares_overflow_are_refused() {
    let huge = |peak: f64| Trajectory::uniform(1.0, DMatrix::from_column_slice(4, 1, &[0.0, peak, peak, 1.0])).unwrap();
    let error = Generalizing::learn(&GeneralizingConfig::default(), &[huge(1e200), huge(-1e200)]).unwrap_err();
    assert!(matches!(error, SkillError::InvalidArgument { operation: "learn primitive", .. }), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_task_that_is_moved_turned_and_scaled_moves_turns_and_scales_a_similar_motion(
        angle in -3.1f64..3.1, scale in 0.2f64..5.0, x in -2.0f64..2.0, y in -2.0f64..2.0,
    ) {
        let shown = arched(Vector2::new(1.0, 0.4), 0.3);
        let primitive = Generalizing::learn(&only(Rule::Similarity), &[shown]).unwrap();
        let turn = Rotation2::new(angle);
        let goal = Vector2::new(0.3, 0.8);
        let here = primitive.rollout(&to(goal)).unwrap();
        let moved = turn * goal * scale + Vector2::new(x, y);
        let request = RolloutRequest::new(dvector![x, y], dvector![moved.x, moved.y], 2.0, 0.01);
        let there = primitive.rollout(&request).unwrap();
        for (here, there) in here.positions().samples().row_iter().zip(there.positions().samples().row_iter()) {
            let expected = turn * Vector2::new(here[0], here[1]) * scale + Vector2::new(x, y);
            prop_assert!((Vector2::new(there[0], there[1]) - expected).norm() < ROUNDING);
        }
    }

    #[test]
    fn every_rollout_begins_at_its_start_and_tends_to_its_goal(
        start in prop::array::uniform2(-3.0f64..3.0), goal in prop::array::uniform2(-3.0f64..3.0),
    ) {
        let shown = [0.6, 0.9, 1.4, 2.0].map(|length| arched(Vector2::new(length, 0.1), 0.3));
        let primitive = Generalizing::learn(&GeneralizingConfig::default(), &shown).unwrap();
        let request = RolloutRequest {
            settle_s: 2.0, ..RolloutRequest::new(DVector::from_row_slice(&start), DVector::from_row_slice(&goal), 2.0, 0.01)
        };
        let found = primitive.rollout(&request).unwrap();
        prop_assert_eq!(found.positions().start(), request.start);
        prop_assert!((found.positions().end() - request.goal).norm() < FIT);
    }
}
