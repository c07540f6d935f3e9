//! Learns from several demonstrations with a kernelized primitive, asks where they agree, and passes two via points.
//!
//! Prints the standard deviation along the way, and by how much each via point and the goal are missed.
//! `cargo run --release -p skills --example via_points`

use std::error::Error;

use nalgebra::{DMatrix, DVector, dvector};
use skills::{Kernelized, KernelizedConfig, KernelizedMotion, RolloutRequest, Trajectory, ViaPoint};

/// One of several reaches: all pass the same door at half time, each bulges differently before it.
fn shown(bulge_m: f64) -> Result<Trajectory, Box<dyn Error>> {
    let samples = DMatrix::from_fn(201, 2, |row, k| {
        let r = row as f64 / 200.0;
        let window = if r < 0.5 { (16.0 * r * (0.5 - r)).powi(3) } else { 0.0 };
        if k == 0 { 0.5 * r * r * (3.0 - 2.0 * r) } else { 0.1 * (16.0 * (r * (1.0 - r)).powi(2)) + bulge_m * window }
    });
    Ok(Trajectory::uniform(0.01, samples)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let demonstrations = [-0.04, -0.01, 0.0, 0.02, 0.03].map(shown).into_iter().collect::<Result<Vec<_>, _>>()?;
    let skill = Kernelized::learn(&KernelizedConfig::default(), &demonstrations)?;
    let request = RolloutRequest::new(dvector![0.0, 0.0], dvector![0.5, 0.05], 2.0, 0.01);

    // where the demonstrations differ the primitive is less sure than where they agree
    let plain = skill.motion(&request)?;
    for progress in [0.25, 0.75] {
        let deviation = plain.standard_deviation(progress);
        println!(
            "at {progress:.2} T: y = {:.1} mm, uncertainty {:.1} mm",
            1e3 * at(&plain, progress)[1],
            1e3 * deviation[1]
        );
    }

    let through = |progress: f64, x: f64, y: f64| ViaPoint::exact(progress, dvector![x, y]);
    let via = [through(0.25, 0.10, 0.02), through(0.75, 0.40, 0.12)];
    let motion = skill.motion_through(&request, &via)?;
    for point in &via {
        let missed = at(&motion, point.progress).metric_distance(&point.position);
        println!("via point at {:.2} T missed by {:.4} mm", point.progress, 1e3 * missed);
    }
    let end = motion.rollout()?.positions().end();
    println!("goal missed by {:.4} mm", 1e3 * end.metric_distance(&request.goal));
    Ok(())
}

/// Position at t/T = `progress`. In a control loop the three vectors are kept, so that nothing is allocated.
fn at(motion: &KernelizedMotion<'_>, progress: f64) -> DVector<f64> {
    let [mut position, mut velocity, mut acceleration] = [(); 3].map(|()| DVector::zeros(2));
    motion.evaluate_into(progress, &mut position, &mut velocity, &mut acceleration);
    position
}
