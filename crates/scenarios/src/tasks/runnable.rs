//! Tasks of all kinds behind one face, which hides what their verbs hand to one another.

use super::{ShownTrial, StageError, Task};
use crate::pipeline::{Onlooker, Progress, Report, RunError, learn_task, run_task};
use crate::scenario::{KeptSkills, ResolvedScenario};

/// A task of any kind, ready to be run.
pub(crate) trait Runnable {
    /// Runs its five verbs.
    fn run(
        &self,
        scenario: &ResolvedScenario,
        seed: u64,
        observer: &mut dyn Onlooker,
        progress: Progress<'_>,
    ) -> Result<Report, RunError>;

    /// Runs its verbs up to learning.
    fn learn(&self, progress: Progress<'_>) -> Result<Result<KeptSkills, String>, RunError>;

    /// Lets its synthetic human show it.
    fn show(
        &self,
        count: Option<usize>,
        progress: Progress<'_>,
        each: &mut dyn FnMut(ShownTrial) -> Result<(), StageError>,
    ) -> Result<(), StageError>;
}

impl<T: Task> Runnable for T {
    fn run(
        &self,
        scenario: &ResolvedScenario,
        seed: u64,
        observer: &mut dyn Onlooker,
        progress: Progress<'_>,
    ) -> Result<Report, RunError> {
        run_task(self, scenario, seed, observer, progress)
    }

    fn learn(&self, progress: Progress<'_>) -> Result<Result<KeptSkills, String>, RunError> {
        learn_task(self, progress)
    }

    fn show(
        &self,
        count: Option<usize>,
        progress: Progress<'_>,
        each: &mut dyn FnMut(ShownTrial) -> Result<(), StageError>,
    ) -> Result<(), StageError> {
        Task::show(self, count, progress, each)
    }
}
