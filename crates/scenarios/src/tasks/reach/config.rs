//! The table `[task.reach]` and its limits.

use std::f64::consts::PI;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, finite, not_negative, positive, within};

/// Longest wait or disturbance, s.
const LONGEST_S: f64 = 600.0;

/// Shortest move or hold, s.
const SHORTEST_S: f64 = 0.05;
/// Longest move along an axis, m: beyond any arm.
const LONGEST_MOVE_M: f64 = 100.0;

/// Bring the tool through waypoints, and hold it there against forces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReachConfig {
    /// Places to go to, in their order; none to hold the start.
    #[serde(default)]
    pub waypoints: Vec<Waypoint>,
    /// Time for which the tool is held at the end, s.
    #[serde(default = "default_hold_s")]
    pub hold_s: f64,
    /// Forces that push the tool.
    #[serde(default)]
    pub disturbances: Vec<Disturbance>,
}

fn default_hold_s() -> f64 {
    1.0
}

/// A pose of the tool to go to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Waypoint {
    /// Way from the waypoint before (from the start for the first), world axes, m.
    pub move_m: [f64; 3],
    /// Turn from the waypoint before: a rotation vector in world axes, at most half a turn, rad.
    #[serde(default)]
    pub turn_rad: [f64; 3],
    /// Time that it takes, s.
    pub duration_s: f64,
}

/// A force that pushes the tool for a while.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disturbance {
    /// Force on the origin of the tool's frame, world axes, N.
    pub force_n: [f64; 3],
    /// When it sets in, s.
    pub from_s: f64,
    /// How long it lasts, s.
    pub duration_s: f64,
    /// Time in which it grows and fades, s.
    #[serde(default)]
    pub ramp_s: f64,
    /// Whether the controller knows of it and withstands it.
    #[serde(default)]
    pub known: bool,
}

/// When reaching counts as done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ReachLimits {
    /// Largest distance of the tool from its goal at the end, m.
    pub tool_error_m: f64,
    /// Largest turn of the tool from its goal at the end, rad.
    pub tool_angle_error_rad: f64,
    /// Largest distance of the tool from its reference at any time, m; any if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_tool_error_m: Option<f64>,
}

impl Default for ReachLimits {
    fn default() -> Self {
        Self { tool_error_m: 0.001, tool_angle_error_rad: 0.01, largest_tool_error_m: None }
    }
}

impl ReachConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("hold_s", self.hold_s, 0.0, LONGEST_S)?;
        if self.hold_s > 0.0 {
            within("hold_s", self.hold_s, SHORTEST_S, LONGEST_S)?;
        }
        for (index, waypoint) in self.waypoints.iter().enumerate() {
            let at = |error: FieldError| error.within(format!("waypoints.{index}"));
            waypoint.validate().map_err(at)?;
        }
        for (index, disturbance) in self.disturbances.iter().enumerate() {
            disturbance.validate().map_err(|error| error.within(format!("disturbances.{index}")))?;
        }
        if self.waypoints.is_empty() && self.hold_s == 0.0 {
            return Err(FieldError::new("hold_s", 0.0, "a time to hold the start for, or waypoints to go to"));
        }
        Ok(())
    }
}

impl Waypoint {
    fn validate(&self) -> Result<(), FieldError> {
        self.move_m.iter().try_for_each(|&way_m| within("move_m", way_m, -LONGEST_MOVE_M, LONGEST_MOVE_M))?;
        finite("turn_rad", &self.turn_rad)?;
        let angle = Vector3::from(self.turn_rad).norm();
        if angle > PI {
            let expected = "at most half a turn, pi rad, as the tool takes the short way; use two waypoints for more";
            return Err(FieldError::new("turn_rad", format!("a turn by {angle:.4} rad"), expected));
        }
        within("duration_s", self.duration_s, SHORTEST_S, LONGEST_S)
    }
}

impl Disturbance {
    fn validate(&self) -> Result<(), FieldError> {
        finite("force_n", &self.force_n)?;
        within("from_s", self.from_s, 0.0, LONGEST_S)?;
        within("duration_s", self.duration_s, 0.0, LONGEST_S)?;
        not_negative("ramp_s", self.ramp_s)?;
        if 2.0 * self.ramp_s > self.duration_s {
            let expected = format!("at most half of duration_s = {}", self.duration_s);
            return Err(FieldError::new("ramp_s", self.ramp_s, expected));
        }
        Ok(())
    }

    /// The force at a time, world axes, N.
    #[must_use]
    pub fn force_at_n(&self, time_s: f64) -> Vector3<f64> {
        let (since_s, left_s) = (time_s - self.from_s, self.from_s + self.duration_s - time_s);
        let share = |time_s: f64| if self.ramp_s > 0.0 { (time_s / self.ramp_s).min(1.0) } else { 1.0 };
        if since_s < 0.0 || left_s <= 0.0 {
            return Vector3::zeros();
        }
        Vector3::from(self.force_n) * share(since_s).min(share(left_s))
    }
}

impl ReachLimits {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("tool_error_m", self.tool_error_m)?;
        positive("tool_angle_error_rad", self.tool_angle_error_rad)?;
        self.largest_tool_error_m.map_or(Ok(()), |error_m| positive("largest_tool_error_m", error_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_grows_lasts_and_fades() {
        let push = Disturbance { force_n: [0.0, 0.0, -10.0], from_s: 1.0, duration_s: 2.0, ramp_s: 0.5, known: false };
        let down = |time_s: f64| push.force_at_n(time_s).z;
        assert_eq!([down(0.9), down(1.25), down(2.0), down(2.75), down(3.0)], [0.0, -5.0, -10.0, -5.0, 0.0]);
    }

    #[test]
    fn moves_and_holds_that_cannot_be_carried_out_as_written_are_refused_by_name() {
        let refused = |move_m, turn_rad, hold_s| {
            let waypoints = vec![Waypoint { move_m, turn_rad, duration_s: 1.0 }];
            ReachConfig { waypoints, hold_s, disturbances: vec![] }.validate().err().map(|error| error.field)
        };
        assert_eq!(refused([0.1; 3], [0.0, 0.0, 3.1], 0.05), None);
        // a whole turn would be none at all, and a hold of almost no time has no finite rates
        assert_eq!(refused([0.1; 3], [0.0, 0.0, 6.2], 1.0).as_deref(), Some("waypoints.0.turn_rad"));
        assert_eq!(refused([1e300, 0.0, 0.0], [0.0; 3], 1.0).as_deref(), Some("waypoints.0.move_m"));
        assert_eq!(refused([0.1; 3], [0.0; 3], 1e-300).as_deref(), Some("hold_s"));
    }

    #[test]
    fn a_ramp_longer_than_its_force_is_refused_by_name() {
        let push = Disturbance { force_n: [0.0; 3], from_s: 0.0, duration_s: 1.0, ramp_s: 0.6, known: false };
        let task = ReachConfig { waypoints: vec![], hold_s: 1.0, disturbances: vec![push] };
        assert_eq!(task.validate().unwrap_err().field, "disturbances.0.ramp_s");
        let nothing = ReachConfig { waypoints: vec![], hold_s: 0.0, disturbances: vec![] };
        assert_eq!(nothing.validate().unwrap_err().field, "hold_s");
    }
}
