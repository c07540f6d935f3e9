//! Verification of a plan in space: what jumps at its joints, its workspace and its rates, all between samples too.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::motion::SpatialJump;
use super::plan::SpatialPlan;
use super::refusal::SpatialError;
use super::track::{SpatialTrack, SpeedBounds};
use crate::corridor::least_value;
use crate::field::{FieldError, finite, positive};
use crate::time_law::PathState;

/// Parts into which a piece between two knots is divided, so that its bounds are within a few percent.
const PARTS: usize = 8;

/// Where two actions meet.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpatialJoint {
    /// Name of the action that ends.
    pub before: String,
    /// Name of the action that begins.
    pub after: String,
    /// Time of the plan, s.
    pub time_s: f64,
    /// What jumps there.
    pub jump: SpatialJump,
}

/// Limits of the tool's motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SpatialLimits {
    /// Box of the world that the tool's origin stays in, lower and upper corner, m; nowhere bound if absent.
    pub workspace_m: Option<[[f64; 3]; 2]>,
    /// Largest speed of the tool's origin, m/s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub speed_m_per_s: f64,
    /// Largest angular speed, rad/s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub angular_speed_rad_per_s: f64,
    /// Largest acceleration of the tool's origin, m/s².
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub acceleration_m_per_s2: f64,
    /// Largest angular acceleration, rad/s².
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub angular_acceleration_rad_per_s2: f64,
}

impl Default for SpatialLimits {
    /// What a collaborative arm moves its hand by beside people: half a meter and about a radian and a half per second.
    fn default() -> Self {
        Self {
            workspace_m: None,
            speed_m_per_s: 0.5,
            angular_speed_rad_per_s: 2.5,
            acceleration_m_per_s2: 5.0,
            angular_acceleration_rad_per_s2: 20.0,
        }
    }
}

impl SpatialLimits {
    /// Checks every limit.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("speed_m_per_s", self.speed_m_per_s)?;
        positive("angular_speed_rad_per_s", self.angular_speed_rad_per_s)?;
        positive("acceleration_m_per_s2", self.acceleration_m_per_s2)?;
        positive("angular_acceleration_rad_per_s2", self.angular_acceleration_rad_per_s2)?;
        let Some([low, high]) = self.workspace_m else { return Ok(()) };
        finite("workspace_m", &low)?;
        finite("workspace_m", &high)?;
        match low.iter().zip(&high).find(|(low, high)| low >= high) {
            None => Ok(()),
            Some((low, high)) => Err(FieldError::new("workspace_m", format!("{low} to {high}"), "lower below upper")),
        }
    }
}

/// What was found of a plan that was accepted; the rates are certified upper bounds.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialReport {
    /// Joints in their order.
    pub joints: Vec<SpatialJoint>,
    /// Largest rates over the whole plan.
    pub rates: SpeedBounds,
    /// Smallest distance of the tool's origin from the faces of the workspace, m; infinite without one.
    pub workspace_margin_m: f64,
}

impl SpatialPlan {
    /// Measures what jumps at each joint of the plan.
    #[must_use]
    pub fn joints(&self) -> Vec<SpatialJoint> {
        let pairs = self.actions().iter().zip(self.actions().iter().skip(1)).zip(self.starts_s().iter().skip(1));
        pairs
            .map(|((before, after), time_s)| SpatialJoint {
                before: before.name.clone(),
                after: after.name.clone(),
                time_s: *time_s,
                jump: SpatialJump::between(&before.track.end(), &after.track.start()),
            })
            .collect()
    }

    /// Verifies workspace and rates at all times of the plan; continuity was when it was built.
    ///
    /// # Errors
    /// [`SpatialError::Workspace`] or [`SpatialError::Rate`] with the action and time, or an invalid limit.
    pub fn verify(&self, limits: &SpatialLimits) -> Result<SpatialReport, SpatialError> {
        limits.validate()?;
        let (mut rates, mut workspace_margin_m) = (SpeedBounds::default(), f64::INFINITY);
        for (action, start_s) in self.actions().iter().zip(self.starts_s()) {
            for pair in action.track.knots().windows(2) {
                let step_s = (pair[1].time_s - pair[0].time_s) / PARTS as f64;
                for part in 0..PARTS {
                    let from_s = pair[0].time_s + step_s * part as f64;
                    let found = action.track.bounds(from_s, from_s + step_s);
                    check_rates(&action.name, &found, limits, start_s + from_s)?;
                    rates = rates.max(&found);
                }
            }
            if let Some(workspace_m) = limits.workspace_m {
                let (margin_m, axis, time_s) = margin(&action.track, workspace_m);
                if margin_m < 0.0 {
                    let (action, time_s) = (action.name.clone(), start_s + time_s);
                    return Err(SpatialError::Workspace { action, axis, beyond_m: -margin_m, time_s });
                }
                workspace_margin_m = workspace_margin_m.min(margin_m);
            }
        }
        Ok(SpatialReport { joints: self.joints(), rates, workspace_margin_m })
    }
}

/// Smallest distance of a track from the faces of a box, with the axis and the time, s.
fn margin(track: &SpatialTrack, [low, high]: [[f64; 3]; 2]) -> (f64, char, f64) {
    let mut smallest = (f64::INFINITY, 'x', 0.0);
    for pair in track.knots().windows(2) {
        let h = pair[1].time_s - pair[0].time_s;
        for (k, axis) in ['x', 'y', 'z'].into_iter().enumerate() {
            for (sign, face) in [(1.0, low[k]), (-1.0, -high[k])] {
                let distance = |motion: &super::SpatialMotion| {
                    let place: Vector3<f64> = motion.pose.translation.vector;
                    PathState {
                        position: sign * place[k] - face,
                        first: sign * motion.velocity[k],
                        second: sign * motion.acceleration[k],
                    }
                };
                let found = least_value(distance(&pair[0].motion), distance(&pair[1].motion), h, smallest.0);
                if let Some((least, after_s)) = found {
                    smallest = (least, axis, pair[0].time_s + after_s);
                }
            }
        }
    }
    smallest
}

fn check_rates(action: &str, found: &SpeedBounds, limits: &SpatialLimits, time_s: f64) -> Result<(), SpatialError> {
    let rates = [
        ("speed", "m/s", found.speed_m_per_s, limits.speed_m_per_s),
        ("angular speed", "rad/s", found.angular_speed_rad_per_s, limits.angular_speed_rad_per_s),
        ("acceleration", "m/s²", found.acceleration_m_per_s2, limits.acceleration_m_per_s2),
        (
            "angular acceleration",
            "rad/s²",
            found.angular_acceleration_rad_per_s2,
            limits.angular_acceleration_rad_per_s2,
        ),
    ];
    match rates.into_iter().find(|(_, _, found, limit)| found.is_nan() || found > limit) {
        None => Ok(()),
        Some((quantity, unit, found, limit)) => {
            Err(SpatialError::Rate { action: action.into(), quantity, unit, found, limit, time_s })
        }
    }
}

/// Checks that nothing jumps at a joint by more than accepted.
pub(super) fn check_jump(joint: &SpatialJoint, largest: &SpatialJump) -> Result<(), SpatialError> {
    let jump = &joint.jump;
    let numbers = [
        ("place", "m", jump.position_m, largest.position_m),
        ("angle", "rad", jump.angle_rad, largest.angle_rad),
        ("velocity", "m/s", jump.velocity_m_per_s, largest.velocity_m_per_s),
        ("angular velocity", "rad/s", jump.angular_velocity_rad_per_s, largest.angular_velocity_rad_per_s),
        ("acceleration", "m/s²", jump.acceleration_m_per_s2, largest.acceleration_m_per_s2),
        (
            "angular acceleration",
            "rad/s²",
            jump.angular_acceleration_rad_per_s2,
            largest.angular_acceleration_rad_per_s2,
        ),
    ];
    match numbers.into_iter().find(|(_, _, found, limit)| found.is_nan() || found > limit) {
        None => Ok(()),
        Some((quantity, unit, found, limit)) => Err(SpatialError::Joint {
            before: joint.before.clone(),
            after: joint.after.clone(),
            time_s: joint.time_s,
            quantity,
            unit,
            found,
            limit,
        }),
    }
}

#[cfg(test)]
#[path = "plan_tests.rs"]
mod tests;
