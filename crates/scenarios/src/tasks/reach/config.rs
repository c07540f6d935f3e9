//! The table `[task.reach]` and its limits.

use std::f64::consts::PI;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, finite, not_negative, positive, within};

use crate::report::number;

/// Longest wait or disturbance, s.
const LONGEST_S: f64 = 600.0;

/// Shortest move or hold, s.
const SHORTEST_S: f64 = 0.05;
/// Largest limit of a distance, m: a larger one decides nothing.
const LARGEST_LIMIT_M: f64 = 10.0;
/// Largest force along an axis, N: the weight of a thousand tonnes. An arm breaks down under far less, which its run tells.
const LARGEST_FORCE_N: f64 = 1e7;
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
    #[schemars(range(min = 0.0, max = LONGEST_S))]
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
    #[schemars(inner(range(min = -LONGEST_MOVE_M, max = LONGEST_MOVE_M)))]
    pub move_m: [f64; 3],
    /// Turn from the waypoint before: a rotation vector in world axes, at most half a turn, rad.
    #[serde(default)]
    pub turn_rad: [f64; 3],
    /// Time that it takes, s.
    #[schemars(range(min = SHORTEST_S, max = LONGEST_S))]
    pub duration_s: f64,
}

/// A force that pushes the tool for a while.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disturbance {
    /// Force on the origin of the tool's frame, world axes, N.
    #[schemars(inner(range(min = -LARGEST_FORCE_N, max = LARGEST_FORCE_N)))]
    pub force_n: [f64; 3],
    /// When it sets in, s.
    #[schemars(range(min = 0.0, max = LONGEST_S))]
    pub from_s: f64,
    /// How long it lasts, s.
    #[schemars(range(min = 0.0, max = LONGEST_S))]
    pub duration_s: f64,
    /// Time in which it grows and fades, s.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
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
    #[schemars(range(max = LARGEST_LIMIT_M), extend("exclusiveMinimum" = 0))]
    pub tool_error_m: f64,
    /// Largest turn of the tool from its goal at the end, rad.
    #[schemars(range(max = PI), extend("exclusiveMinimum" = 0))]
    pub tool_angle_error_rad: f64,
    /// Largest distance of the tool from its reference at any time, m; any if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = LARGEST_LIMIT_M), extend("exclusiveMinimum" = 0))]
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
        let end_s = self.duration_s();
        for (index, disturbance) in self.disturbances.iter().enumerate() {
            disturbance.validate(end_s).map_err(|error| error.within(format!("disturbances.{index}")))?;
        }
        if self.waypoints.is_empty() && self.hold_s == 0.0 {
            return Err(FieldError::new("hold_s", 0.0, "a time to hold the start for, or waypoints to go to"));
        }
        Ok(())
    }

    /// Time from the start to the end of the hold, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.waypoints.iter().map(|waypoint| waypoint.duration_s).sum::<f64>() + self.hold_s
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
    /// `end_s` is when the task ends.
    fn validate(&self, end_s: f64) -> Result<(), FieldError> {
        let forces = self.force_n.iter();
        forces.copied().try_for_each(|force_n| within("force_n", force_n, -LARGEST_FORCE_N, LARGEST_FORCE_N))?;
        within("from_s", self.from_s, 0.0, LONGEST_S)?;
        if self.from_s >= end_s {
            let found = format!("{} s, when the task is over", self.from_s);
            let expected = format!(
                "less than {} s, the end of the waypoints and of hold_s; let it set in earlier or raise hold_s",
                number(end_s)
            );
            return Err(FieldError::new("from_s", found, expected));
        }
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
        let at_most = |field: &str, limit: f64, largest: f64| {
            positive(field, limit)?;
            within(field, limit, 0.0, largest)
        };
        at_most("tool_error_m", self.tool_error_m, LARGEST_LIMIT_M)?;
        at_most("tool_angle_error_rad", self.tool_angle_error_rad, PI)?;
        self.largest_tool_error_m.map_or(Ok(()), |error_m| at_most("largest_tool_error_m", error_m, LARGEST_LIMIT_M))
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
    fn a_force_that_sets_in_after_the_end_or_is_beyond_measure_is_refused_by_name() {
        let refused = |from_s: f64, force_n: f64| {
            let push = Disturbance { force_n: [0.0, 0.0, force_n], from_s, duration_s: 1.0, ramp_s: 0.0, known: false };
            let waypoints = vec![Waypoint { move_m: [0.1; 3], turn_rad: [0.0; 3], duration_s: 1.5 }];
            ReachConfig { waypoints, hold_s: 3.0, disturbances: vec![push] }.validate().err()
        };
        assert_eq!(refused(4.4, -20.0), None);
        let late = refused(10.0, -20.0).expect("the run lasts 4.5 s");
        assert_eq!(late.field, "disturbances.0.from_s");
        assert!(late.found.contains("10 s") && late.expected.contains("less than 4.5 s"), "{late}");
        assert_eq!(refused(4.5, -20.0).expect("the very end").field, "disturbances.0.from_s");
        for force_n in [1e300, -1e8, f64::NAN] {
            assert_eq!(refused(1.0, force_n).expect("beyond measure").field, "disturbances.0.force_n");
        }
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
