//! Follows a Cartesian path with the hand of a Panda at 1 kHz: joint positions, velocities and accelerations that belong
//! together, and the torques for them.
//!
//! Prints the largest joint speeds and torques as shares of their limits, and how exactly the path is met.
//! `cargo run --release -p robot --example follow_path`

use std::error::Error;

use nalgebra::{DVector, Isometry3, Translation3, UnitQuaternion, Vector6};
use robot::{
    DifferentialKinematics, FrameMotion, InverseKinematics, InverseKinematicsOptions, JointReference, Manipulator,
    Redundancy, TaskRows,
};

const TICK_S: f64 = 0.001;
const DURATION_S: f64 = 4.0;

/// A circle of 10 cm in the vertical plane, hand down: its pose, velocity and acceleration in base axes.
fn circle(time_s: f64) -> FrameMotion {
    // minimum jerk, so that the motion begins and ends at rest
    let r = time_s / DURATION_S;
    let turn = std::f64::consts::TAU;
    let angle = turn * r * r * r * (10.0 + r * (6.0 * r - 15.0));
    let rate = turn * 30.0 * r * r * (1.0 - r) * (1.0 - r) / DURATION_S;
    let change = turn * 60.0 * r * (1.0 - r) * (1.0 - 2.0 * r) / (DURATION_S * DURATION_S);
    let (sine, cosine) = angle.sin_cos();
    let down = UnitQuaternion::from_euler_angles(std::f64::consts::PI, 0.0, 0.0);
    let along = |y: f64, z: f64| Vector6::new(0.0, 0.1 * y, 0.1 * z, 0.0, 0.0, 0.0);
    FrameMotion {
        base_from_frame: Isometry3::from_parts(Translation3::new(0.5, 0.1 * sine, 0.5 - 0.1 * cosine), down),
        velocity: along(cosine, sine) * rate,
        acceleration: along(cosine, sine) * change + along(-sine, cosine) * rate * rate,
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arm = Manipulator::from_urdf_str(include_str!("../../../assets/robots/panda.urdf"))?;
    let tip = arm.frame("panda_hand_tcp")?;
    let options = InverseKinematicsOptions::default();
    let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Pose, options)?;
    let start = solver.solve(&circle(0.0).base_from_frame, &arm.middle_posture())?.q;

    // the seventh joint is free: it stays near the posture at the start and away from limits
    let policy = Redundancy::toward(start.clone(), TICK_S);
    let mut follower = DifferentialKinematics::with_redundancy(&arm, tip, TaskRows::Pose, policy)?;
    let mut reference = JointReference::at_rest(start);
    let mut workspace = arm.workspace();
    let mut torques = DVector::zeros(arm.joint_count());
    let (mut speed, mut torque, mut error_m) = (0.0_f64, 0.0_f64, 0.0_f64);
    for tick in 0..=(DURATION_S / TICK_S).round() as u32 {
        // nothing in here allocates
        let wanted = circle(TICK_S * f64::from(tick));
        follower.follow(&wanted, &mut reference)?;
        workspace.set_state(&reference.q, &reference.dq)?;
        workspace.inverse_dynamics_into(&reference.ddq, &mut torques)?;
        for (joint, limits) in arm.joints().iter().map(|joint| &joint.limits).enumerate() {
            speed = speed.max(reference.dq[joint].abs() / limits.velocity.unwrap_or(f64::INFINITY));
            torque = torque.max(torques[joint].abs() / limits.effort.unwrap_or(f64::INFINITY));
        }
        let found = workspace.base_from_frame(tip);
        error_m = error_m.max((found.translation.vector - wanted.base_from_frame.translation.vector).norm());
    }
    println!("largest joint speed {:.0} % of its limit, largest torque {:.0} %", 1e2 * speed, 1e2 * torque);
    println!("path met to {:.0e} m", error_m);
    println!("joint speed at the end {:.1e} rad/s", reference.dq.amax());
    Ok(())
}
