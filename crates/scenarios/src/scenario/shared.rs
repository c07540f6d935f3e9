//! Sections that scenario files of several kinds of tasks share.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sim::controllers::ControllerConfig;

use super::ArmKeys;

/// Name, title, description and seed of a scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// Name in results and of their folder: letters, digits, `_` and `-`; the file's name without its ending if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// One line for lists and tables.
    pub title: String,
    /// A paragraph for the recording and for readers.
    #[serde(default)]
    pub description: String,
    /// All randomness of a run comes from here.
    #[serde(default = "default_seed")]
    pub seed: u64,
    /// Values that differ from those in the files of assets that the scenario names: `"tool.asset:family.l.arm_m" = 0.05`
    /// is the arm's length in the tool that `tool.asset` names.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(with = "BTreeMap<String, serde_json::Value>")]
    pub asset_changes: BTreeMap<String, toml::Value>,
}

fn default_seed() -> u64 {
    1
}

/// The tool in the hand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ToolConfig {
    /// Name of a file in `assets/tools`, without its ending.
    #[schemars(extend("x-asset" = "tools"))]
    pub asset: String,
}

/// The arm that holds the tool, on a base in the plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RobotConfig {
    /// Name of a URDF file in `assets/robots`, without its ending.
    #[schemars(extend("x-asset" = "robots"))]
    pub asset: String,
    /// Position of the arm's base in the world, m.
    #[serde(default)]
    pub base_m: [f64; 2],
    /// Rotation of the arm's base in the world, rad.
    #[serde(default)]
    pub base_angle_rad: f64,
    /// Rotor inertia felt at each joint, kg m²; one number per joint, or none for a bare arm.
    #[serde(default)]
    #[schemars(inner(range(min = 0.0)))]
    pub rotor_inertia_kg_m2: Vec<f64>,
    /// Frame of the arm that grips the tool.
    #[serde(default = "default_tool_frame")]
    pub tool_frame: String,
}

impl RobotConfig {
    /// What is said about the arm, together with its controller.
    pub(crate) fn keys<'a>(&'a self, controller: &'a ControllerConfig) -> ArmKeys<'a> {
        ArmKeys {
            asset: &self.asset,
            rotor_inertia_kg_m2: &self.rotor_inertia_kg_m2,
            tool_frame: &self.tool_frame,
            controller,
            spatial: None,
        }
    }
}

fn default_tool_frame() -> String {
    "flange".into()
}

/// What the recording holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RecordingConfig {
    /// Samples per simulated second in the recording, Hz.
    #[schemars(range(min = 0.01, max = super::CONTROL_RATE_HZ))]
    pub rate_hz: f64,
}

impl Default for RecordingConfig {
    fn default() -> Self {
        Self { rate_hz: 100.0 }
    }
}
