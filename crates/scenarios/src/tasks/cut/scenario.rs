//! The scenario file of a cut: food, knife, board and arm, what is wanted, how it is learned, carried out and judged.

use serde::{Deserialize, Serialize};
use sim::controllers::ControllerConfig;
use sim::cutting::mechanics::CuttingConfig;
use sim::spatial::EngineConfig;
use skills::cutting::CutLearning;
use skills::field::FieldError;
use skills::spatial::SpatialLimits;

use super::config::CutConfig;
use super::sections::{BoardConfig, ExecutionConfig, FoodConfig, KnifeConfig, Limits, LookConfig};
use super::showing::DemonstrationsConfig;
use super::variation::VariationConfig;
use crate::scenario::{ArmKeys, Header, RecordingConfig, ScenarioFile};
use crate::tasks::spatial::SpatialRobotConfig;

/// One cutting experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CutScenario {
    /// Name, title, description and seed.
    pub scenario: Header,
    /// What is cut.
    pub food: FoodConfig,
    /// What it is cut with.
    pub knife: KnifeConfig,
    /// What it is cut on.
    pub board: BoardConfig,
    /// The arm that holds the knife.
    pub robot: SpatialRobotConfig,
    /// What turns tracking errors into joint torques.
    pub controller: ControllerConfig,
    /// What is to be done.
    pub task: CutTable,
    /// Where the demonstration comes from.
    pub demonstrations: DemonstrationsConfig,
    /// How a skill is learned from it.
    #[serde(default)]
    pub learning: CutLearning,
    /// How the plan is made and carried out.
    #[serde(default)]
    pub execution: ExecutionConfig,
    /// Limits of the knife's motion that a plan must keep.
    #[serde(default)]
    pub motion_limits: SpatialLimits,
    /// Numbers of the cutting law that belong neither to the food nor to the knife.
    #[serde(default)]
    pub mechanics: CuttingConfig,
    /// Time steps and contact solver.
    #[serde(default)]
    pub engine: EngineConfig,
    /// How well the food is seen before it is cut; the planner takes it to lie as stated if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub look: Option<LookConfig>,
    /// What each seed's food and board differ in from all of this.
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
pub enum CutTable {
    /// Cut a food on a board.
    Cut(CutConfig),
}

impl CutScenario {
    /// What is to be cut where.
    #[must_use]
    pub fn cut(&self) -> &CutConfig {
        let CutTable::Cut(cut) = &self.task;
        cut
    }
}

impl ScenarioFile for CutScenario {
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

    fn refused_values(&self) -> Vec<FieldError> {
        let parts: [(&str, Result<(), FieldError>); 15] = [
            ("scenario", self.scenario.validate()),
            ("food", self.food.validate()),
            ("knife", self.knife.validate()),
            ("board", self.board.validate()),
            ("robot", self.robot.validate()),
            ("task.cut", self.cut().validate()),
            ("demonstrations", self.demonstrations.validate()),
            ("learning", self.learning.validate()),
            ("motion_limits", self.motion_limits.validate()),
            ("mechanics", self.mechanics.validate()),
            ("engine", self.engine.validate()),
            ("look", self.look.as_ref().map_or(Ok(()), LookConfig::validate)),
            ("variation", self.variation.validate()),
            ("limits", self.limits.validate()),
            ("recording", self.recording.validate()),
        ];
        parts.into_iter().filter_map(|(part, result)| Some(result.err()?.within(part))).collect()
    }
}
