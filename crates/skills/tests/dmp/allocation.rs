//! What stepping, changing, coupling and absorbing allocate: nothing.

use nalgebra::DVector;
use skills::coupling::{
    CooperativeConfig, CooperativeCoupling, Coupling, DynamicPotential, PointObstacle, PotentialConfig,
    PotentialCoupling, StaticPotential,
};
use skills::regression::{Recursive, RecursiveFit};
use skills::{Dmp, DmpConfig, DmpForm, DmpPair, RolloutRequest};

use super::accuracy::compared;

const STEP_S: f64 = 0.001;
const STEPS: usize = 300;

fn learned(form: DmpForm) -> Dmp {
    Dmp::learn(&DmpConfig { form, ..DmpConfig::default() }, &[compared(7)]).unwrap()
}

fn request() -> RolloutRequest {
    RolloutRequest::new(compared(7).start(), compared(7).end(), 1.0, STEP_S)
}

fn potential(potential: PotentialConfig) -> PotentialCoupling {
    let obstacle = |x: f64| PointObstacle { center: vec![x; 7], radius: 0.01 };
    PotentialCoupling::new(potential, vec![obstacle(0.2), obstacle(0.4)], 7).unwrap()
}

fn assert_free(what: &str, run: impl FnOnce()) {
    let counted = allocation_counter::measure(run);
    assert_eq!(counted.count_total, 0, "{what}: {counted:?}");
}

#[test]
fn stepping_and_changing_allocate_nothing() {
    for form in [DmpForm::Residual, DmpForm::Eq1Literal, DmpForm::Scaled] {
        let mut stepper = learned(form).stepper(&request()).unwrap();
        let (held, goal) = ([0.1; 7], [0.4; 7]);
        assert_free("stepper", || {
            for k in 0..STEPS {
                stepper.step(STEP_S).unwrap();
                // another step, as by a jittering clock, has to be propagated anew
                stepper.step_with_coupling(1.3 * STEP_S, &held).unwrap();
                stepper.change_goal(&goal).unwrap();
                stepper.change_duration(1.0 + 0.001 * k as f64).unwrap();
            }
        });
    }
}

#[test]
fn every_coupling_allocates_nothing() {
    let moving = potential(PotentialConfig::Dynamic(DynamicPotential::default()));
    let fixed = potential(PotentialConfig::Static(StaticPotential { reach: 0.5, ..StaticPotential::default() }));
    let couplings: [&dyn Coupling; 2] = [&moving, &fixed];
    let mut stepper = learned(DmpForm::Residual).stepper(&request()).unwrap();
    assert_free("couplings", || (0..STEPS).for_each(|_| stepper.step_coupled(STEP_S, &couplings).unwrap()));
}

#[test]
fn a_pair_of_motions_allocates_nothing() {
    let coupling = CooperativeCoupling::new(CooperativeConfig::default(), vec![0.1; 7]).unwrap();
    let motion = || learned(DmpForm::Residual).stepper(&request()).unwrap();
    let mut pair = DmpPair::new(motion(), motion(), coupling).unwrap();
    assert_free("pair", || (0..STEPS).for_each(|_| pair.step(STEP_S).unwrap()));
}

#[test]
fn absorbing_a_sample_allocates_nothing() {
    let basis = learned(DmpForm::Residual).basis().clone();
    let mut fit = RecursiveFit::new(&Recursive { forgetting: 0.99 }, basis, 7).unwrap();
    let target = DVector::repeat(7, 0.3);
    assert_free("recursive fit", || {
        (1..=STEPS).for_each(|k| fit.absorb(k as f64 / STEPS as f64, target.as_slice(), 1.0).unwrap());
    });
}
