//! Loads an arm from a URDF file and evaluates its dynamics at a posture: M, C, g, the Jacobian, inverse and forward dynamics.
//!
//! Prints them for a Franka Panda, and that M q̈ + C q̇ + g equals inverse dynamics, which forward dynamics inverts.
//! `cargo run --release -p robot --example dynamics` (another arm: `… --example dynamics -- FILE.urdf FRAME`)

use std::error::Error;
use std::fs;

use nalgebra::{DMatrix, DVector, Matrix6xX};
use robot::Manipulator;

const PANDA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/robots/panda.urdf");

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().unwrap_or_else(|| PANDA.to_owned());
    let arm = Manipulator::from_urdf_str(&fs::read_to_string(path)?)?;
    for warning in arm.warnings() {
        println!("note: {warning}");
    }
    let tip = arm.frame(&arguments.next().unwrap_or_else(|| "panda_hand_tcp".to_owned()))?;
    let n = arm.joint_count();
    println!("{}: {n} joints", arm.name());

    // all memory is taken here: the calls below allocate nothing, so they may stand in a control loop
    let mut workspace = arm.workspace();
    let (mut mass, mut coriolis, mut jacobian) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n), Matrix6xX::zeros(n));
    let [mut gravity, mut torques, mut found] = [(); 3].map(|()| DVector::zeros(n));

    let q = arm.middle_posture();
    let dq = DVector::from_fn(n, |joint, _| 0.1 * (joint + 1) as f64);
    workspace.set_state(&q, &dq)?;
    workspace.mass_matrix_into(&mut mass);
    workspace.coriolis_matrix_into(&mut coriolis);
    workspace.gravity_into(&mut gravity);
    workspace.jacobian_into(tip, &mut jacobian);
    println!("q (rad){:.3}", q.transpose());
    println!("M (kg m2){mass:.3}");
    println!("C (N m s){coriolis:.3}");
    println!("g (N m){:.3}", gravity.transpose());
    println!("J, linear rows first{jacobian:.3}");
    println!("frame at{:.3}", workspace.base_from_frame(tip).translation.vector.transpose());

    // the torques of a wanted acceleration, and back
    let ddq = DVector::from_fn(n, |joint, _| 1.0 - 0.3 * joint as f64);
    workspace.inverse_dynamics_into(&ddq, &mut torques)?;
    let sum = &mass * &ddq + &coriolis * &dq + &gravity;
    println!("M ddq + C dq + g is inverse dynamics to {:.0e} N m", (&sum - &torques).amax());
    arm.check_dynamics()?;
    workspace.forward_dynamics_into(&torques, &mut found)?;
    println!("forward dynamics inverts it to {:.0e} rad/s2", (&found - &ddq).amax());
    let twist = workspace.frame_velocity(tip);
    println!("J dq is the velocity of the frame to {:.0e} m/s", (&jacobian * &dq - twist).amax());
    Ok(())
}
