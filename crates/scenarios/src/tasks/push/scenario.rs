//! The scenario file of a push: one plane experiment, what is there, what is to be done, how it is learned and carried out.

use serde::{Deserialize, Serialize};
use sim::controllers::ControllerConfig;
use sim::planar::{EngineConfig, ObjectConfig, WorldConfig};
use sim::sensing::CameraConfig;
use skills::field::FieldError;
use skills::primitive::PrimitiveConfig;

use super::config::{PushConfig, Stand};
use super::sections::{DemonstrationsConfig, ExecutionConfig, Limits};
use super::variation::VariationConfig;
use crate::scenario::{ArmKeys, Header, RecordingConfig, RobotConfig, ScenarioFile, ToolConfig};

/// One pushing experiment: what is there, what is to be done, how it is learned, carried out and judged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PushScenario {
    /// Name, title, description and seed.
    pub scenario: Header,
    /// The table: map, gravity, obstacles.
    pub world: WorldConfig,
    /// The object that is pushed.
    pub object: ObjectConfig,
    /// The tool in the hand.
    pub tool: ToolConfig,
    /// The arm that holds the tool.
    pub robot: RobotConfig,
    /// What turns tracking errors into joint torques.
    pub controller: ControllerConfig,
    /// What is to be done.
    pub task: PushTable,
    /// Where the demonstrations come from.
    pub demonstrations: DemonstrationsConfig,
    /// What is learned from them.
    #[serde(default)]
    pub primitive: PrimitiveConfig,
    /// How the plan is carried out.
    #[serde(default)]
    pub execution: ExecutionConfig,
    /// What sees the object.
    #[serde(default)]
    pub camera: CameraConfig,
    /// Time steps and contact solver.
    #[serde(default)]
    pub engine: EngineConfig,
    /// What each seed's world differs in from all of this.
    #[serde(default)]
    pub variation: VariationConfig,
    /// When the task counts as done.
    #[serde(default)]
    pub limits: Limits,
    /// What the recording holds.
    #[serde(default)]
    pub recording: RecordingConfig,
}

/// The table `task`, whose only key names the kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PushTable {
    /// Push an object over a table to a goal.
    Push(PushConfig),
}

impl PushScenario {
    /// What is to be pushed where.
    #[must_use]
    pub fn push(&self) -> &PushConfig {
        let PushTable::Push(push) = &self.task;
        push
    }

    /// Every place at which the scenario puts the object.
    pub(super) fn stands(&self) -> Vec<Stand> {
        let mut stands = self.push().stands();
        if let DemonstrationsConfig::Synthetic(synthetic) = &self.demonstrations {
            stands.push(Stand::new("demonstrations.synthetic.start_m", synthetic.start_m, 0.0));
            stands.push(Stand::new("demonstrations.synthetic.goal_m", synthetic.goal_m, 0.0));
        }
        stands
    }
}

impl ScenarioFile for PushScenario {
    fn header(&self) -> &Header {
        &self.scenario
    }

    fn header_mut(&mut self) -> &mut Header {
        &mut self.scenario
    }

    fn arm(&self) -> ArmKeys<'_> {
        self.robot.keys(&self.controller)
    }

    fn recording(&self) -> &RecordingConfig {
        &self.recording
    }

    fn goal_tolerance_m(&self) -> Option<f64> {
        Some(self.limits.goal_error_m)
    }

    fn refused_values(&self) -> Vec<FieldError> {
        let parts: [(&str, Result<(), FieldError>); 13] = [
            ("scenario", self.scenario.validate()),
            ("world", self.world.validate()),
            ("object", self.object.validate()),
            ("robot", self.robot.validate()),
            ("task.push", self.push().validate()),
            ("demonstrations", self.demonstrations.validate()),
            ("primitive", self.primitive.validate()),
            ("execution", self.execution.validate()),
            ("camera", self.camera.validate()),
            ("engine", self.engine.validate()),
            ("variation", self.variation.validate()),
            ("limits", self.limits.validate()),
            ("recording", self.recording.validate()),
        ];
        parts.into_iter().filter_map(|(part, result)| Some(result.err()?.within(part))).collect()
    }
}
