//! The scenario file of pouring.

use serde::{Deserialize, Serialize};
use sim::controllers::ControllerConfig;
use sim::pouring::{MonitorConfig, TableConfig};
use skills::field::FieldError;
use skills::pouring::{PourLearning, SavedPour};
use skills::primitive::pose::PoseTrajectory;

use super::config::{GrainsConfig, PourConfig, PourDemonstrations, PourLimits, SourceConfig, TargetConfig};
use super::engine::PourEngineConfig;
use super::variation::PourVariation;
use super::vessel::Vessel;
use super::{KIND, PourTask};
use crate::scenario::{
    ArmKeys, Header, ReadScenario, Reader, RecordingConfig, ResolvedScenario, ScenarioFile, SkillsFile,
};
use crate::tasks::spatial::SpatialRobotConfig;
use crate::tasks::{ResolvedTask, Runnable, TaskPart, written};

/// One pouring experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PourScenario {
    /// Name, title, description and seed.
    pub scenario: Header,
    /// The arm.
    pub robot: SpatialRobotConfig,
    /// What turns tracking errors into joint torques.
    pub controller: ControllerConfig,
    /// What is poured.
    pub grains: GrainsConfig,
    /// What is poured from.
    pub source: SourceConfig,
    /// What is poured into.
    pub target: TargetConfig,
    /// The table.
    #[serde(default)]
    pub table: TableConfig,
    /// What is to be done.
    pub task: PourTable,
    /// Where the skill comes from.
    pub demonstrations: PourDemonstrations,
    /// How it is learned.
    #[serde(default)]
    pub learning: PourLearning,
    /// What counts as spilt, as a clog.
    #[serde(default)]
    pub monitor: MonitorConfig,
    /// Time steps and contact solver.
    #[serde(default)]
    pub engine: PourEngineConfig,
    /// What a run differs in.
    #[serde(default)]
    pub variation: PourVariation,
    /// When the task counts as done.
    #[serde(default)]
    pub limits: PourLimits,
    /// What the recording holds.
    #[serde(default)]
    pub recording: RecordingConfig,
}

/// The table `task`, whose only key names the kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PourTable {
    /// Pour grains from the held cup into a container.
    Pour(PourConfig),
}

impl PourScenario {
    /// What is to be done.
    #[must_use]
    pub fn pour(&self) -> &PourConfig {
        let PourTable::Pour(pour) = &self.task;
        pour
    }
}

impl ScenarioFile for PourScenario {
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
        let parts = [
            ("scenario", self.scenario.validate()),
            ("robot", self.robot.validate()),
            ("grains", self.grains.validate()),
            ("source.grip", self.source.grip.validate()),
            ("target", skills::field::finite("place_m", &self.target.place_m)),
            ("table", self.table.validate()),
            ("task.pour", self.pour().validate()),
            ("demonstrations", self.demonstrations.validate()),
            ("learning", self.learning.validate()),
            ("monitor", self.monitor.validate()),
            ("engine", self.engine.validate()),
            ("variation", self.variation.validate()),
            ("limits", self.limits.validate()),
            ("recording", self.recording.validate()),
        ];
        parts.into_iter().filter_map(|(part, result)| Some(result.err()?.within(part))).collect()
    }
}

/// What a checked scenario of pouring holds.
#[derive(Clone, Debug)]
pub struct ResolvedPour {
    /// The scenario with all defaults filled in, the name too.
    pub scenario: PourScenario,
    /// What is poured from.
    pub source: Vessel,
    /// What is poured into.
    pub target: Vessel,
    /// What the skill was or is to be shown with; `None` if it was learned before.
    pub shown: Option<ShownVessels>,
    /// The recorded poses of the cup, if the scenario names such.
    pub recorded: Option<PoseTrajectory>,
    /// The skill that the scenario names instead of a demonstration.
    pub learned: Option<SkillsFile<SavedPour>>,
}

/// Containers of a demonstration.
#[derive(Clone, Debug)]
pub struct ShownVessels {
    /// What was poured from.
    pub source: Vessel,
    /// What was poured into.
    pub target: Vessel,
}

impl ResolvedPour {
    /// Name of the file of the cup that the demonstration was or is to be shown with.
    pub(super) fn shown_source_name(&self) -> &str {
        let own = match &self.scenario.demonstrations {
            PourDemonstrations::Synthetic(shown) => shown.source.as_deref(),
            PourDemonstrations::Recorded(shown) => shown.source.as_deref(),
            PourDemonstrations::Learned { .. } => None,
        };
        own.unwrap_or(&self.scenario.source.asset)
    }
}

impl ReadScenario for PourScenario {
    fn resolve(self, reader: &mut Reader<'_>, _refused: &[FieldError]) -> Option<ResolvedTask> {
        let source: Option<Vessel> = reader.asset("source.asset", &self.source.asset);
        let target = reader.asset("target.asset", &self.target.asset);
        let shown = Shown::read(reader, &self.demonstrations, source.as_ref());
        let pour = ResolvedPour {
            source: source?,
            target: target?,
            shown: shown.vessels?,
            recorded: shown.recorded?,
            learned: shown.learned?,
            scenario: self,
        };
        Some(ResolvedTask::Pour(Box::new(pour)))
    }
}

/// What a scenario names of its demonstration, as far as it could be read.
struct Shown {
    vessels: Option<Option<ShownVessels>>,
    recorded: Option<Option<PoseTrajectory>>,
    learned: Option<Option<SkillsFile<SavedPour>>>,
}

impl Shown {
    fn read(reader: &mut Reader<'_>, demonstrations: &PourDemonstrations, own: Option<&Vessel>) -> Self {
        let mut vessels = |part: &str, source: Option<&str>, target: &str| {
            let source = match source {
                Some(name) => reader.asset(&format!("demonstrations.{part}.source"), name),
                None => own.cloned(),
            };
            let target = reader.asset(&format!("demonstrations.{part}.target"), target);
            Some(Some(ShownVessels { source: source?, target: target? }))
        };
        match demonstrations {
            PourDemonstrations::Synthetic(shown) => Self {
                vessels: vessels("synthetic", shown.source.as_deref(), &shown.target),
                recorded: Some(None),
                learned: Some(None),
            },
            PourDemonstrations::Recorded(shown) => Self {
                vessels: vessels("recorded", shown.source.as_deref(), &shown.target),
                recorded: reader.poses("demonstrations.recorded.asset", &shown.asset).map(Some),
                learned: Some(None),
            },
            PourDemonstrations::Learned { asset } => {
                let restore =
                    |_: &mut _, file: SkillsFile<SavedPour>| Some(file.skills.clone().restore().map(|_| file));
                let learned = reader.skills("demonstrations.learned.asset", asset, restore).map(Some);
                Self { vessels: Some(None), recorded: Some(None), learned }
            }
        }
    }
}

impl TaskPart for ResolvedPour {
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
        Box::new(PourTask::new(scenario, self, seed))
    }
}
