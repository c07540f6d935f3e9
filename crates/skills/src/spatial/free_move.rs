//! Free moves: minimum jerk from place to place through via points, with rounded corners.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::motion::SpatialMotion;
use super::refusal::SpatialError;
use super::track::{SpatialKnot, SpatialTrack};
use crate::field::{FieldError, positive, within};
use crate::time_law::{minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative};

/// Peak over mean speed of minimum jerk.
const PEAK: f64 = 1.875;

/// Options of a free move.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FreeMoveConfig {
    /// Peak speed of a leg, m/s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub speed_m_per_s: f64,
    /// Peak angular speed of a leg, rad/s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub angular_speed_rad_per_s: f64,
    /// Shortest leg, s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub least_duration_s: f64,
    /// Part of the shorter of two legs by which the next begins before the one before has ended, 0 to 0.5: the larger, the
    /// rounder the corner at a via point.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub overlap: f64,
}

impl Default for FreeMoveConfig {
    fn default() -> Self {
        Self { speed_m_per_s: 0.2, angular_speed_rad_per_s: 1.2, least_duration_s: 0.4, overlap: 0.4 }
    }
}

impl FreeMoveConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("speed_m_per_s", self.speed_m_per_s)?;
        positive("angular_speed_rad_per_s", self.angular_speed_rad_per_s)?;
        positive("least_duration_s", self.least_duration_s)?;
        within("overlap", self.overlap, 0.0, 0.5)
    }

    fn duration_s(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> f64 {
        let way = (to.translation.vector - from.translation.vector).norm();
        let turn = (to.rotation * from.rotation.inverse()).angle();
        let duration_s = (PEAK * way / self.speed_m_per_s).max(PEAK * turn / self.angular_speed_rad_per_s);
        duration_s.max(self.least_duration_s)
    }
}

/// One leg: minimum jerk from a begin over a duration.
struct Leg {
    begin_s: f64,
    duration_s: f64,
    way: Vector3<f64>,
    turn: Vector3<f64>,
}

/// Moves from rest at the first pose to rest at the last, `world_from_tool`, by or past those between.
///
/// x(t) = x0 + Σ Δx_i·mj((t − t_i)/T_i): each place is a mean of the poses with weights from 0 to 1, so that the way stays
/// within the triangle of three consecutive places; the legs overlap in time two at a time. It is C² throughout.
///
/// # Errors
/// If an option is invalid, or there are fewer than two poses or one that is not finite.
pub fn free_move(config: &FreeMoveConfig, poses: &[Isometry3<f64>]) -> Result<SpatialTrack, SpatialError> {
    config.validate()?;
    let mut legs: Vec<Leg> = Vec::with_capacity(poses.len());
    for (from, to) in poses.iter().zip(poses.iter().skip(1)) {
        let duration_s = config.duration_s(from, to);
        let begin_s = legs
            .last()
            .map_or(0.0, |leg| leg.begin_s + leg.duration_s - config.overlap * leg.duration_s.min(duration_s));
        let way = to.translation.vector - from.translation.vector;
        legs.push(Leg { begin_s, duration_s, way, turn: (to.rotation * from.rotation.inverse()).scaled_axis() });
    }
    let mut times_s: Vec<f64> = legs.iter().flat_map(|leg| [leg.begin_s, leg.begin_s + leg.duration_s]).collect();
    times_s.sort_by(f64::total_cmp);
    times_s.dedup_by(|later, earlier| *later - *earlier < 1e-9);
    let start = poses.first().copied().unwrap_or_default();
    let knots = times_s.into_iter().map(|time_s| SpatialKnot { time_s, motion: moved(&start, &legs, time_s) });
    SpatialTrack::new(knots.collect())
}

/// Via points from one pose to another over an obstacle: each end lifted to the height `above_m`, m, along z of the world;
/// an end that is higher stays where it is.
#[must_use]
pub fn over(from: &Isometry3<f64>, to: &Isometry3<f64>, above_m: f64) -> Vec<Isometry3<f64>> {
    let lifted = |pose: &Isometry3<f64>| {
        let mut lifted = *pose;
        lifted.translation.vector.z = lifted.translation.vector.z.max(above_m);
        lifted
    };
    let mut poses = vec![*from, lifted(from), lifted(to), *to];
    poses.dedup_by(|later, earlier| {
        (later.translation.vector - earlier.translation.vector).norm() < 1e-9
            && later.rotation.angle_to(&earlier.rotation) < 1e-9
    });
    if poses.len() < 2 { vec![*from, *to] } else { poses }
}

fn moved(start: &Isometry3<f64>, legs: &[Leg], time_s: f64) -> SpatialMotion {
    let (mut place, mut rotation) = (start.translation.vector, start.rotation);
    let [mut linear, mut angular, mut linear_change, mut angular_change] = [Vector3::zeros(); 4];
    for leg in legs {
        let ratio = (time_s - leg.begin_s) / leg.duration_s;
        let along = minimum_jerk(ratio);
        let first = minimum_jerk_first_derivative(ratio) / leg.duration_s;
        let second = minimum_jerk_second_derivative(ratio) / (leg.duration_s * leg.duration_s);
        place += leg.way * along;
        linear += leg.way * first;
        linear_change += leg.way * second;
        // a leg turns what the legs before it have turned
        let turn = UnitQuaternion::from_scaled_axis(leg.turn * along);
        let own = leg.turn * first;
        let carried = turn * angular;
        angular_change = turn * angular_change + own.cross(&carried) + leg.turn * second;
        angular = own + carried;
        rotation = turn * rotation;
    }
    let pose = Isometry3::from_parts(Translation3::from(place), rotation);
    SpatialMotion::new(pose, [linear, angular], [linear_change, angular_change])
}
