//! The design file as it is written: its tables and keys.

use serde::Deserialize;
use skills::field::{FieldError, finite};

use super::cost::Aggregate;
use crate::scenario::{LARGEST_SEED, check_key, is_in_name};

/// Most seeds of a candidate.
const MOST_TRIALS: u64 = 10_000;
/// Most candidates.
const MOST_EVALUATIONS: usize = 100_000;

/// A design file.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DesignFile {
    /// What is designed, and for what.
    pub design: Head,
    /// What may be changed.
    #[serde(rename = "parameter")]
    pub parameters: Vec<ParameterFile>,
}

/// What is designed, and for what.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Head {
    /// Name of the new asset.
    pub name: String,
    /// Scenario file, relative to the design file.
    pub scenario: String,
    /// Key of the scenario that names the asset which is designed.
    pub asset: String,
    /// Measure that is to be small; or `maximize`.
    pub minimize: Option<String>,
    /// Measure that is to be large; or `minimize`.
    pub maximize: Option<String>,
    /// What the measures of a candidate's seeds are summed up to.
    #[serde(default)]
    pub judged_by: Aggregate,
    /// Seeds of each candidate.
    pub trials: u64,
    /// The first of them; the scenario's if absent.
    pub first_seed: Option<u64>,
    /// Candidates that are tried, the start among them.
    pub evaluations: usize,
    /// Seed of the search.
    #[serde(default = "one")]
    pub seed: u64,
    /// Fresh seeds on which the best is compared with the start.
    #[serde(default = "thirty")]
    pub check_trials: u64,
}

fn one() -> u64 {
    1
}

fn thirty() -> u64 {
    30
}

/// A number that may be changed.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterFile {
    /// Its key in the asset's file.
    pub key: String,
    /// Its smallest value.
    pub min: f64,
    /// Its largest value.
    pub max: f64,
}

impl DesignFile {
    /// Everything that is refused, by the path from the root of the file.
    pub fn refused(&self) -> Vec<FieldError> {
        let parameters = self.parameters.iter().enumerate();
        let of_parameters = parameters.filter_map(|(index, parameter)| {
            let twice = self.parameters.iter().take(index).any(|other| other.key == parameter.key);
            Some(parameter.refused(twice)?.within(format!("parameter.{index}")))
        });
        let head = self.design.refused().map(|error| error.within("design"));
        let none = self.parameters.is_empty().then(|| FieldError::new("parameter", "no parameter", "at least one"));
        head.into_iter().chain(none).chain(of_parameters).collect()
    }
}

impl Head {
    fn refused(&self) -> Option<FieldError> {
        if self.name.is_empty() || !self.name.chars().all(is_in_name) {
            return Some(FieldError::new(
                "name",
                format!("{:?}", self.name),
                "letters, digits, `_` and `-`, at least one",
            ));
        }
        match (&self.minimize, &self.maximize) {
            (Some(_), None) | (None, Some(_)) => {}
            (None, None) => return Some(FieldError::new("minimize", "no measure", "either `minimize` or `maximize`")),
            _ => return Some(FieldError::new("maximize", "both", "either `minimize` or `maximize`")),
        }
        if let Some(error) = self.judged_by.refused() {
            return Some(error.within("judged_by"));
        }
        for (key, value) in [("trials", self.trials), ("check_trials", self.check_trials)] {
            if value == 0 || value > MOST_TRIALS {
                return Some(FieldError::new(key, value, format!("a whole number from 1 to {MOST_TRIALS}")));
            }
        }
        if self.first_seed.is_some_and(|seed| seed > LARGEST_SEED - 2 * MOST_TRIALS) {
            return Some(FieldError::new("first_seed", self.first_seed.unwrap_or_default(), "a smaller number"));
        }
        if self.evaluations == 0 || self.evaluations > MOST_EVALUATIONS {
            let expected = format!("a whole number from 1 to {MOST_EVALUATIONS}");
            return Some(FieldError::new("evaluations", self.evaluations, expected));
        }
        None
    }
}

impl ParameterFile {
    fn refused(&self, twice: bool) -> Option<FieldError> {
        if check_key(&self.key).is_err() || self.key.contains(':') {
            return Some(FieldError::new(
                "key",
                format!("{:?}", self.key),
                "a dotted path in the asset's file, such as mass_kg",
            ));
        }
        if twice {
            return Some(FieldError::new("key", "the key of another parameter", "each key once"));
        }
        if let Err(error) = finite("min", &[self.min]).and_then(|()| finite("max", &[self.max])) {
            return Some(error);
        }
        (self.min >= self.max)
            .then(|| FieldError::new("max", self.max, format!("a number larger than min, {}", self.min)))
    }
}
