//! Trials: the same scenario under several seeds, and what they say together.

use serde::{Deserialize, Serialize};

use crate::outcome::{Limit, Measure, Outcome};
use crate::statistics::wilson;

/// Version of the layout of `trials.json`.
pub const TRIALS_SCHEMA: &str = "wield.trials/1";

/// Result of several trials, as written to `trials.json`. Holds no clock time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrialsReport {
    /// Version of this layout: [`TRIALS_SCHEMA`].
    pub schema: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Version of the program.
    pub version: String,
    /// Number of trials that kept all limits.
    pub successes: usize,
    /// Share of trials that kept all limits, 0 to 1.
    pub success_rate: f64,
    /// Wilson's 95 % interval of the success rate, of the independent trials.
    pub success_interval_95: [f64; 2],
    /// Trials that tell something of their own: 1 if all are the same run to the last bit, as where nothing is drawn from
    /// the seed; else all of them.
    pub independent_trials: usize,
    /// Share of successful trials that was asked for.
    pub min_success: f64,
    /// Mean and worst of each judged measure.
    pub measures: Vec<Summary>,
    /// The trials, by seed.
    pub trials: Vec<Trial>,
}

/// One trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Its seed.
    pub seed: u64,
    /// How it ended.
    pub status: Status,
    /// The judged measures; empty without an outcome.
    pub measures: Vec<Measure>,
    /// What went wrong, one sentence per failure; empty on success.
    pub failures: Vec<String>,
    /// Digest of the state trajectory; `null` if nothing was simulated to its end.
    pub trajectory_digest: Option<String>,
}

/// How a trial ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Every limit was kept.
    Success,
    /// A limit was missed.
    Missed,
    /// The run crashed or diverged.
    Crashed,
    /// The scenario makes no sense with this seed.
    Refused,
    /// The values of its point make no valid scenario: nothing was run.
    Invalid,
}

impl Status {
    /// The word in tables and files.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Success => "success",
            Self::Missed => "missed",
            Self::Crashed => "crashed",
            Self::Refused => "refused",
            Self::Invalid => "invalid",
        }
    }
}

/// A judged measure over all trials that have it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name of the measure.
    pub name: String,
    /// What it tells.
    pub label: String,
    /// Unit for people.
    pub unit: String,
    /// The limit.
    pub limit: Option<Limit>,
    /// Mean; `null` if no trial has a value.
    pub mean: Option<f64>,
    /// The value farthest to the bad side of the limit.
    pub worst: Option<f64>,
    /// Number of trials that have a value.
    pub count: usize,
}

impl Trial {
    /// A trial that came to an outcome.
    #[must_use]
    pub fn of_outcome(outcome: &Outcome) -> Self {
        Self {
            seed: outcome.seed,
            status: if outcome.success { Status::Success } else { Status::Missed },
            measures: outcome.measures.iter().filter(|measure| measure.limit.is_some()).cloned().collect(),
            failures: outcome.failures.clone(),
            trajectory_digest: Some(outcome.trajectory_digest.clone()).filter(|digest| !digest.is_empty()),
        }
    }

    /// A trial that came to no outcome.
    #[must_use]
    pub fn without_outcome(seed: u64, status: Status, reason: String) -> Self {
        Self { seed, status, measures: Vec::new(), failures: vec![reason], trajectory_digest: None }
    }

    /// The first failure, and how many more there are.
    #[must_use]
    pub fn reason(&self) -> String {
        match self.failures.as_slice() {
            [] => String::new(),
            [one] => one.clone(),
            [first, rest @ ..] => format!("{first} (and {} more)", rest.len()),
        }
    }
}

impl TrialsReport {
    /// Sums up trials.
    #[must_use]
    pub fn new(scenario: &str, trials: Vec<Trial>, min_success: f64) -> Self {
        let successes = trials.iter().filter(|trial| trial.status == Status::Success).count();
        let independent = independent(trials.iter().map(|trial| trial.trajectory_digest.as_deref()));
        Self {
            schema: TRIALS_SCHEMA.into(),
            scenario: scenario.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            successes,
            success_rate: if trials.is_empty() { 0.0 } else { successes as f64 / trials.len() as f64 },
            success_interval_95: wilson(successes.min(independent), independent),
            independent_trials: independent,
            min_success,
            measures: summaries(&trials),
            trials,
        }
    }

    /// Whether any trial ended like this.
    #[must_use]
    pub fn any(&self, status: Status) -> bool {
        self.trials.iter().any(|trial| trial.status == status)
    }

    /// Whether the share of successful trials reaches what was asked for.
    #[must_use]
    pub fn success(&self) -> bool {
        self.success_rate >= self.min_success
    }
}

/// How many of some trials, of which the digests of their trajectories are known, tell something of their own: one, if all
/// went alike to the last bit.
#[must_use]
pub fn independent<'a>(digests: impl Iterator<Item = Option<&'a str>>) -> usize {
    let digests: Vec<_> = digests.collect();
    let first = digests.first().copied().flatten();
    let same = first.is_some() && digests.iter().all(|digest| *digest == first);
    if same { 1 } else { digests.len() }
}

/// Runs, and successes among them, that are not one and the same run to the last bit; a run without a digest counts.
#[must_use]
pub fn distinct<'a>(runs: impl Iterator<Item = (Option<&'a str>, Status)>) -> (usize, usize) {
    let mut known = std::collections::BTreeSet::new();
    let first = runs.filter(|(digest, _)| digest.is_none_or(|digest| known.insert(digest)));
    first
        .fold((0, 0), |(count, successes), (_, status)| (count + 1, successes + usize::from(status == Status::Success)))
}

fn summaries(trials: &[Trial]) -> Vec<Summary> {
    let mut known: Vec<&Measure> = Vec::new();
    for measure in trials.iter().flat_map(|trial| &trial.measures) {
        if known.iter().all(|other| other.name != measure.name) {
            known.push(measure);
        }
    }
    known.into_iter().map(|measure| summary(measure, trials)).collect()
}

fn summary(measure: &Measure, trials: &[Trial]) -> Summary {
    let same = trials.iter().flat_map(|trial| &trial.measures).filter(|other| other.name == measure.name);
    let values: Vec<f64> = same.filter_map(|other| other.value).collect();
    let worst = match measure.limit {
        Some(Limit::AtLeast(_)) => values.iter().copied().reduce(f64::min),
        _ => values.iter().copied().reduce(f64::max),
    };
    Summary {
        name: measure.name.clone(),
        label: measure.label.clone(),
        unit: measure.unit.clone(),
        limit: measure.limit,
        mean: (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64),
        worst,
        count: values.len(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_lies_on_the_bad_side() {
        let trial = |seed, error, clearance| Trial {
            seed,
            status: Status::Success,
            measures: vec![
                Measure::judged("error", "error", error, "mm", Limit::AtMost(5.0)),
                Measure::judged("clearance", "clearance", clearance, "mm", Limit::AtLeast(0.0)),
            ],
            failures: vec![],
            trajectory_digest: None,
        };
        let trials =
            vec![trial(1, 1.0, 3.0), trial(2, 3.0, 1.0), Trial::without_outcome(3, Status::Crashed, "boom".into())];
        let report = TrialsReport::new("push", trials, 0.5);
        let found: Vec<_> =
            report.measures.iter().map(|measure| (measure.mean, measure.worst, measure.count)).collect();
        assert_eq!(found, [(Some(2.0), Some(3.0), 2), (Some(2.0), Some(1.0), 2)]);
        assert!(report.any(Status::Crashed) && report.success());
    }

    #[test]
    fn trials_that_are_all_the_same_run_count_as_one() {
        let trial = |seed, digest: &str| Trial {
            seed,
            status: Status::Success,
            measures: vec![],
            failures: vec![],
            trajectory_digest: Some(digest.into()),
        };
        let report = |digests: [&str; 3]| {
            let trials = digests.iter().zip(1..).map(|(digest, seed)| trial(seed, digest)).collect();
            TrialsReport::new("hold", trials, 1.0)
        };
        let (same, own) = (report(["a", "a", "a"]), report(["a", "a", "b"]));
        assert_eq!((same.independent_trials, own.independent_trials), (1, 3));
        assert_eq!((same.success_rate, same.success_interval_95), (1.0, wilson(1, 1)));
        assert_eq!(own.success_interval_95, wilson(3, 3));
    }
}
