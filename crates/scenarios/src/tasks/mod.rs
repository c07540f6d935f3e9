//! Tasks: what is to be done, and how well it was done. A task is one file (or folder) and its lines here.

mod demonstrations;
mod push;

use nalgebra::Isometry2;
use serde::{Deserialize, Serialize};
use sim::planar::Observer;
use skills::field::FieldError;

pub use demonstrations::{DEMONSTRATIONS_SCHEMA, DemonstrationTrial, DemonstrationsReport, ShownTrial};
pub use push::PushConfig;
pub(crate) use push::{CarriedOut, read_demonstration};

use crate::outcome::Outcome;
use crate::pipeline::{Progress, Report, RunError, learn_task, run_task};
use crate::scenario::{ResolvedScenario, SkillsFile};

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
            "tasks of this kind have no synthetic human; expected one that has; name files in [demonstrations.recorded]"
                .into(),
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
    /// A [`StageError`] if skills of this kind cannot be kept.
    fn save(&self, skills: &Self::Skills) -> Result<SkillsFile, StageError> {
        let _ = skills;
        Err(StageError::Input(
            "skills of tasks of this kind cannot be kept in a file; expected a task that can, such as push".into(),
        ))
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
    fn simulate(&self, plan: &Self::Plan, observer: &mut dyn Observer) -> Result<Self::Episode, StageError>;

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

/// A place at which the object is to stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    /// Dotted path of the scenario's key that names it.
    pub key: &'static str,
    /// Pose of the object there.
    pub world_from_object: Isometry2<f64>,
}

impl Stand {
    /// The place that `key` names, world frame, m and rad.
    #[must_use]
    pub fn new(key: &'static str, position_m: [f64; 2], angle_rad: f64) -> Self {
        Self { key, world_from_object: Isometry2::new(position_m.into(), angle_rad) }
    }
}

/// What is to be done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum TaskConfig {
    /// Push an object over a table to a goal.
    Push(PushConfig),
}

/// A kind of task, as `wield list tasks` shows it.
#[derive(Clone, Copy, Debug)]
pub struct TaskKind {
    /// Name: the key of its table in a scenario.
    pub name: &'static str,
    /// One line about it.
    pub summary: &'static str,
}

/// All kinds of tasks.
pub const TASKS: &[TaskKind] =
    &[TaskKind { name: "push", summary: "push an object over a table to a goal, past obstacles, with a tool" }];

/// Runs a scenario with its task.
pub(crate) fn dispatch(
    scenario: &ResolvedScenario,
    seed: u64,
    observer: &mut dyn Observer,
    progress: Progress<'_>,
) -> Result<Report, RunError> {
    match &scenario.scenario.task {
        TaskConfig::Push(config) => {
            run_task(&push::PushTask::new(scenario, config, seed), scenario, seed, observer, progress)
        }
    }
}

/// Carries a push out and keeps what came up on the way.
pub(crate) fn carry_out(scenario: &ResolvedScenario, seed: u64) -> Result<CarriedOut, StageError> {
    match &scenario.scenario.task {
        TaskConfig::Push(config) => push::carry_out(&push::PushTask::new(scenario, config, seed)),
    }
}

/// Learns what a scenario's demonstrations show.
pub(crate) fn learn(
    scenario: &ResolvedScenario,
    seed: u64,
    progress: Progress<'_>,
) -> Result<Result<SkillsFile, String>, RunError> {
    match &scenario.scenario.task {
        TaskConfig::Push(config) => learn_task(&push::PushTask::new(scenario, config, seed), progress),
    }
}

/// Lets the synthetic human of a scenario show its task.
pub(crate) fn show(
    scenario: &ResolvedScenario,
    seed: u64,
    count: Option<usize>,
    progress: Progress<'_>,
    each: &mut dyn FnMut(ShownTrial) -> Result<(), StageError>,
) -> Result<(), StageError> {
    match &scenario.scenario.task {
        TaskConfig::Push(config) => push::PushTask::new(scenario, config, seed).show(count, progress, each),
    }
}

impl TaskConfig {
    /// The kind's name: the key of its table in a scenario.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Push(_) => "push",
        }
    }

    /// Where the task puts the object, so that a place inside an obstacle is refused before anything runs.
    #[must_use]
    pub fn stands(&self) -> Vec<Stand> {
        match self {
            Self::Push(push) => push.stands(),
        }
    }

    /// Checks the task's numbers on their own.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::Push(push) => push.validate().map_err(|error| error.within("push")),
        }
    }
}
