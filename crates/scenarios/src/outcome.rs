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
        let with_unit = |value: f64| crate::report::with_unit(Some(value), &self.unit);
        let (bound, text) = match limit {
            Limit::AtMost(bound) => (bound, format!("at most {}", with_unit(bound))),
            Limit::AtLeast(bound) => (bound, format!("at least {}", with_unit(bound))),
        };
        let value = self.value.map(|value| {
            let told = with_unit(value);
            // a value that rounds to its limit is told in full
            let is_told_apart = value == bound || told != with_unit(bound);
            if is_told_apart { told } else { format!("{value} {}", self.unit) }
        });
        let value = value.unwrap_or_else(|| "not available".into());
        Some(format!("{} is {}; expected {text}", self.label, value.trim_end_matches(" 1")))
    }

    /// A measure that is reported only.
    #[must_use]
    pub fn reported(name: &str, label: &str, value: impl Into<Option<f64>>, unit: &str) -> Self {
        // a zero has no sign that tells anything: −0 would be written so
        let value = value.into().filter(|value| value.is_finite()).map(|value| value + 0.0);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_tells_counts_without_decimals_and_numbers_without_the_unit_one() {
        let pieces = Measure::judged("pieces_error", "pieces more or fewer than wanted", 1.0, "1", Limit::AtMost(0.0));
        let told = pieces.failure().expect("missed");
        assert_eq!(told, "pieces more or fewer than wanted is 1; expected at most 0");
        let goal = Measure::judged("goal_error_mm", "distance to goal", 12.345_678, "mm", Limit::AtMost(5.0));
        assert_eq!(goal.failure().expect("missed"), "distance to goal is 12.35 mm; expected at most 5 mm");
        let close = Measure::judged("goal_error_mm", "distance to goal", 5.000_01, "mm", Limit::AtMost(5.0));
        assert_eq!(close.failure().expect("missed"), "distance to goal is 5.00001 mm; expected at most 5 mm");
        let none = Measure::judged("share", "share", None, "1", Limit::AtLeast(0.5));
        assert_eq!(none.failure().expect("missed"), "share is not available; expected at least 0.5");
    }

    #[test]
    fn a_zero_has_no_sign() {
        let spilt = Measure::reported("spilt_g", "mass spilt", -0.0, "g");
        assert_eq!(serde_json::to_string(&spilt.value).expect("a number"), "0.0");
    }
}
