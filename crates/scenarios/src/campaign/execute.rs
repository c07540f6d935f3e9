//! Makes the runs of a campaign on all cores, and writes each down the moment it ends.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

use super::{CampaignFolder, FolderError, Journal, Manifest, PlannedRun, Row, Shard};
use crate::assets::Assets;
use crate::pipeline::{Report, RunError};
use crate::scenario::{ResolvedScenario, load_text};
use crate::trials::Status;

/// What came of a run: the outer error says how it crashed.
pub type Attempt = Result<Result<Report, RunError>, String>;

/// How a campaign is carried out.
pub struct Execution<'a> {
    /// Makes one run.
    pub run: &'a (dyn Fn(&ResolvedScenario, u64) -> Attempt + Sync),
    /// Where assets are found.
    pub assets: &'a Assets,
    /// Which runs to make.
    pub shard: Shard,
    /// Number of threads, at least 1.
    pub threads: usize,
    /// Set when no further run is to begin.
    pub stop: &'a AtomicBool,
    /// Told of every row that was written.
    pub each: &'a (dyn Fn(&Row) + Sync),
}

/// What came of carrying out a campaign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Runs of the shard that were done before.
    pub before: usize,
    /// Runs that were made now.
    pub made: usize,
    /// Runs of the shard that are left.
    pub left: usize,
}

/// The scenario of a planned run.
///
/// # Errors
/// In words, if its values make no valid scenario, or if a file that it names was changed or went away since it was
/// planned: every scenario was read then.
pub fn load_run(manifest: &Manifest, run: &PlannedRun, assets: &Assets) -> Result<ResolvedScenario, String> {
    if !run.invalid.is_empty() {
        return Err(format!("its values make no valid scenario: {}", run.invalid.join("; ")));
    }
    let loaded = load_text(&manifest.base.file, &manifest.base.text, &manifest.changes(run), assets);
    let scenario = loaded.map_err(|problems| problems.first().map_or_else(String::new, ToString::to_string))?;
    if super::run_id(&scenario, run.seed)? == run.run_id {
        return Ok(scenario);
    }
    Err("a file that the scenario names is not what it was when the runs were planned; plan them anew".into())
}

/// Makes the runs of a shard that are not done yet, those with the smallest index first.
///
/// # Errors
/// A [`FolderError`] if journals cannot be read, the disk is full, or a run is not what was planned: what was done before
/// stays.
pub fn execute(
    folder: &CampaignFolder,
    manifest: &Manifest,
    execution: &Execution<'_>,
) -> Result<Summary, FolderError> {
    let done = folder.done(manifest)?;
    let mine: Vec<_> = manifest.runs.iter().zip(&done).filter(|(run, _)| execution.shard.holds(run.index)).collect();
    let open: Vec<&PlannedRun> = mine.iter().filter(|(_, done)| !**done).map(|(run, _)| *run).collect();
    let before = mine.len() - open.len();
    if open.is_empty() {
        return Ok(Summary { before, ..Summary::default() });
    }
    let journal = Journal::begin(&folder.journals(), execution.shard)
        .map_err(|source| FolderError::Io { path: folder.journals(), source })?;
    let pool = Pool {
        manifest,
        execution,
        open: &open,
        next: AtomicUsize::new(0),
        writing: Mutex::new(Writing::new(journal)),
    };
    std::thread::scope(|scope| {
        for _ in 0..execution.threads.clamp(1, open.len()) {
            scope.spawn(|| pool.work());
        }
    });
    let Writing { made, failure, .. } = pool.writing.into_inner().unwrap_or_else(|broken| broken.into_inner());
    match failure {
        Some(failure) => Err(failure),
        None => Ok(Summary { before, made, left: open.len() - made }),
    }
}

/// What the threads share.
struct Pool<'a> {
    manifest: &'a Manifest,
    execution: &'a Execution<'a>,
    open: &'a [&'a PlannedRun],
    next: AtomicUsize,
    writing: Mutex<Writing>,
}

/// The journal, and what became of writing to it.
struct Writing {
    journal: Journal,
    made: usize,
    failure: Option<FolderError>,
}

impl Writing {
    fn new(journal: Journal) -> Self {
        Self { journal, made: 0, failure: None }
    }
}

impl Pool<'_> {
    fn work(&self) {
        while !self.execution.stop.load(Ordering::Relaxed) {
            let Some(run) = self.open.get(self.next.fetch_add(1, Ordering::Relaxed)) else { return };
            let row = self.row(run);
            if !self.keep(row) {
                return;
            }
        }
    }

    fn row(&self, run: &PlannedRun) -> Result<Row, FolderError> {
        let started = Instant::now();
        if !run.invalid.is_empty() {
            return Ok(Row::invalid(run, started.elapsed().as_secs_f64()));
        }
        let changed = |reason| FolderError::Changed { index: run.index, reason };
        let scenario = load_run(self.manifest, run, self.execution.assets).map_err(changed)?;
        let result = (self.execution.run)(&scenario, run.seed);
        let wall_s = started.elapsed().as_secs_f64();
        let without = |status, reason| Row::without_outcome(run, status, reason, wall_s);
        Ok(match result {
            Ok(Ok(report)) => Row::of_outcome(run, report.outcome, report.simulated_s, wall_s),
            Ok(Err(error)) if error.is_input => without(Status::Refused, error.to_string()),
            Ok(Err(error)) => without(Status::Crashed, error.to_string()),
            Err(panic) => without(Status::Crashed, panic),
        })
    }

    /// Writes a row down; returns whether there is a point in going on.
    fn keep(&self, row: Result<Row, FolderError>) -> bool {
        let mut writing = self.writing.lock().unwrap_or_else(|broken| broken.into_inner());
        if writing.failure.is_some() {
            return false;
        }
        let kept = row.and_then(|row| match writing.journal.append(&row) {
            Ok(()) => Ok(row),
            Err(source) => Err(FolderError::Io { path: writing.journal.path().to_owned(), source }),
        });
        let row = match kept {
            Ok(row) => row,
            Err(failure) => {
                writing.failure = Some(failure);
                return false;
            }
        };
        writing.made += 1;
        drop(writing);
        (self.execution.each)(&row);
        true
    }
}
