//! What comes of a comparison, as written to `comparison.json`.

use serde::{Deserialize, Serialize};

use super::Verdict;
use crate::outcome::Limit;
use crate::scenario::Change;
use crate::statistics::{Location, SignedRank};
use crate::trials::Status;

/// Version of the layout of `comparison.json`.
pub const COMPARISON_SCHEMA: &str = "wield.comparison/1";

/// A comparison. Holds no clock time: the same runs give the same bytes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Version of this layout: [`COMPARISON_SCHEMA`].
    pub schema: String,
    /// Version of the program.
    pub version: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Its title.
    pub title: String,
    /// Kind of its task.
    pub task: String,
    /// The seeds, the same for every variant.
    pub seeds: Vec<u64>,
    /// The variants; the others are compared with the first.
    pub variants: Vec<Variant>,
    /// Successes of each further variant against those of the first.
    pub success: Vec<SuccessDifference>,
    /// The measures: those that were judged, and those that were asked for.
    pub measures: Vec<ComparedMeasure>,
}

/// One variant and its trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variant {
    /// What it is called.
    pub name: String,
    /// What makes it: the scenario with these values.
    pub changes: Vec<Change>,
    /// How each seed ended, in the order of the seeds.
    pub statuses: Vec<Status>,
    /// Number of trials that kept all limits.
    pub successes: usize,
    /// Their share.
    pub success_rate: f64,
    /// Wilson's 95 % interval of it.
    pub success_interval_95: [f64; 2],
    /// Trials that tell something of their own: 1 if all are the same run to the last bit.
    pub independent_trials: usize,
    /// The trials that were no success, by seed.
    pub failed: Vec<FailedTrial>,
}

/// A trial that was no success.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailedTrial {
    /// Its seed.
    pub seed: u64,
    /// How it ended.
    pub status: Status,
    /// What went wrong.
    pub failures: Vec<String>,
}

/// Successes of a variant against those of the first, trial by trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SuccessDifference {
    /// Index of the variant.
    pub variant: usize,
    /// Trials in which both succeeded.
    pub both: usize,
    /// Trials in which only the first variant succeeded.
    pub only_first: usize,
    /// Trials in which only this variant succeeded.
    pub only_this: usize,
    /// Trials in which neither succeeded.
    pub neither: usize,
    /// Probability by McNemar's exact test.
    pub p: f64,
    /// The same, corrected by Holm for the number of variants.
    pub corrected_p: f64,
    /// Whether the difference is real.
    pub verdict: Verdict,
}

/// A measure over all variants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparedMeasure {
    /// Name of the measure.
    pub name: String,
    /// What it tells.
    pub label: String,
    /// Unit for people.
    pub unit: String,
    /// What success asked of it.
    pub limit: Limits,
    /// Its values, by variant.
    pub variants: Vec<Spread>,
    /// Each further variant less the first, seed by seed.
    pub differences: Vec<Difference>,
}

/// What success asked of a measure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Limits {
    /// Nothing: the measure was asked for.
    None,
    /// The same of all variants.
    Same(Limit),
    /// Not the same of all variants.
    Various,
}

/// Values of a measure in the trials of one variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The values in the order of the seeds; `null` where the trial has none.
    pub values: Vec<Option<f64>>,
    /// Where they lie; `null` if there are none.
    pub location: Option<Location>,
}

/// A variant less the first, seed by seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// Index of the variant.
    pub variant: usize,
    /// Seeds of which one of the two has no value: they take no part.
    pub missing_seeds: Vec<u64>,
    /// What the differences say; `null` if there is no pair.
    pub test: Option<SignedRank>,
    /// The test's probability, corrected by Holm for the number of variants.
    pub corrected_p: Option<f64>,
    /// Whether the difference is real.
    pub verdict: Verdict,
    /// Whether it is to the better, if it is real and a limit tells what is better.
    pub better: Option<bool>,
}

impl Limits {
    /// The limit, if all variants have the same.
    #[must_use]
    pub fn same(self) -> Option<Limit> {
        match self {
            Self::Same(limit) => Some(limit),
            _ => None,
        }
    }
}
