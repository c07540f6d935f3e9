//! Steps a primitive in a control loop whose goal moves and whose time is cut short on the way.
//!
//! Prints the motion at each tenth of a second, the largest jump of position and velocity from tick to tick, and where it
//! ends. Stepping and both changes allocate nothing.
//! `cargo run --release -p skills --example change_goal`

use std::error::Error;

use nalgebra::{DMatrix, dvector};
use skills::time_law::minimum_jerk;
use skills::{Dmp, DmpConfig, RolloutRequest, Trajectory};

/// Control period, s.
const TICK_S: f64 = 0.001;

/// One second of a hand that goes 0.3 m forward and lifts by 0.1 m on its way.
fn shown() -> Result<Trajectory, Box<dyn Error>> {
    let samples = DMatrix::from_fn(201, 2, |row, k| {
        let r = row as f64 / 200.0;
        if k == 0 { 0.3 * minimum_jerk(r) } else { 6.4 * (r * (1.0 - r)).powi(3) }
    });
    Ok(Trajectory::uniform(0.005, samples)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let skill = Dmp::learn(&DmpConfig::default(), &[shown()?])?;
    let mut motion = skill.stepper(&RolloutRequest::new(dvector![0.0, 0.0], dvector![0.3, 0.0], 1.0, TICK_S))?;
    let (mut position, mut velocity) = (motion.position().clone(), motion.velocity().clone());
    let (mut step_of_position, mut step_of_velocity) = (0.0_f64, 0.0_f64);

    // a while longer than the motion, so that it settles
    for tick in 0..1200 {
        match tick {
            // the camera sees the goal elsewhere
            400 => motion.change_goal(&[0.35, 0.08])?,
            // and somebody waits for it
            600 => motion.change_duration(0.8)?,
            _ => {}
        }
        motion.step(TICK_S)?;
        step_of_position = step_of_position.max(motion.position().metric_distance(&position));
        step_of_velocity = step_of_velocity.max(motion.velocity().metric_distance(&velocity));
        position.copy_from(motion.position());
        velocity.copy_from(motion.velocity());
        if tick % 100 == 99 {
            let time_s = motion.elapsed_s();
            println!("{time_s:.1} s: ({:6.3}, {:6.3}) m at {:.3} m/s", position[0], position[1], velocity.norm());
        }
    }
    println!("largest step in 1 ms: {:.2} mm, {:.1} mm/s", 1e3 * step_of_position, 1e3 * step_of_velocity);
    println!("goal missed by {:.3} mm", 1e3 * position.metric_distance(motion.goal()));
    Ok(())
}
