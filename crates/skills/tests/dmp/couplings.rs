//! Couplings of Eq. (6) on a motion: what they add, that nothing added is nothing changed, and refusals.

use nalgebra::{DVector, dvector};
use skills::coupling::{
    Coupling, DynamicPotential, MotionState, PointObstacle, PotentialConfig, PotentialCoupling, StaticPotential,
};
use skills::{Dmp, DmpConfig, DmpForm, MovementPrimitive, Rollout, RolloutRequest, SkillError};

use super::accuracy::compared;

/// Adds the same to every coordinate from some time on.
#[derive(Debug)]
struct Constant {
    added: f64,
    from_s: f64,
}

impl Coupling for Constant {
    fn add_to(&self, state: &MotionState<'_>, sum: &mut [f64]) {
        if state.elapsed_s >= self.from_s {
            sum.iter_mut().for_each(|sum| *sum += self.added);
        }
    }
}

fn always(added: f64) -> Constant {
    Constant { added, from_s: 0.0 }
}

fn learned() -> Dmp {
    Dmp::learn(&DmpConfig::default(), &[compared(2)]).unwrap()
}

fn request(duration_s: f64) -> RolloutRequest {
    let (start, goal) = (compared(2).start(), compared(2).end());
    RolloutRequest { settle_s: duration_s, ..RolloutRequest::new(start, goal, duration_s, duration_s / 500.0) }
}

fn bits(rollout: &Rollout) -> Vec<u64> {
    let tables = [rollout.positions().samples(), rollout.velocities(), rollout.accelerations()];
    tables.into_iter().flat_map(|table| table.iter().map(|value| value.to_bits())).collect()
}

#[test]
fn a_coupling_of_nothing_leaves_every_bit() {
    for form in [DmpForm::Residual, DmpForm::Eq1Literal, DmpForm::Scaled] {
        let dmp = Dmp::learn(&DmpConfig { form, ..DmpConfig::default() }, &[compared(2)]).unwrap();
        let (request, far) = (request(1.3), PointObstacle { center: vec![50.0, 50.0], radius: 1.0 });
        let field = PotentialConfig::Static(StaticPotential::default());
        let away = PotentialCoupling::new(field, vec![far], 2).unwrap();
        let free = bits(&dmp.rollout(&request).unwrap());
        assert_eq!(bits(&dmp.rollout_coupled(&request, &[]).unwrap()), free);
        assert_eq!(bits(&dmp.rollout_coupled(&request, &[&always(0.0), &always(-0.0), &away]).unwrap()), free);
    }
}

#[test]
fn couplings_add_up_and_are_held_over_their_step() {
    let (dmp, request) = (learned(), request(1.0));
    let coupled = dmp.rollout_coupled(&request, &[&always(3.0), &always(-1.0)]).unwrap();
    let mut stepper = dmp.stepper(&request).unwrap();
    for (row, step_s) in request.time_steps_s().enumerate() {
        stepper.step_with_coupling(step_s, &[2.0, 2.0]).unwrap();
        assert_eq!(stepper.position()[1], coupled.positions().samples()[(row + 1, 1)]);
    }
    // Δu moves the rest by Δu/αβ
    let moved = coupled.positions().end() - dmp.rollout(&request).unwrap().positions().end();
    moved.iter().for_each(|moved| approx::assert_relative_eq!(*moved, 2.0 / 156.25, max_relative = 1e-3));
}

#[test]
fn a_coupling_sees_the_state_at_the_beginning_of_the_step() {
    let dmp = learned();
    let (mut coupled, mut free) = (dmp.stepper(&request(1.0)).unwrap(), dmp.stepper(&request(1.0)).unwrap());
    let late = Constant { added: 1.0, from_s: 0.5 };
    while coupled.elapsed_s() < 0.5 {
        assert_eq!(coupled.position(), free.position());
        coupled.step_coupled(0.002, &[&late]).unwrap();
        free.step(0.002).unwrap();
    }
    coupled.step_coupled(0.002, &[&late]).unwrap();
    free.step(0.002).unwrap();
    assert!(coupled.position()[0] > free.position()[0]);
}

#[test]
fn what_is_not_finite_is_refused_by_index_and_leaves_the_motion_as_it_was() {
    let dmp = learned();
    let (mut stepper, mut twin) = (dmp.stepper(&request(1.0)).unwrap(), dmp.stepper(&request(1.0)).unwrap());
    stepper.step_with_coupling(0.1, &[1.0, 2.0]).unwrap();
    twin.step_with_coupling(0.1, &[1.0, 2.0]).unwrap();
    let refused = stepper.step_coupled(0.1, &[&always(1.0), &always(f64::NAN)]);
    assert!(matches!(refused, Err(SkillError::NonFiniteCoupling { coupling: 1, coordinate: 0, .. })));
    let solid = PotentialCoupling::new(PotentialConfig::default(), vec![], 3).unwrap();
    let refused = stepper.step_coupled(0.1, &[&solid]);
    assert!(matches!(refused, Err(SkillError::Dimension { found: 3, expected: 2, .. })));
    assert!(stepper.step_coupled(-0.1, &[]).is_err());
    for stepper in [&mut stepper, &mut twin] {
        assert_eq!(stepper.elapsed_s(), 0.1);
        stepper.change_goal(&[1.0, 1.0]).unwrap();
        stepper.step(0.01).unwrap();
    }
    assert_eq!((stepper.position(), stepper.acceleration()), (twin.position(), twin.acceleration()));
    assert!(dmp.rollout_coupled(&request(1.0), &[&always(f64::INFINITY)]).is_err());
}

// a straight motion from (0, 0) to (1, 0), and an obstacle a little beside its middle
fn past_an_obstacle(potential: PotentialConfig, duration_s: f64) -> (Rollout, DVector<f64>) {
    let center = dvector![0.5, 0.01];
    let obstacle = PointObstacle { center: center.as_slice().to_vec(), radius: 0.05 };
    let coupling = PotentialCoupling::new(potential, vec![obstacle], 2).unwrap();
    let request = RolloutRequest { goal: dvector![1.0, 0.0], start: DVector::zeros(2), ..request(duration_s) };
    let zero = skills::SavedDmp { weights: vec![vec![0.0; 2]; 10], ..learned().saved() }.restore().unwrap();
    (zero.rollout_coupled(&request, &[&coupling]).unwrap(), center)
}

#[test]
fn both_fields_raise_the_clearance_and_still_reach_the_goal() {
    let dynamic = PotentialConfig::Dynamic(DynamicPotential { strength: 0.2, ..DynamicPotential::default() });
    let fixed = StaticPotential { strength: 1e-3, reach: 0.2, closest: 0.01 };
    for potential in [dynamic, PotentialConfig::Static(fixed)] {
        let (found, center) = past_an_obstacle(potential, 1.0);
        let distance = |row: nalgebra::RowDVector<f64>| (row.transpose() - &center).norm() - 0.05;
        let clearance = found.positions().samples().row_iter().map(|row| distance(row.into_owned())).reduce(f64::min);
        // the straight line passes 0.04 inside the obstacle
        assert!(clearance.unwrap() > 0.0, "{clearance:?}");
        assert!((found.positions().end() - dvector![1.0, 0.0]).norm() < 0.01);
    }
}

#[test]
fn the_path_about_an_obstacle_does_not_depend_on_the_duration() {
    let of = |duration_s| past_an_obstacle(PotentialConfig::default(), duration_s).0;
    // a power of two scales time without rounding
    assert_eq!(of(1.0).positions().samples(), of(4.0).positions().samples());
}
