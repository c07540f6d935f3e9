//! Finds joint positions within the limits for poses of the hand: near ones, far ones, one with a preferred posture, and one
//! that cannot be reached.
//!
//! Prints each posture with what is left to its pose, and why the last one is refused.
//! `cargo run --release -p robot --example inverse_kinematics`

use std::error::Error;

use nalgebra::{DVector, Isometry3, Translation3, UnitQuaternion};
use robot::{InverseKinematics, InverseKinematicsOptions, Manipulator, RobotError, TaskRows};

fn main() -> Result<(), Box<dyn Error>> {
    let arm = Manipulator::from_urdf_str(include_str!("../../../assets/robots/panda.urdf"))?;
    let tip = arm.frame("panda_hand_tcp")?;
    let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Pose, InverseKinematicsOptions::default())?;

    // the hand points down
    let down = UnitQuaternion::from_euler_angles(std::f64::consts::PI, 0.0, 0.0);
    let at = |x: f64, y: f64, z: f64| Isometry3::from_parts(Translation3::new(x, y, z), down);

    // each answer is the start of the next: quick, and on the same branch
    let mut q = arm.middle_posture();
    for target in [at(0.5, 0.0, 0.3), at(0.52, 0.02, 0.3), at(0.3, -0.5, 0.1)] {
        let report = solver.solve_in_place(&target, &mut q)?;
        let values: Vec<String> = q.iter().map(|q| format!("{q:.3}")).collect();
        let error_m = report.error.position_error_m;
        println!("({}) rad in {} steps, off by {error_m:.0e} m", values.join(", "), report.iterations);
    }
    let inside = arm.joints().iter().zip(q.iter()).all(|(joint, q)| joint.limits.clamp(*q) == *q);
    println!("within the limits: {inside}");

    // from far away another branch is found
    let far = DVector::from_fn(7, |joint, _| if joint % 2 == 0 { 2.0 } else { q[joint] });
    let branch = solver.solve(&at(0.3, -0.5, 0.1), &far)?.q;

    // seven joints for six coordinates: of all postures for the last pose the one nearest to the middle of the limits
    let preferred_posture = Some(arm.middle_posture());
    let options = InverseKinematicsOptions { preferred_posture, ..InverseKinematicsOptions::default() };
    let mut drawn = InverseKinematics::new(&arm, tip, TaskRows::Pose, options)?;
    let nearest = drawn.solve(&at(0.3, -0.5, 0.1), &far)?.q;
    let distance = |q: &DVector<f64>| (q - arm.middle_posture()).norm();
    println!("from the middle of the limits: {:.2} rad, drawn there {:.2} rad", distance(&branch), distance(&nearest));

    // the answer to what cannot be done says why, and what comes closest
    match solver.solve(&at(1.1, 0.0, 0.5), &q) {
        Err(RobotError::Unreachable { position_error_m, reason, .. }) => {
            println!("refused, {:.0} mm away: {reason}", 1e3 * position_error_m);
        }
        other => println!("unexpected: {other:?}"),
    }
    Ok(())
}
