//! Scooping: bring grains from one bowl to another with a spoon.

use serde::{Deserialize, Serialize};
use sim::controllers::ControllerConfig;
use sim::planar::Episode;
use skills::demonstration::Demonstration;
use skills::field::{FieldError, positive};
use skills::plan::Plan;
use skills::tool::Tool;
use skills::tool_use::SkillLibrary;

use super::{ResolvedTask, Runnable, StageError, Task, TaskKind, TaskPart, written};
use crate::outcome::{Limit, Measure, Outcome};
use crate::pipeline::{Onlooker, Progress};
use crate::scenario::{
    ArmKeys, Header, ReadScenario, Reader, RecordingConfig, ResolvedScenario, RobotConfig, ScenarioFile, ToolConfig,
    load_as,
};
use crate::schema::subschema;

/// The kind.
pub(crate) const KIND: TaskKind = TaskKind {
    name: "scoop",
    summary: "bring grains from one bowl to another with a spoon",
    example: ("scenarios/scoop_beans.toml", include_str!("scoop_beans.toml")),
    tool_key: Some("tool.asset"),
    load: load_as::<ScoopScenario>,
    skills: None,
    schema: subschema::<ScoopScenario>,
};

/// The scenario file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScoopScenario {
    /// Name, title, description and seed.
    pub scenario: Header,
    /// The spoon.
    pub tool: ToolConfig,
    /// The arm that holds it.
    pub robot: RobotConfig,
    /// What turns tracking errors into joint torques.
    pub controller: ControllerConfig,
    /// What is to be done.
    pub task: ScoopTable,
    /// What the recording holds.
    #[serde(default)]
    pub recording: RecordingConfig,
}

/// The table `task`, whose only key names the kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ScoopTable {
    /// Bring grains from one bowl to another.
    Scoop {
        /// Mass of grains that must arrive, kg.
        wanted_kg: f64,
    },
}

impl ScenarioFile for ScoopScenario {
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
        let ScoopTable::Scoop { wanted_kg } = self.task;
        let parts = [
            ("scenario", self.scenario.validate()),
            ("robot", self.robot.validate()),
            ("task.scoop", positive("wanted_kg", wanted_kg)),
            ("recording", self.recording.validate()),
        ];
        parts.into_iter().filter_map(|(part, result)| Some(result.err()?.within(part))).collect()
    }
}

/// What a checked scenario holds: the file, and what it names besides its arm.
#[derive(Clone, Debug)]
pub struct ResolvedScoop {
    /// The scenario with all defaults filled in.
    pub scenario: ScoopScenario,
    /// The spoon.
    pub tool: Tool,
}

impl ReadScenario for ScoopScenario {
    fn resolve(self, reader: &mut Reader<'_>, _refused: &[FieldError]) -> Option<ResolvedTask> {
        let tool = reader.asset("tool.asset", &self.tool.asset)?;
        Some(ResolvedTask::Scoop(Box::new(ResolvedScoop { scenario: self, tool })))
    }
}

impl TaskPart for ResolvedScoop {
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
        Box::new(ScoopTask { scenario, scoop: self, seed })
    }
}

/// A scooping task of one scenario and seed.
struct ScoopTask<'a> {
    scenario: &'a ResolvedScenario,
    scoop: &'a ResolvedScoop,
    seed: u64,
}

fn missing(stage: &str) -> StageError {
    StageError::Broken(format!("{stage} is not written yet"))
}

impl Task for ScoopTask<'_> {
    type Shown = Vec<Demonstration>;
    type Skills = SkillLibrary;
    type Plan = Plan;
    type Episode = Episode;

    fn demonstrations(&self, _progress: Progress<'_>) -> Result<Self::Shown, StageError> {
        Err(missing("demonstrate"))
    }

    fn learn(&self, _shown: &Self::Shown) -> Result<SkillLibrary, StageError> {
        Err(missing("learn"))
    }

    fn plan(&self, _skills: &SkillLibrary) -> Result<Plan, StageError> {
        Err(missing("plan"))
    }

    fn simulate(&self, _plan: &Plan, _observer: &mut dyn Onlooker) -> Result<Episode, StageError> {
        Err(missing("simulate"))
    }

    fn judge(&self, _shown: &Self::Shown, _skills: &SkillLibrary, _plan: &Plan, episode: &Episode) -> Outcome {
        let ScoopTable::Scoop { wanted_kg } = self.scoop.scenario.task;
        let moved = Measure::judged("moved_kg", "grains that arrived", None, "kg", Limit::AtLeast(wanted_kg));
        Outcome::judged(self.scenario, self.seed, vec![moved], Vec::new(), Vec::new(), episode.digest.clone())
    }

    fn simulated_s(episode: &Episode) -> f64 {
        episode.duration_s()
    }
}
