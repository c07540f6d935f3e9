//! The approach: an object-operating skill of place, height and tilt in the corridor from the cup's stand to the mouth.

use nalgebra::{DMatrix, DVector, Isometry3, Translation3, UnitQuaternion, Vector3};

use super::demonstration::Row;
use super::refusal::PourError;
use super::task::PourOptions;
use crate::corridor::{Bounds, Corridor};
use crate::corridor_filter::{FilterRequest, constrain};
use crate::primitive::RolloutRequest;
use crate::separation::constraint_based::{ConstrainedDemonstration, ConstraintBased, ConstraintBasedConfig};
use crate::spatial::{SpatialKnot, SpatialMotion, SpatialTrack, resting};
use crate::time_law::PathState;
use crate::trajectory::Trajectory;

/// Coordinates of an approach: place along, across and above its way, and tilt.
pub(super) const COORDINATES: usize = 4;
/// Time between the knots, s.
const STEP_S: f64 = 0.01;
/// Shortest approach, m.
const LEAST_WAY_M: f64 = 0.04;
/// How far the cup may sink below the lower of both ends, m, and rise above the higher one.
const SINK_M: f64 = 0.002;
const RISE_M: f64 = 0.15;
/// Noise of place, m, and tilt, rad, of what was shown, and the tilt that it may show.
const NOISE_M: f64 = 0.002;
const NOISE_RAD: f64 = 0.03;
const SHOWN_TILT_RAD: f64 = 0.4;
/// Share of the greatest speed below which the hand rests.
const RESTING: f64 = 0.08;
/// Tilt left beside the mouth, rad, and the part of the approach after which it is.
const LEVEL_RAD: f64 = 0.04;
const LEVEL_AFTER: f64 = 0.6;

/// Separates the approach from the corridor it was shown in; lengths over the level way, m, from start to end.
pub(super) fn learn(config: &ConstraintBasedConfig, rows: &[Row]) -> Result<(ConstraintBased, f64), PourError> {
    let rows = moving(rows);
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return Err(PourError::TooNear { distance_m: 0.0, least_m: LEAST_WAY_M });
    };
    let (turn, way_m) = level_way(&first.place_m, &last.place_m)?;
    let samples = DMatrix::from_fn(rows.len(), COORDINATES, |row, k| {
        let row = rows.get(row).unwrap_or(last);
        let place = turn.inverse() * (row.place_m - first.place_m);
        if k < 3 { place[k] / way_m } else { row.tilt_rad }
    });
    let times_s = rows.iter().map(|row| row.time_s - first.time_s).collect();
    let trajectory = Trajectory::new(times_s, samples)?;
    let height = (last.place_m.z - first.place_m.z) / way_m;
    // the cup stood on the table: as near to the bound as a planned one, so that the map is undone alike
    let lowest = trajectory.samples().column(2).min().min(0.0);
    let bounds = [
        [-0.3, 1.3],
        [-0.6, 0.6],
        [lowest - SINK_M / way_m, height.max(0.0) + RISE_M / way_m],
        [-SHOWN_TILT_RAD, SHOWN_TILT_RAD],
    ];
    let corridor = still(&bounds, trajectory.duration_s())?;
    let noise = [NOISE_M / way_m, NOISE_M / way_m, NOISE_M / way_m, NOISE_RAD];
    let shown = ConstrainedDemonstration { trajectory: &trajectory, corridor: &corridor, noise: &noise };
    Ok((ConstraintBased::learn(config, &[shown])?, trajectory.duration_s()))
}

/// The rows between the rests at both ends, which are no part of the way: about the fastest row, those that are not slow.
fn moving(rows: &[Row]) -> &[Row] {
    let speed = |row: usize| {
        let (from, to) = (row.saturating_sub(2), (row + 2).min(rows.len().saturating_sub(1)));
        rows.get(from)
            .zip(rows.get(to))
            .filter(|(a, b)| b.time_s > a.time_s)
            .map_or(0.0, |(a, b)| (b.place_m - a.place_m).norm() / (b.time_s - a.time_s))
    };
    let Some(fastest) = (0..rows.len()).max_by(|a, b| speed(*a).total_cmp(&speed(*b))) else { return rows };
    let slow = |row: &usize| speed(*row) < RESTING * speed(fastest);
    let begin = (0..fastest).rev().find(slow).unwrap_or(0);
    let end = (fastest..rows.len()).find(slow).unwrap_or(rows.len() - 1);
    rows.get(begin..=end).unwrap_or(rows)
}

/// Plans the approach from `start` to `goal`, `world_from_cup` both upright: inside its corridor, certified, at rest at
/// both ends; the cup turns about its axis by minimum jerk.
pub(super) fn plan(
    skill: &ConstraintBased,
    start: &Isometry3<f64>,
    goal: &Isometry3<f64>,
    options: &PourOptions,
) -> Result<SpatialTrack, PourError> {
    let (from, to) = (start.translation.vector, goal.translation.vector);
    let (turn, way_m) = level_way(&from, &to)?;
    let height = (to.z - from.z) / way_m;
    let beyond = 0.5 * (options.beside_m - options.margin_m) / way_m;
    let bounds = [
        [-0.1, 1.0 + beyond.max(1e-3)],
        [-0.25, 0.25],
        [height.min(0.0) - SINK_M / way_m, height.max(0.0) + RISE_M / way_m],
        [-options.level_rad, options.level_rad],
    ];
    let duration_s = ((to - from).norm() / options.approach_speed_m_per_s).max(0.5);
    let corridor = leveling(&bounds, duration_s)?;
    let ends = [DVector::zeros(4), DVector::from_vec(vec![1.0, 0.0, height, 0.0])];
    let [begin, end] = ends;
    let request = RolloutRequest::new(begin, end, duration_s, STEP_S);
    let wanted = resting(&skill.generate(&request, &corridor)?.positions, &request)?;
    let kept = constrain(&options.corridor_filter, &wanted, &corridor, &FilterRequest::of(&request))?;
    if !kept.certificate.holds() {
        return Err(PourError::NotInside { motion: "approach", margin: kept.certificate.smallest_margin() });
    }
    let yaw = |pose: &Isometry3<f64>| {
        let x = pose.rotation * Vector3::x();
        x.y.atan2(x.x)
    };
    let (yaw_from, yaw_to) = (yaw(start), yaw(goal));
    let yaw_way = (yaw_to - yaw_from + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
    let turning = super::tilting::transfer(yaw_from, yaw_from + yaw_way, duration_s);
    let knots = kept.rollout.positions().times_s().iter().enumerate().map(|(row, time_s)| {
        let read = |table: &DMatrix<f64>, k: usize| table[(row, k)];
        let tables = [kept.rollout.positions().samples(), kept.rollout.velocities(), kept.rollout.accelerations()];
        let [place, linear, change] =
            tables.map(|table| turn * (Vector3::new(read(table, 0), read(table, 1), read(table, 2)) * way_m));
        let [tilt, rate, second] = tables.map(|table| read(table, 3));
        let tilt = PathState { position: tilt, first: rate, second };
        let (rotation, angular, angular_change) = turned(turning(*time_s), tilt);
        let pose = Isometry3::from_parts(Translation3::from(from + place), rotation);
        SpatialKnot { time_s: *time_s, motion: SpatialMotion::new(pose, [linear, angular], [change, angular_change]) }
    });
    Ok(SpatialTrack::new(knots.collect())?)
}

/// Orientation of a cup that is turned about the vertical, then tilted about its own y axis, with its angular motion.
fn turned(yaw: PathState, tilt: PathState) -> (UnitQuaternion<f64>, Vector3<f64>, Vector3<f64>) {
    let about_z = UnitQuaternion::from_scaled_axis(Vector3::z() * yaw.position);
    let axis = about_z * Vector3::y();
    let spin = Vector3::z() * yaw.first;
    let angular = spin + axis * tilt.first;
    let change = Vector3::z() * yaw.second + axis * tilt.second + spin.cross(&(axis * tilt.first));
    (about_z * UnitQuaternion::from_scaled_axis(Vector3::y() * tilt.position), angular, change)
}

/// Turn about z that leads x along the level way, and the length of the way, m.
fn level_way(from: &Vector3<f64>, to: &Vector3<f64>) -> Result<(UnitQuaternion<f64>, f64), PourError> {
    let way = to - from;
    let way_m = way.x.hypot(way.y);
    if way_m < LEAST_WAY_M {
        return Err(PourError::TooNear { distance_m: way_m, least_m: LEAST_WAY_M });
    }
    Ok((UnitQuaternion::from_scaled_axis(Vector3::z() * way.y.atan2(way.x)), way_m))
}

/// The corridor of a plan: the cup comes to be level before it is beside the mouth, where a tilt moves its lip.
fn leveling(bounds: &[[f64; 2]; 4], duration_s: f64) -> Result<Corridor, PourError> {
    let times_s = (0..=20).map(|row| duration_s * f64::from(row) / 20.0).collect();
    let tilt_rad = bounds[3][1];
    let level = super::tilting::transfer(tilt_rad, LEVEL_RAD.min(tilt_rad), LEVEL_AFTER * duration_s);
    Ok(Corridor::sampled(times_s, 4, |time_s, k| match bounds.get(k) {
        Some([lower, upper]) if k < 3 => Bounds::still(*lower, *upper),
        _ => {
            let high = level(time_s);
            let low = PathState { position: -high.position, first: -high.first, second: -high.second };
            Bounds { lower: low, upper: high }
        }
    })?)
}

fn still(bounds: &[[f64; 2]; 4], duration_s: f64) -> Result<Corridor, PourError> {
    Ok(Corridor::sampled(vec![0.0, duration_s], 4, |_, k| {
        let [lower, upper] = bounds.get(k).copied().unwrap_or_default();
        Bounds::still(lower, upper)
    })?)
}
