//! The scenario file of reaching.

use serde::{Deserialize, Serialize};
use sim::controllers::ControllerConfig;
use sim::spatial::EngineConfig;
use skills::field::FieldError;

use super::config::{ReachConfig, ReachLimits};
use super::{KIND, ReachTask};
use crate::scenario::{ArmKeys, Header, ReadScenario, Reader, RecordingConfig, ResolvedScenario, ScenarioFile};
use crate::tasks::spatial::SpatialRobotConfig;
use crate::tasks::{ResolvedTask, Runnable, TaskPart, written};

/// One reaching experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReachScenario {
    /// Name, title, description and seed.
    pub scenario: Header,
    /// The arm.
    pub robot: SpatialRobotConfig,
    /// What turns tracking errors into joint torques.
    pub controller: ControllerConfig,
    /// What is to be done.
    pub task: ReachTable,
    /// Time steps and contact solver.
    #[serde(default)]
    pub engine: EngineConfig,
    /// When the task counts as done.
    #[serde(default)]
    pub limits: ReachLimits,
    /// What the recording holds.
    #[serde(default)]
    pub recording: RecordingConfig,
}

/// The table `task`, whose only key names the kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ReachTable {
    /// Bring the tool through waypoints and hold it there.
    Reach(ReachConfig),
}

impl ReachScenario {
    /// Where to go.
    #[must_use]
    pub fn reach(&self) -> &ReachConfig {
        let ReachTable::Reach(reach) = &self.task;
        reach
    }
}

impl ScenarioFile for ReachScenario {
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
        Some(self.limits.tool_error_m)
    }

    fn refused_values(&self) -> Vec<FieldError> {
        let parts = [
            ("scenario", self.scenario.validate()),
            ("robot", self.robot.validate()),
            ("task.reach", self.reach().validate()),
            ("engine", self.engine.validate()),
            ("limits", self.limits.validate()),
            ("recording", self.recording.validate()),
        ];
        parts.into_iter().filter_map(|(part, result)| Some(result.err()?.within(part))).collect()
    }
}

/// What a checked scenario of reaching holds.
#[derive(Clone, Debug)]
pub struct ResolvedReach {
    /// The scenario with all defaults filled in, the name too.
    pub scenario: ReachScenario,
}

impl ReadScenario for ReachScenario {
    fn resolve(self, _reader: &mut Reader<'_>, _refused: &[FieldError]) -> Option<ResolvedTask> {
        Some(ResolvedTask::Reach(Box::new(ResolvedReach { scenario: self })))
    }
}

impl TaskPart for ResolvedReach {
    fn kind(&self) -> &'static str {
        KIND.name
    }

    fn file(&self) -> &dyn ScenarioFile {
        &self.scenario
    }

    fn text(&self, seed: u64) -> Result<String, String> {
        written(&self.scenario, seed)
    }

    fn start<'a>(&'a self, scenario: &'a ResolvedScenario, seed: u64) -> Box<dyn Runnable + 'a> {
        Box::new(ReachTask::new(scenario, self, seed))
    }
}
