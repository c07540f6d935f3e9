//! The outcome of a run: named measures with units and limits, and a verdict.

use serde::{Deserialize, Serialize};

use crate::scenario::ResolvedScenario;

/// Version of the layout of `outcome.json`; it grows when a field changes its meaning or goes away.
pub const OUTCOME_SCHEMA: &str = "wield.outcome/1";

/// Result of one run, as written to `outcome.json`. Holds no clock time: the same run gives the same bytes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Version of this layout: [`OUTCOME_SCHEMA`].
    pub schema: String,
    /// Name of the scenario: as it states it, or its file's name without the ending.
    pub scenario: String,
    /// Kind of the task.
    pub task: String,
    /// Seed of the run.
    pub seed: u64,
    /// Version of the program.
    pub version: String,
    /// Whether every measure kept its limit.
    pub success: bool,
    /// What went wrong, one sentence per failure; empty on success.
    pub failures: Vec<String>,
    /// The measures; none if nothing was simulated.
    pub measures: Vec<Measure>,
    /// Remarks on demonstrations, controller and plan that a reader should know.
    pub notes: Vec<String>,
    /// Digest of the whole state trajectory, every time step: equal digests, equal runs. Empty if nothing was simulated.
    pub trajectory_digest: String,
}

impl Outcome {
    /// The outcome of a run whose measures are known; failures follow from limits that were missed.
    #[must_use]
    pub fn judged(
        scenario: &ResolvedScenario,
        seed: u64,
        measures: Vec<Measure>,
        mut failures: Vec<String>,
        notes: Vec<String>,
        trajectory_digest: String,
    ) -> Self {
        failures.extend(measures.iter().filter_map(Measure::failure));
        Self {
            schema: OUTCOME_SCHEMA.into(),
            scenario: scenario.name.clone(),
            task: scenario.kind().into(),
            seed,
            version: env!("CARGO_PKG_VERSION").into(),
            success: failures.is_empty(),
            failures,
            measures,
            notes,
            trajectory_digest,
        }
    }

    /// The outcome of a task that cannot be done as stated: nothing was simulated.
    #[must_use]
    pub fn infeasible(scenario: &ResolvedScenario, seed: u64, reason: String) -> Self {
        Self::judged(scenario, seed, Vec::new(), vec![reason], Vec::new(), String::new())
    }
}

/// One number with its unit and, if it is judged, its limit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measure {
    /// Name in snake case with its unit as suffix, unique within an outcome.
    pub name: String,
    /// What it tells, in a few words.
    pub label: String,
    /// The value in `unit`; `null` if it does not exist in this run.
    pub value: Option<f64>,
    /// Unit for people: mm, s, N, 1.
    pub unit: String,
    /// The limit, if the measure decides about success.
    pub limit: Option<Limit>,
    /// Whether the limit was kept; `null` without a limit.
    pub passed: Option<bool>,
}

/// A bound that a measure must keep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Limit {
    /// The value must not be larger.
    AtMost(f64),
    /// The value must not be smaller.
    AtLeast(f64),
}

impl Limit {
    /// Whether `value` keeps the limit; a value that is not a number keeps none.
    #[must_use]
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::AtMost(limit) => value <= limit,
            Self::AtLeast(limit) => value >= limit,
        }
    }
}

impl Measure {
    /// What went wrong, if the measure missed its limit.
    fn failure(&self) -> Option<String> {
        let limit = self.limit.filter(|_| self.passed == Some(false))?;
        let value = self.value.map_or_else(|| "not available".into(), |value| format!("{value:.3} {}", self.unit));
        let bound = match limit {
            Limit::AtMost(bound) => format!("at most {bound}"),
            Limit::AtLeast(bound) => format!("at least {bound}"),
        };
        Some(format!("{} is {value}; expected {bound} {}", self.label, self.unit))
    }

    /// A measure that is reported only.
    #[must_use]
    pub fn reported(name: &str, label: &str, value: impl Into<Option<f64>>, unit: &str) -> Self {
        let value = value.into().filter(|value| value.is_finite());
        Self { name: name.into(), label: label.into(), value, unit: unit.into(), limit: None, passed: None }
    }

    /// A measure that decides about success.
    #[must_use]
    pub fn judged(name: &str, label: &str, value: impl Into<Option<f64>>, unit: &str, limit: Limit) -> Self {
        let measure = Self::reported(name, label, value, unit);
        let passed = measure.value.is_some_and(|value| limit.holds(value));
        Self { limit: Some(limit), passed: Some(passed), ..measure }
    }
}
