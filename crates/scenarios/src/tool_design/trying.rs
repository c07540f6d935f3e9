//! Tries candidates: all seeds of one in parallel, each run kept the moment it ends, none made twice.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use super::DesignTask;
use super::cost::cost;
use crate::assets::Assets;
use crate::assets::stems;
use crate::campaign::{Journal, JournalReader, PlannedRun, Row, RunId, Shard, run_id};
use crate::pipeline::{Report, RunError};
use crate::scenario::{ResolvedScenario, load_text};
use crate::trials::Status;

/// Makes one run; the error of the outer result says how it crashed.
type Run<'a> = &'a (dyn Fn(&ResolvedScenario, u64) -> Result<Result<Report, RunError>, String> + Sync);

/// Tries candidates.
pub struct Trying<'a> {
    task: &'a DesignTask,
    assets: &'a Assets,
    run: Run<'a>,
    stop: &'a AtomicBool,
    journal: Mutex<Journal>,
    known: BTreeMap<RunId, Row>,
    next_index: u64,
}

/// Why no further candidate can be tried.
#[derive(Debug, thiserror::Error)]
pub enum TryingError {
    /// It was asked to stop.
    #[error("interrupted")]
    Stopped,
    /// No run has the measure.
    #[error("no run of the start has the measure `{measure}`; expected one of {known}")]
    NoMeasure {
        /// What was asked for.
        measure: String,
        /// What there is.
        known: String,
    },
    /// The search cannot begin.
    #[error("{0}")]
    Search(String),
    /// What was found out cannot be written down or read.
    #[error("{0}")]
    Io(#[from] io::Error),
}

impl From<String> for TryingError {
    fn from(reason: String) -> Self {
        Self::Search(reason)
    }
}

impl<'a> Trying<'a> {
    /// Goes on with what the journals in `folder` know.
    ///
    /// # Errors
    /// If they cannot be read, or no new one can be begun.
    pub fn begin(
        folder: &Path,
        task: &'a DesignTask,
        assets: &'a Assets,
        run: Run<'a>,
        stop: &'a AtomicBool,
    ) -> io::Result<Self> {
        let mut known = BTreeMap::new();
        for name in stems(folder, "jsonl") {
            let mut reader = JournalReader::open(&folder.join(format!("{name}.jsonl")))?;
            while let Some((_, row)) = reader.next_row()? {
                known.insert(row.run_id.clone(), row);
            }
        }
        let journal = Mutex::new(Journal::begin(folder, Shard::WHOLE)?);
        Ok(Self { task, assets, run, stop, journal, known, next_index: 0 })
    }

    /// The rows of a candidate, one for each seed; why it is none, if its values make no tool.
    ///
    /// # Errors
    /// A [`TryingError`].
    pub fn rows(&mut self, values: &[f64]) -> Result<Result<Vec<Row>, String>, TryingError> {
        let changes = self.task.changes(values);
        let loaded = load_text(&self.task.scenario_file, &self.task.scenario.source, &changes, self.assets);
        let scenario = match loaded {
            Ok(scenario) => scenario,
            Err(problems) => return Ok(Err(problems.first().map_or_else(String::new, ToString::to_string))),
        };
        let (first, count) = self.task.seeds;
        let planned = (first..first + count).zip(self.next_index..).map(|(seed, index)| {
            let run_id = run_id(&scenario, seed).map_err(io::Error::other)?;
            let values = values.iter().map(|&value| toml::Value::Float(value)).collect();
            Ok(PlannedRun { index, run_id, seed, values, invalid: Vec::new() })
        });
        let planned = planned.collect::<io::Result<Vec<PlannedRun>>>()?;
        self.next_index += count;
        let rows: Vec<Result<Row, TryingError>> = planned.par_iter().map(|run| self.row(&scenario, run)).collect();
        let rows = rows.into_iter().collect::<Result<Vec<Row>, TryingError>>()?;
        self.known.extend(rows.iter().map(|row| (row.run_id.clone(), row.clone())));
        Ok(Ok(rows))
    }

    /// What a candidate costs: the smaller, the better.
    #[must_use]
    pub fn cost(&self, rows: &[Row]) -> f64 {
        let sign = if self.task.minimize { 1.0 } else { -1.0 };
        cost(rows, &self.task.measure, sign, self.task.aggregate)
    }

    fn row(&self, scenario: &ResolvedScenario, run: &PlannedRun) -> Result<Row, TryingError> {
        if let Some(row) = self.known.get(&run.run_id) {
            return Ok(row.clone());
        }
        if self.stop.load(Ordering::Relaxed) {
            return Err(TryingError::Stopped);
        }
        let started = Instant::now();
        let result = (self.run)(scenario, run.seed);
        let wall_s = started.elapsed().as_secs_f64();
        let row = match result {
            Ok(Ok(report)) => Row::of_outcome(run, report.outcome, report.simulated_s, wall_s),
            Ok(Err(error)) if error.is_input => Row::without_outcome(run, Status::Refused, error.to_string(), wall_s),
            Ok(Err(error)) => Row::without_outcome(run, Status::Crashed, error.to_string(), wall_s),
            Err(panic) => Row::without_outcome(run, Status::Crashed, panic, wall_s),
        };
        self.journal.lock().unwrap_or_else(|broken| broken.into_inner()).append(&row)?;
        Ok(row)
    }
}
