//! Learns position and orientation together from recorded poses (quaternions), keeps the way round that was shown, and
//! leads the motion to another pose while it runs.
//!
//! Prints how far the hand turned, and what is left to each goal.
//! `cargo run --release -p skills --example pose`

use std::error::Error;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use skills::{DmpConfig, PoseDmp, PoseRequest, PoseTrajectory};

/// A screwdriver that is pushed forward by 3 cm while it turns by 270 degrees: farther than the short way round.
fn shown() -> Result<PoseTrajectory, Box<dyn Error>> {
    let times_s: Vec<f64> = (0..=200).map(|row| 0.01 * f64::from(row)).collect();
    let pose = |time_s: &f64| {
        let r = time_s / 2.0;
        let along = r * r * r * (10.0 + r * (6.0 * r - 15.0));
        let turn = UnitQuaternion::from_scaled_axis(Vector3::z() * (1.5 * std::f64::consts::PI * along));
        Isometry3::from_parts(Translation3::new(0.5, 0.0, 0.2 - 0.03 * along), turn)
    };
    let poses = times_s.iter().map(pose).collect();
    Ok(PoseTrajectory::new(times_s, poses)?)
}

/// What is left from one pose to another, in mm and degrees.
fn left(pose: &Isometry3<f64>, goal: &Isometry3<f64>) -> String {
    let distance_m = (pose.translation.vector - goal.translation.vector).norm();
    let angle_rad = pose.rotation.angle_to(&goal.rotation);
    format!("{:.2} mm and {:.2} degrees", 1e3 * distance_m, angle_rad.to_degrees())
}

fn main() -> Result<(), Box<dyn Error>> {
    let shown = shown()?;
    let skill = PoseDmp::learn(&DmpConfig::default(), std::slice::from_ref(&shown))?;

    // elsewhere, and 20 degrees farther
    let start = Isometry3::from_parts(Translation3::new(0.4, 0.1, 0.3), UnitQuaternion::identity());
    let turn = UnitQuaternion::from_scaled_axis(Vector3::z() * 290_f64.to_radians());
    let goal = Isometry3::from_parts(Translation3::new(0.4, 0.1, 0.26), turn);
    let request = PoseRequest { settle_s: 0.5, ..PoseRequest::new(start, goal, 2.0, 0.001) };
    let rollout = skill.rollout(&request)?;
    let poses = rollout.motions.iter().map(|motion| motion.pose).collect();
    let turned_rad = PoseTrajectory::new(rollout.times_s.clone(), poses)?.turn_rad();
    println!("turned by {:.1} degrees", turned_rad.z.to_degrees());
    if let Some(last) = rollout.motions.last() {
        println!("left to the goal: {}", left(&last.pose, &goal));
    }

    // step by step, as in a control loop; the screw turns out to stand askew, and there is more time
    let mut motion = skill.stepper(&request)?;
    let tilt = UnitQuaternion::from_scaled_axis(Vector3::x() * 10_f64.to_radians());
    let askew = Isometry3::from_parts(Translation3::new(0.41, 0.1, 0.26), tilt * turn);
    for tick in 0..3500 {
        if tick == 800 {
            motion.change_goal(&askew)?;
            motion.change_duration(3.0)?;
        }
        motion.step(0.001)?;
    }
    let state = motion.motion();
    println!("left to the goal that moved: {}", left(&state.pose, motion.goal()));
    println!("angular speed at the end: {:.4} rad/s", state.angular_velocity_rad_per_s.norm());
    Ok(())
}
