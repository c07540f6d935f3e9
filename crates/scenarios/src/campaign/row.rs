//! What one run of a campaign left: a row of its table.

use serde::{Deserialize, Serialize};

use super::{PlannedRun, RunId};
use crate::outcome::{Measure, Outcome};
use crate::trials::Status;

/// One run that ended, however it ended. Holds no clock time but `wall_s`, which takes no part in comparisons and tables.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// Place in the manifest, from 0.
    pub index: u64,
    /// Identity.
    pub run_id: RunId,
    /// Seed.
    pub seed: u64,
    /// How it ended.
    pub status: Status,
    /// What went wrong, one sentence per failure; empty on success.
    pub failures: Vec<String>,
    /// All measures, judged or not; none without an outcome.
    pub measures: Vec<Measure>,
    /// Digest of the state trajectory; `null` if nothing was simulated to its end.
    pub trajectory_digest: Option<String>,
    /// Simulated time, s; 0 without an outcome.
    pub simulated_s: f64,
    /// Version of the program.
    pub version: String,
    /// Clock time that the run took, s.
    pub wall_s: f64,
}

impl Row {
    /// The row of a run that came to an outcome.
    #[must_use]
    pub fn of_outcome(run: &PlannedRun, outcome: Outcome, simulated_s: f64, wall_s: f64) -> Self {
        Self {
            status: if outcome.success { Status::Success } else { Status::Missed },
            measures: outcome.measures,
            trajectory_digest: Some(outcome.trajectory_digest).filter(|digest| !digest.is_empty()),
            simulated_s,
            failures: outcome.failures,
            ..Self::without_outcome(run, Status::Missed, String::new(), wall_s)
        }
    }

    /// The row of a run that came to none, and why.
    #[must_use]
    pub fn without_outcome(run: &PlannedRun, status: Status, reason: String, wall_s: f64) -> Self {
        Self {
            index: run.index,
            run_id: run.run_id.clone(),
            seed: run.seed,
            status,
            failures: vec![reason],
            measures: Vec::new(),
            trajectory_digest: None,
            simulated_s: 0.0,
            version: env!("CARGO_PKG_VERSION").into(),
            wall_s,
        }
    }

    /// The row of a run whose values make no valid scenario, so that it was not made.
    #[must_use]
    pub fn invalid(run: &PlannedRun, wall_s: f64) -> Self {
        let failures = run.invalid.clone();
        Self { failures, ..Self::without_outcome(run, Status::Invalid, String::new(), wall_s) }
    }

    /// Value of a measure.
    #[must_use]
    pub fn value(&self, measure: &str) -> Option<f64> {
        self.measures.iter().find(|candidate| candidate.name == measure)?.value
    }
}

/// Two rows are equal if the runs were: the clock may differ.
impl PartialEq for Row {
    fn eq(&self, other: &Self) -> bool {
        let Self {
            index,
            run_id,
            seed,
            status,
            failures,
            measures,
            trajectory_digest,
            simulated_s,
            version,
            wall_s: _,
        } = self;
        (index, run_id, seed, status) == (&other.index, &other.run_id, &other.seed, &other.status)
            && (failures, measures) == (&other.failures, &other.measures)
            && (trajectory_digest, version) == (&other.trajectory_digest, &other.version)
            && simulated_s.to_bits() == other.simulated_s.to_bits()
    }
}
