//! What a pushing scenario states about its task.

use std::collections::BTreeMap;

use nalgebra::Isometry2;
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, finite, within};
use skills::tool_use::Orientation;
use skills::transfer::{Side, TransferConfig};

/// What is to be pushed where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PushConfig {
    /// Where the object starts, world frame, m.
    pub start_m: [f64; 2],
    /// Orientation of the object at the start, rad.
    #[serde(default)]
    pub start_angle_rad: f64,
    /// Where the object is wanted, world frame, m.
    pub goal_m: [f64; 2],
    /// Where the tool waits before, world frame, m.
    #[schemars(inner(range(min = -FARTHEST_M, max = FARTHEST_M)))]
    pub home_m: [f64; 2],
    /// Where the tool is put afterwards, world frame, m; back home if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub park_m: Option<[f64; 2]>,
    /// How the tool is turned.
    #[serde(default)]
    pub orientation: Orientation,
    /// Whether and how the skill is transferred to the scenario's tool: surfaces, places and order of the pushes are then
    /// searched for; without it, the demonstrated sequence of surfaces is kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transfer: Option<TransferTask>,
    /// Speed of a push, m/s.
    #[serde(default = "default_push_speed")]
    #[schemars(range(min = SLOWEST_M_PER_S, max = FASTEST_M_PER_S))]
    pub push_speed_m_per_s: f64,
    /// Speed of the tool through free space, m/s.
    #[serde(default = "default_free_speed")]
    #[schemars(range(min = SLOWEST_M_PER_S, max = FASTEST_M_PER_S))]
    pub free_speed_m_per_s: f64,
    /// Time that the object is given to rest after the last contact, s.
    #[serde(default = "default_settle")]
    #[schemars(range(min = 0.0, max = LONGEST_SETTLE_S))]
    pub settle_s: f64,
}

/// How a skill is transferred to the scenario's tool.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TransferTask {
    /// Angle at which the tool is held, rad.
    pub tool_angle_rad: f64,
    /// Side on which an obstacle is passed, by its name; as demonstrated if absent.
    pub sides: BTreeMap<String, Side>,
    /// How the plan is made.
    pub planner: TransferConfig,
}

/// A place at which the object is to stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stand {
    /// Dotted path of the scenario's key that names it.
    pub(super) key: &'static str,
    /// Pose of the object there.
    pub(super) world_from_object: Isometry2<f64>,
}

impl Stand {
    /// The place that `key` names, world frame, m and rad.
    pub(super) fn new(key: &'static str, position_m: [f64; 2], angle_rad: f64) -> Self {
        Self { key, world_from_object: Isometry2::new(position_m.into(), angle_rad) }
    }
}

/// A tool waits on the table or beside it, m.
const FARTHEST_M: f64 = 10.0;
/// Speeds that make sense on a table, m/s, and the longest rest after a run, s.
const SLOWEST_M_PER_S: f64 = 1e-4;
const FASTEST_M_PER_S: f64 = 2.0;
const LONGEST_SETTLE_S: f64 = 60.0;

fn default_push_speed() -> f64 {
    0.020
}

fn default_free_speed() -> f64 {
    0.060
}

fn default_settle() -> f64 {
    0.3
}

impl PushConfig {
    /// Where the tool is put afterwards, world frame, m.
    #[must_use]
    pub fn park_m(&self) -> [f64; 2] {
        self.park_m.unwrap_or(self.home_m)
    }

    /// Where the object starts and where it is wanted; the goal leaves the angle open, and the start's is taken.
    pub(super) fn stands(&self) -> Vec<Stand> {
        let at = |key, position_m| Stand::new(key, position_m, self.start_angle_rad);
        vec![at("task.push.start_m", self.start_m), at("task.push.goal_m", self.goal_m)]
    }

    /// Checks the numbers on their own.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("start_m", &self.start_m)?;
        finite("start_angle_rad", &[self.start_angle_rad])?;
        finite("goal_m", &self.goal_m)?;
        for (field, place) in [("home_m", self.home_m), ("park_m", self.park_m())] {
            place.iter().try_for_each(|value| within(field, *value, -FARTHEST_M, FARTHEST_M))?;
        }
        if let Some(transfer) = &self.transfer {
            finite("transfer.tool_angle_rad", &[transfer.tool_angle_rad])?;
            transfer.planner.validate().map_err(|error| error.within("transfer.planner"))?;
        }
        within("push_speed_m_per_s", self.push_speed_m_per_s, SLOWEST_M_PER_S, FASTEST_M_PER_S)?;
        within("free_speed_m_per_s", self.free_speed_m_per_s, SLOWEST_M_PER_S, FASTEST_M_PER_S)?;
        within("settle_s", self.settle_s, 0.0, LONGEST_SETTLE_S)
    }
}
