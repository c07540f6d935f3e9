//! How an arm followed its plan: measures out of the episode alone.

use nalgebra::Point3;
use robot::Manipulator;
use sim::spatial::Episode;

use crate::measures::rms_and_max;
use crate::outcome::Measure;

const MM: f64 = 1e3;
const MRAD: f64 = 1e3;
const PERCENT: f64 = 100.0;

/// Measures of the arm that every task in space reports.
pub(crate) fn arm_measures(episode: &Episode, model: &Manipulator) -> Vec<Measure> {
    let samples = &episode.samples;
    let (rms_m, max_m) = rms_and_max(samples.iter().map(|sample| sample.tool_error_m()));
    let (_, max_rad) = rms_and_max(samples.iter().map(|sample| sample.tool_angle_error_rad()));
    let largest = |value: fn(&sim::spatial::EpisodeSample) -> f64| samples.iter().map(value).fold(0.0, f64::max);
    let force_n = largest(|sample| sample.tool_wrench.fixed_rows::<3>(0).norm());
    let energy_j: f64 = samples.iter().map(|sample| sample.power_w * episode.control_period_s).sum();
    let has_limits = model.joints().iter().any(|joint| joint.limits.effort.is_some());
    let share = has_limits.then(|| PERCENT * largest(|sample| sample.torque_share));
    vec![
        Measure::reported("tool_error_rms_mm", "tool to its reference, RMS", rms_m * MM, "mm"),
        Measure::reported("tool_error_max_mm", "tool to its reference, largest", max_m * MM, "mm"),
        Measure::reported(
            "tool_angle_error_max_mrad",
            "turn of the tool to its reference, largest",
            max_rad * MRAD,
            "mrad",
        ),
        Measure::reported(
            "joint_error_max_mrad",
            "joint to its reference, largest",
            largest(|sample| sample.joint_error_rad) * MRAD,
            "mrad",
        ),
        Measure::reported("tool_force_max_n", "force on the tool as the arm's motion tells, largest", force_n, "N"),
        Measure::reported("torque_share_max_percent", "torque as a share of its joint's limit, largest", share, "%"),
        Measure::reported("motor_energy_j", "work of the motors, both signs", energy_j, "J"),
        Measure::reported("path_length_mm", "way of the tool", tool_path_length_m(episode) * MM, "mm"),
        Measure::reported("duration_s", "simulated time", episode.duration_s(), "s"),
    ]
}

/// Length of the tool's way, m.
fn tool_path_length_m(episode: &Episode) -> f64 {
    let places = episode.samples.iter().map(|sample| Point3::from(sample.world_from_tool.translation.vector));
    places.clone().zip(places.skip(1)).map(|(a, b)| (b - a).norm()).sum()
}
