//! Tasks: what is to be done, and how well it was done. A task is one folder and its lines here.
//!
//! The folder of a kind, `push` for example, holds
//!
//! - its scenario file, a struct with `deny_unknown_fields` whose field `task` is an enum of one variant, so that the file
//!   says `[task.push]`; `ScenarioFile` tells of it what all kinds share;
//! - a struct of that and of what else the file names, read by `ReadScenario::resolve`: it is the variant of
//!   [`ResolvedTask`], and by `TaskPart` it starts the task;
//! - the task itself, the verbs of [`Task`];
//! - a [`TaskKind`]: name, summary, a shipped scenario that shows how keys are written, `load_as` and `subschema` of the
//!   file's struct;
//! - if the kind learns, `SavedSkills` for what it keeps of its skills in a file.
//!
//! Its lines here are `mod`, one variant of [`ResolvedTask`] and its arm in `ResolvedTask::part`, and one entry of
//! [`TASKS`]. Loading, running, learning, lists, reports and recordings follow from these.

pub mod cut;
mod demonstrations;
pub mod pour;
pub mod push;
pub mod reach;
mod runnable;
// the task that CONTRIBUTING.md shows, so that it compiles
#[cfg(test)]
#[path = "../../../../tests/authoring/scoop.rs"]
pub mod scoop;
#[cfg(test)]
#[path = "../../../../tests/authoring/scoop_tests.rs"]
mod scoop_tests;
pub mod spatial;

use std::fmt;

use serde::de::{Deserialize, Deserializer, EnumAccess, Error as _, IgnoredAny, VariantAccess, Visitor};

pub(crate) use demonstrations::MOST_DEMONSTRATIONS;
pub use demonstrations::{DEMONSTRATIONS_SCHEMA, DemonstrationTrial, DemonstrationsReport, ShownTrial};
pub(crate) use push::read_demonstration;
pub(crate) use runnable::Runnable;

use robot::RobotError;
use sim::SimError;

use crate::diagnostic::Diagnostic;
use crate::outcome::Outcome;
use crate::pipeline::{Onlooker, Progress};
use crate::scenario::{KeptSkills, Loader, ResolvedScenario, ScenarioFile, Source};
use crate::schema::Subschema;

/// All kinds of tasks.
pub const TASKS: &[TaskKind] = &[push::KIND, reach::KIND, cut::KIND, pour::KIND];

/// What is particular to the kind of a scenario's task: its file and what else that names.
#[derive(Clone, Debug)]
pub enum ResolvedTask {
    /// Push an object over a table to a goal.
    Push(Box<push::ResolvedPush>),
    /// Cut a food on a board.
    Cut(Box<cut::ResolvedCut>),
    /// Bring the tool through waypoints in space.
    Reach(Box<reach::ResolvedReach>),
    /// Pour beans from a held cup into a container.
    Pour(Box<pour::ResolvedPour>),
    /// Bring grains from one bowl to another with a spoon.
    #[cfg(test)]
    Scoop(Box<scoop::ResolvedScoop>),
}

impl ResolvedTask {
    /// What the program asks of every kind.
    pub(crate) fn part(&self) -> &dyn TaskPart {
        match self {
            Self::Push(push) => push.as_ref(),
            Self::Cut(cut) => cut.as_ref(),
            Self::Reach(reach) => reach.as_ref(),
            Self::Pour(pour) => pour.as_ref(),
            #[cfg(test)]
            Self::Scoop(scoop) => scoop.as_ref(),
        }
    }
}

/// What the program asks of the part of a scenario that is particular to the kind of its task.
pub(crate) trait TaskPart {
    /// Name of the kind: the key of its table in a scenario.
    fn kind(&self) -> &'static str;

    /// The scenario file with all defaults filled in.
    fn file(&self) -> &dyn ScenarioFile;

    /// The scenario file as TOML, every default written out, with another seed; the error is in words.
    fn text(&self, seed: u64) -> Result<String, String>;

    /// The part itself if it is that of a push, for what only pushes have.
    fn as_push(&self) -> Option<&push::ResolvedPush> {
        None
    }

    /// The task, ready to be run; `scenario` is the one that this is part of.
    fn start<'a>(&'a self, scenario: &'a ResolvedScenario, seed: u64) -> Box<dyn Runnable + 'a>;
}

/// Writes a scenario file as TOML, every default written out, with another seed; the error is in words.
pub(crate) fn written<F: ScenarioFile + serde::Serialize + Clone>(file: &F, seed: u64) -> Result<String, String> {
    let mut file = file.clone();
    file.header_mut().seed = seed;
    toml::to_string(&file).map_err(|error| error.to_string())
}

/// The verbs of a task. Each of the five that make a run is a function of what stands before it, the scenario and its
/// seed.
pub trait Task {
    /// What the demonstrations gave.
    type Shown;
    /// What was learned from them.
    type Skills;
    /// What is to be carried out.
    type Plan;
    /// What happened.
    type Episode;

    /// Records or loads demonstrations.
    ///
    /// # Errors
    /// A [`StageError`].
    fn demonstrations(&self, progress: Progress<'_>) -> Result<Self::Shown, StageError>;

    /// Lets a synthetic human show the task until `count` trials succeeded (as many as the scenario wants if absent),
    /// and hands on every trial.
    ///
    /// # Errors
    /// A [`StageError`]: that of `each`, or that there is no human, or that too few trials succeeded.
    fn show(
        &self,
        count: Option<usize>,
        progress: Progress<'_>,
        each: &mut dyn FnMut(ShownTrial) -> Result<(), StageError>,
    ) -> Result<(), StageError> {
        let _ = (count, progress, each);
        Err(StageError::Input(
            "tasks of this kind have no synthetic human; expected a task that has one: push, cut or pour".into(),
        ))
    }

    /// Learns skills from them.
    ///
    /// # Errors
    /// A [`StageError`].
    fn learn(&self, shown: &Self::Shown) -> Result<Self::Skills, StageError>;

    /// Takes down the skills, to be written to a file.
    ///
    /// # Errors
    /// A [`StageError`] if tasks of this kind learn nothing, or the skills cannot be written down.
    fn save(&self, shown: &Self::Shown, skills: &Self::Skills) -> Result<KeptSkills, StageError> {
        let _ = (shown, skills);
        Err(StageError::Input("tasks of this kind learn nothing; expected a task that does: push, cut or pour".into()))
    }

    /// Plans the task with the skills, and checks that the arm can carry the plan out.
    ///
    /// # Errors
    /// A [`StageError`].
    fn plan(&self, skills: &Self::Skills) -> Result<Self::Plan, StageError>;

    /// Builds the scene and carries the plan out in it.
    ///
    /// # Errors
    /// A [`StageError`].
    fn simulate(&self, plan: &Self::Plan, observer: &mut dyn Onlooker) -> Result<Self::Episode, StageError>;

    /// Judges what happened; sees no physics.
    fn judge(&self, shown: &Self::Shown, skills: &Self::Skills, plan: &Self::Plan, episode: &Self::Episode) -> Outcome;

    /// Simulated time of an episode, s.
    fn simulated_s(episode: &Self::Episode) -> f64;
}

/// Why a stage of a run did not get to its end.
#[derive(Clone, Debug, PartialEq)]
pub enum StageError {
    /// The task cannot be done as the scenario states it: an outcome, not a crash.
    Infeasible(String),
    /// The scenario asks for something that makes no sense, found only with the arm in place.
    Input(String),
    /// The program or the physics broke down.
    Broken(String),
}

/// Tells of a file of skills.
pub(crate) type DescribeSkills = fn(&Source) -> Result<String, Vec<Diagnostic>>;

/// A kind of task.
#[derive(Clone, Copy, Debug)]
pub struct TaskKind {
    /// Name: the key of its table in a scenario.
    pub name: &'static str,
    /// One line about it.
    pub summary: &'static str,
    /// Path and text of a shipped scenario of this kind, which shows how keys are written.
    pub(crate) example: (&'static str, &'static str),
    /// Key of the scenario that names what the arm holds; `None` if that is not the scenario's choice.
    pub(crate) tool_key: Option<&'static str>,
    /// Reads a scenario of this kind.
    pub(crate) load: Loader,
    /// Tells of a file of skills of this kind in a few words, for lists; `None` if the kind learns nothing.
    pub(crate) skills: Option<DescribeSkills>,
    /// Schema of a scenario of this kind.
    pub(crate) schema: Subschema,
}

impl TaskKind {
    /// A scenario of this kind that shows how keys are written.
    pub(crate) fn example(&self) -> Source {
        let (file, text) = self.example;
        Source::new(file, text)
    }
}

/// The names of all kinds, in their order.
const NAMES: [&str; TASKS.len()] = {
    let mut names = [""; TASKS.len()];
    let mut index = 0;
    while index < TASKS.len() {
        names[index] = TASKS[index].name;
        index += 1;
    }
    names
};

/// The kind that a table `task` names, whatever else it holds.
///
/// Read like an enum with the kinds as variants, so that a missing, unknown or second kind is told like that of any other
/// table.
pub(crate) struct AnyKind(pub &'static TaskKind);

impl<'de> Deserialize<'de> for AnyKind {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_enum("task", &NAMES, KindVisitor)
    }
}

struct KindVisitor;

impl<'de> Visitor<'de> for KindVisitor {
    type Value = AnyKind;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a kind of task")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, kinds: A) -> Result<AnyKind, A::Error> {
        let (name, content): (String, _) = kinds.variant()?;
        content.newtype_variant::<IgnoredAny>()?;
        let kind = TASKS.iter().find(|kind| kind.name == name);
        kind.map(AnyKind).ok_or_else(|| A::Error::unknown_variant(&name, &NAMES))
    }
}

/// A failure of the simulation as that of a stage: the scenario's fault or the program's.
pub(crate) fn broken(error: SimError) -> StageError {
    match error {
        SimError::Field(_) | SimError::Arm { .. } => StageError::Input(error.to_string()),
        other => StageError::Broken(other.to_string()),
    }
}

/// The same, where a plan that is out of reach means that the task cannot be done.
pub(crate) fn infeasible(error: SimError) -> StageError {
    match error {
        SimError::Unreachable { .. } => StageError::Infeasible(error.to_string()),
        // an arm that no plan can lead is the scenario's mistake
        SimError::Robot(RobotError::TooFewJoints { .. } | RobotError::FrameBehindMimic { .. }) => {
            StageError::Input(format!("robot.asset, robot.tool_frame: {error}"))
        }
        other => broken(other),
    }
}
