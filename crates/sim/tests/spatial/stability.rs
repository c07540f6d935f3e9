//! The bound of the sampled loop, calculated and met in the engine.

use robot::JointReference;
use sim::controllers::{Controller, Impedance, ImpedanceConfig};
use sim::spatial::ArmConfig;

use super::fixture::{Scene, engine, free, panda, ready, rod};

/// Largest joint error, rad, within a second after a nudge of 1 mrad, of a bare arm whose motors give any torque.
fn after_a_nudge(damping: f64) -> (f64, bool) {
    let model = panda(&[]);
    let ideal = ArmConfig { ideal_motors: true, ..ArmConfig::default() };
    let gains = ImpedanceConfig { damping_nm_s_per_rad: vec![damping], ..ImpedanceConfig::paper() };
    let mut controller = Impedance::new(&gains, 7).expect("valid gains");
    let mut scene = Scene::new(&model, &rod(), &ideal, &engine(1e-3, 2), &ready());
    let nudged = |_| {
        let mut wanted = JointReference::at_rest(ready());
        wanted.q[6] += 1e-3;
        wanted
    };
    let stable = controller.check_stability(&mut model.workspace(), &ready(), 1e-3).is_ok();
    (scene.run(&model, &mut controller, &nudged, 1.0, &free), stable)
}

#[test]
fn gains_beyond_the_calculated_bound_diverge_in_the_engine_and_those_below_do_not() {
    // the lightest direction of the bare wrist with the rod decides
    let model = panda(&[]);
    let mut mass = nalgebra::DMatrix::zeros(7, 7);
    let mut workspace = model.workspace();
    workspace.set_positions(&ready()).expect("seven joints");
    workspace.mass_matrix_into(&mut mass);
    let lightest = nalgebra::SymmetricEigen::new(mass).eigenvalues.min();
    let bound = lightest * (2.0 / 1e-3 - 3.0);
    for (share, stable) in [(0.9, true), (0.98, true), (1.02, false), (1.1, false)] {
        let (largest, called_stable) = after_a_nudge(share * bound);
        println!("xi {:.2}: error {largest:e}, called stable: {called_stable}", share * bound);
        assert_eq!(called_stable, stable, "xi {}", share * bound);
        assert_eq!(largest < 0.01, stable, "xi {}: {largest}", share * bound);
    }
}
