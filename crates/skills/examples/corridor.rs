//! Keeps a generalized motion inside a corridor that narrows on the way, and prints the certificate of it.
//!
//! Prints for the plain motion and for the filtered one whether they stay inside at all times (also between samples), by
//! how much, and what it costs in acceleration. Then the motion is slowed until it keeps limits of speed and acceleration.
//! `cargo run --release -p skills --example corridor`

use std::error::Error;

use nalgebra::{DMatrix, dvector};
use skills::corridor::smoothing::{SmoothingConfig, smooth};
use skills::corridor_filter::{Certificate, CorridorFilterConfig, FilterRequest, certify, constrain};
use skills::{Dmp, DmpConfig, MotionLimits, MovementPrimitive, RolloutRequest, Trajectory};

/// A reach of 0.4 m that swings out by 6 cm to the side.
fn shown() -> Result<Trajectory, Box<dyn Error>> {
    let samples = DMatrix::from_fn(201, 2, |row, k| {
        let r = row as f64 / 200.0;
        if k == 0 { 0.4 * r * r * (3.0 - 2.0 * r) } else { 0.06 * 16.0 * (r * (1.0 - r)).powi(2) }
    });
    Ok(Trajectory::uniform(0.005, samples)?)
}

fn tell(name: &str, certificate: &Certificate) {
    println!(
        "{name}: {}, smallest margin {:.2} mm, peak acceleration {:.1} m/s2, goal missed by {:.3} mm",
        if certificate.holds() { "certified inside" } else { "NOT inside" },
        1e3 * certificate.smallest_margin(),
        certificate.peak_acceleration(),
        1e3 * certificate.goal_error(),
    );
}

fn main() -> Result<(), Box<dyn Error>> {
    let skill = Dmp::learn(&DmpConfig::default(), &[shown()?])?;
    let request = RolloutRequest::new(dvector![0.0, 0.0], dvector![0.4, 0.0], 1.0, 0.005);
    let motion = skill.rollout(&request)?;

    // x is free; |y| < 8 cm, but 4 cm from 0.45 s to 0.7 s: given as samples with jumps, smoothed inside them
    let times_s: Vec<f64> = (0..=200).map(|row| 0.005 * f64::from(row)).collect();
    let upper = DMatrix::from_fn(201, 2, |row, k| match (k, times_s[row]) {
        (0, _) => 1.0,
        (_, time_s) if (0.45..=0.7).contains(&time_s) => 0.04,
        _ => 0.08,
    });
    let corridor = smooth(&SmoothingConfig::default(), &times_s, &-&upper, &upper)?.corridor;

    tell("plain motion", &certify(&motion, &corridor, &request.goal)?);
    let kept = constrain(&CorridorFilterConfig::default(), &motion, &corridor, &FilterRequest::of(&request))?;
    tell("filtered motion", &kept.certificate);
    for (axis, name) in kept.certificate.axes.iter().zip(["x", "y"]) {
        let (lower, upper) = (axis.lower, axis.upper);
        println!(
            "  {name}: {:.2} mm above the lower bound (at {:.3} s), {:.2} mm below the upper one (at {:.3} s)",
            1e3 * lower.at_all_times,
            lower.at_all_times_time_s,
            1e3 * upper.at_all_times,
            upper.at_all_times_time_s,
        );
    }

    let limits = MotionLimits { velocity: dvector![0.5, 0.5], acceleration: dvector![2.0, 2.0] };
    let factor = kept.rollout.least_stretch(&limits)?;
    let slow = kept.rollout.stretched(factor.max(1.0))?;
    let (speed, acceleration) = (slow.velocities().amax(), slow.accelerations().amax());
    println!("slowed {factor:.2} times: at most {speed:.3} m/s and {acceleration:.3} m/s2 on the same path");
    Ok(())
}
