//! Two motions coupled to keep a relative position.

use nalgebra::{DMatrix, DVector};
use skills::coupling::{CooperativeConfig, CooperativeCoupling};
use skills::{Dmp, DmpConfig, DmpForm, DmpPair, MovementPrimitive, Rollout, RolloutRequest, SkillError, rollout_pair};

use super::accuracy::compared;

/// A thousand roundings of numbers of order one, magnified by the stiffness.
const ROUNDING: f64 = 1e-11;
/// αβ of the default attractor.
const ATTRACTOR: f64 = 156.25;

fn learned() -> Dmp {
    Dmp::learn(&DmpConfig::default(), &[compared(2)]).unwrap()
}

fn request(start: [f64; 2], goal: [f64; 2]) -> RolloutRequest {
    let [start, goal] = [start, goal].map(|values| DVector::from_row_slice(&values));
    RolloutRequest { settle_s: 1.0, ..RolloutRequest::new(start, goal, 1.0, 0.001) }
}

fn coupling(stiffness: f64, damping: f64) -> CooperativeCoupling {
    CooperativeCoupling::new(CooperativeConfig { stiffness, damping }, vec![0.0, 0.3]).unwrap()
}

// the second motion departs from its partner by more than the wanted separation (0, 0.3) all along: to (0.1, 0.2)
fn disagreeing() -> (RolloutRequest, RolloutRequest) {
    (request([0.0, 0.0], [0.5, 0.6]), request([0.0, 0.3], [0.6, 0.8]))
}

fn rolled(coupling: &CooperativeCoupling) -> (Rollout, Rollout) {
    let (first, second) = disagreeing();
    rollout_pair((&learned(), &first), (&learned(), &second), coupling).unwrap()
}

// rows of x₂ − x₁ − (0, 0.3)
fn departure((first, second): &(Rollout, Rollout)) -> DMatrix<f64> {
    let mut relative = second.positions().samples() - first.positions().samples();
    relative.column_mut(1).add_scalar_mut(-0.3);
    relative
}

#[test]
fn no_strength_leaves_both_rollouts_bit_for_bit() {
    let (first, second) = disagreeing();
    let bits = |table: &DMatrix<f64>| table.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    let pair = rolled(&coupling(0.0, 0.0));
    for (coupled, request) in [(pair.0, first), (pair.1, second)] {
        let alone = learned().rollout(&request).unwrap();
        assert_eq!(bits(coupled.positions().samples()), bits(alone.positions().samples()));
        assert_eq!(bits(coupled.accelerations()), bits(alone.accelerations()));
    }
}

#[test]
fn equal_and_opposite_terms_leave_the_mean_of_the_pair() {
    let sum = |pair: &(Rollout, Rollout)| pair.0.positions().samples() + pair.1.positions().samples();
    let coupled = sum(&rolled(&CooperativeCoupling::new(CooperativeConfig::default(), vec![0.0, 0.3]).unwrap()));
    assert!((coupled - sum(&rolled(&coupling(0.0, 0.0)))).amax() < ROUNDING);
}

#[test]
fn a_lasting_disagreement_shrinks_by_the_ratio_of_the_stiffnesses() {
    for stiffness in [100.0, 1000.0, 3000.0] {
        let end = departure(&rolled(&coupling(stiffness, 30.0)));
        let end = end.row(end.nrows() - 1);
        let left = ATTRACTOR / (ATTRACTOR + 2.0 * stiffness);
        // what is left of the motion a whole duration after its end
        approx::assert_abs_diff_eq!(end[0], 0.1 * left, epsilon = 1e-4);
        approx::assert_abs_diff_eq!(end[1], -0.1 * left, epsilon = 1e-4);
    }
}

#[test]
fn a_wrong_separation_at_the_start_converges_to_the_wanted_one() {
    // same goals apart from the separation, a start 0.2 too near
    let (first, second) = (request([0.0, 0.0], [0.5, 0.6]), request([0.0, 0.1], [0.5, 0.9]));
    let of = |coupling: &CooperativeCoupling| {
        departure(&rollout_pair((&learned(), &first), (&learned(), &second), coupling).unwrap())
    };
    let (free, coupled) = (of(&coupling(0.0, 0.0)), of(&coupling(1000.0, 33.9)));
    let largest = |table: &DMatrix<f64>, from: usize| table.rows(from, 1001 - from).amax();
    // free, the error goes with the transfer, which passes half of it at half of the time
    assert!(largest(&free, 500) > 0.09);
    // critically damped at √(αβ + 2k) = 46 per duration, the rest lags behind the transfer by αβ/(αβ + 2k)
    assert!(largest(&coupled, 500) < 0.02, "{}", largest(&coupled, 500));
    assert!(largest(&coupled, 200) < largest(&free, 200) / 4.0);
}

#[test]
fn the_terms_on_the_two_motions_are_opposite_at_every_step() {
    let (first, second) = disagreeing();
    let dmp = Dmp::learn(&DmpConfig { form: DmpForm::Eq1Literal, ..DmpConfig::default() }, &[compared(2)]).unwrap();
    let motions = [dmp.stepper(&first).unwrap(), dmp.stepper(&second).unwrap()];
    let [mut free, mut other] = motions.clone();
    let [one, two] = motions;
    let mut pair = DmpPair::new(one, two, coupling(1000.0, 33.9)).unwrap();
    free.step(0.001).unwrap();
    other.step(0.001).unwrap();
    pair.step(0.001).unwrap();
    let pushed = [pair.first().velocity() - free.velocity(), pair.second().velocity() - other.velocity()];
    assert_eq!(pushed[0].amax(), 0.0, "the pair starts as far apart as wanted");
    for _ in 0..100 {
        pair.step(0.001).unwrap();
        free.step(0.001).unwrap();
        other.step(0.001).unwrap();
        let pushed = (pair.first().position() - free.position()) + (pair.second().position() - other.position());
        assert!(pushed.amax() < ROUNDING);
    }
    assert!((pair.first().position() - free.position()).amax() > 1e-4);
}

#[test]
fn requests_of_other_times_and_motions_of_other_dimensions_are_refused() {
    let (first, mut second) = disagreeing();
    second.duration_s = 2.0;
    let refused = rollout_pair((&learned(), &first), (&learned(), &second), &coupling(1.0, 1.0));
    assert!(matches!(refused, Err(SkillError::InvalidArgument { argument: "duration_s", .. })));
    let line = CooperativeCoupling::new(CooperativeConfig::default(), vec![0.1]).unwrap();
    let refused = rollout_pair((&learned(), &first), (&learned(), &first), &line);
    assert!(matches!(refused, Err(SkillError::Dimension { found: 2, expected: 1, .. })));
}
