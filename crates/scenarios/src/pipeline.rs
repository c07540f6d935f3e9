//! The whole run on one screen: demonstrations, skills, plan, episode, outcome.

use std::time::Instant;

use sim::{planar, spatial};

use crate::outcome::Outcome;
use crate::scenario::{KeptSkills, ResolvedScenario};
use crate::tasks::{ShownTrial, StageError, Task};

/// What a run leaves behind.
#[derive(Clone, Debug)]
pub struct Report {
    /// The outcome, free of clock time.
    pub outcome: Outcome,
    /// Clock time of each stage of the run, s, in the order in which they ran.
    pub timings_s: Vec<(&'static str, f64)>,
    /// Simulated time of the execution, s.
    pub simulated_s: f64,
}

/// Why a run could not be judged at all.
#[derive(Debug, thiserror::Error)]
#[error("{stage}: {reason}")]
pub struct RunError {
    /// Stage that failed: demonstrate, learn, plan, simulate.
    pub stage: &'static str,
    /// What happened, what was expected, what to do.
    pub reason: String,
    /// Whether the scenario is at fault, rather than the program or the physics.
    pub is_input: bool,
}

/// Told of a run's progress: stage, share done in [0, 1] if it is known.
pub type Progress<'a> = &'a dyn Fn(&'static str, Option<f64>);

/// Who looks on while a task is carried out, be its world plane or spatial: whoever observes both.
pub trait Onlooker: planar::Observer + spatial::Observer {}

impl<O: planar::Observer + spatial::Observer> Onlooker for O {}

/// Runs a scenario from its demonstrations to its outcome.
///
/// # Errors
/// A [`RunError`] if the run crashed or diverged; a task that misses its limits is an outcome, not an error.
pub fn run(
    scenario: &ResolvedScenario,
    seed: u64,
    observer: &mut dyn Onlooker,
    progress: Progress<'_>,
) -> Result<Report, RunError> {
    scenario.task.part().start(scenario, seed).run(scenario, seed, observer, progress)
}

/// Learns what a scenario's demonstrations show, and goes no further.
///
/// Returns why nothing could be learned, if so.
///
/// # Errors
/// A [`RunError`] if the scenario is at fault or the physics broke down.
pub fn learn(
    scenario: &ResolvedScenario,
    seed: u64,
    progress: Progress<'_>,
) -> Result<Result<KeptSkills, String>, RunError> {
    scenario.task.part().start(scenario, seed).learn(progress)
}

/// Lets the synthetic human of a scenario show its task until `count` trials succeeded, as many as the scenario wants if
/// absent. Every trial, failed ones too, is handed to `each`, whose error ends the show.
///
/// Returns why fewer trials succeeded than wanted, if so.
///
/// # Errors
/// A [`RunError`] if there is no synthetic human, if the physics broke down, or if `each` fails.
pub fn demonstrate(
    scenario: &ResolvedScenario,
    seed: u64,
    count: Option<usize>,
    progress: Progress<'_>,
    each: &mut dyn FnMut(ShownTrial) -> Result<(), String>,
) -> Result<Option<String>, RunError> {
    const STAGE: &str = "demonstrate";
    progress(STAGE, None);
    let task = scenario.task.part().start(scenario, seed);
    match task.show(count, progress, &mut |trial| each(trial).map_err(StageError::Broken)) {
        Ok(()) => Ok(None),
        Err(StageError::Infeasible(reason)) => Ok(Some(reason)),
        Err(StageError::Input(reason)) => Err(RunError { stage: STAGE, reason, is_input: true }),
        Err(StageError::Broken(reason)) => Err(RunError { stage: STAGE, reason, is_input: false }),
    }
}

/// Runs one task's five verbs.
pub(crate) fn run_task<T: Task>(
    task: &T,
    scenario: &ResolvedScenario,
    seed: u64,
    observer: &mut dyn Onlooker,
    progress: Progress<'_>,
) -> Result<Report, RunError> {
    let mut clock = Stages { timings_s: Vec::new(), at: "", progress };
    let mut simulated_s = 0.0;
    let mut verbs = || {
        let shown = clock.stage("demonstrate", || task.demonstrations(progress))?;
        let skills = clock.stage("learn", || task.learn(&shown))?;
        let plan = clock.stage("plan", || task.plan(&skills))?;
        let episode = clock.stage("simulate", || task.simulate(&plan, observer))?;
        simulated_s = T::simulated_s(&episode);
        clock.stage("judge", || Ok(task.judge(&shown, &skills, &plan, &episode)))
    };
    let outcome = match verbs() {
        Ok(outcome) => outcome,
        Err(StageError::Infeasible(reason)) => Outcome::infeasible(scenario, seed, reason),
        Err(StageError::Input(reason)) => return Err(RunError { stage: clock.at, reason, is_input: true }),
        Err(StageError::Broken(reason)) => return Err(RunError { stage: clock.at, reason, is_input: false }),
    };
    Ok(Report { outcome, timings_s: clock.timings_s, simulated_s })
}

/// Runs the verbs of a task up to learning.
pub(crate) fn learn_task<T: Task>(task: &T, progress: Progress<'_>) -> Result<Result<KeptSkills, String>, RunError> {
    let mut clock = Stages { timings_s: Vec::new(), at: "", progress };
    let mut verbs = || {
        let shown = clock.stage("demonstrate", || task.demonstrations(progress))?;
        clock.stage("learn", || task.save(&shown, &task.learn(&shown)?))
    };
    match verbs() {
        Ok(skills) => Ok(Ok(skills)),
        Err(StageError::Infeasible(reason)) => Ok(Err(reason)),
        Err(StageError::Input(reason)) => Err(RunError { stage: clock.at, reason, is_input: true }),
        Err(StageError::Broken(reason)) => Err(RunError { stage: clock.at, reason, is_input: false }),
    }
}

/// Times each stage and names it in errors.
struct Stages<'a> {
    timings_s: Vec<(&'static str, f64)>,
    at: &'static str,
    progress: Progress<'a>,
}

impl Stages<'_> {
    fn stage<T>(&mut self, name: &'static str, work: impl FnOnce() -> Result<T, StageError>) -> Result<T, StageError> {
        self.at = name;
        (self.progress)(name, None);
        let begun = Instant::now();
        let result = work();
        self.timings_s.push((name, begun.elapsed().as_secs_f64()));
        result
    }
}
