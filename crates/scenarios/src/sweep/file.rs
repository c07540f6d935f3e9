//! The sweep file as it is written: its tables and keys.

use serde::Deserialize;

use crate::suggest::listed;
use skills::field::FieldError;

use super::factor::{Factor, Values};
use crate::campaign::InvalidPoints;
use crate::scenario::{LARGEST_SEED, check_key, is_in_name};

/// More runs than this in one sweep are a slip of the finger: the manifest alone would take gigabytes.
pub const MOST_RUNS: u64 = 1_000_000;

/// Most factors: as many as the numbers of the Sobol' sequence reach.
const MOST_FACTORS: usize = 100;

/// The key under which a scenario states its seed, which a sweep varies in a way of its own.
const SEED: &str = "scenario.seed";

/// A sweep file.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SweepFile {
    /// What is run, and how often.
    pub sweep: Head,
    /// How the factors' values are combined.
    #[serde(default)]
    pub design: Design,
    /// What is varied.
    #[serde(default, rename = "factor")]
    pub factors: Vec<FactorFile>,
}

/// What is run, and how often.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Head {
    /// Name in results and of their folder; the file's name without its ending if absent.
    pub name: Option<String>,
    /// Scenario file, relative to the sweep file.
    pub scenario: String,
    /// Seeds at each point; the same for all points.
    #[serde(default = "one")]
    pub trials: u64,
    /// The first of them; the scenario's if absent.
    pub first_seed: Option<u64>,
    /// What becomes of a point whose values make no valid scenario; if absent, `refuse` for a grid, whose values were
    /// written by hand, and `record` for designs that draw theirs.
    pub invalid_points: Option<InvalidPoints>,
}

fn one() -> u64 {
    1
}

/// How the values of the factors are combined to points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Design {
    /// Every level of each factor with every level of all others.
    Grid {},
    /// Points drawn independently of each other.
    Random {
        /// Number of points.
        points: u64,
        /// Where the draws come from.
        #[serde(default = "one")]
        seed: u64,
    },
    /// Points of which each factor has one in each of as many equally probable strata as there are points.
    LatinHypercube {
        /// Number of points.
        points: u64,
        /// Where the order of the strata and the places in them come from.
        #[serde(default = "one")]
        seed: u64,
    },
    /// Points of the Sobol' sequence, which fill the space most evenly if their number is a power of two.
    Sobol {
        /// Number of points.
        points: u64,
        /// Where the random shift of the sequence comes from.
        #[serde(default = "one")]
        seed: u64,
    },
}

impl Default for Design {
    fn default() -> Self {
        Self::Grid {}
    }
}

impl Design {
    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Grid {} => "grid",
            Self::Random { .. } => "random",
            Self::LatinHypercube { .. } => "latin_hypercube",
            Self::Sobol { .. } => "sobol",
        }
    }

    /// What becomes of points that make no valid scenario, if the file does not say.
    #[must_use]
    pub fn invalid_points(self) -> InvalidPoints {
        match self {
            Self::Grid {} => InvalidPoints::Refuse,
            Self::Random { .. } | Self::LatinHypercube { .. } | Self::Sobol { .. } => InvalidPoints::Record,
        }
    }

    /// Number of points that it states; `None` for a grid, whose points are counted.
    #[must_use]
    pub fn points(self) -> Option<u64> {
        match self {
            Self::Grid {} => None,
            Self::Random { points, .. } | Self::LatinHypercube { points, .. } | Self::Sobol { points, .. } => {
                Some(points)
            }
        }
    }
}

/// A key that is varied, and over what: exactly one of the optional keys but `levels` is there.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FactorFile {
    /// The key, as for `--set`.
    pub key: String,
    /// These values; equally probable where they are drawn.
    #[schemars(with = "Option<Vec<serde_json::Value>>")]
    pub values: Option<Vec<toml::Value>>,
    /// Any number in a range, all equally probable.
    pub uniform: Option<Range>,
    /// Any number in a range of positive numbers, the logarithms of all equally probable.
    pub log_uniform: Option<Range>,
    /// Any whole number in a range that includes its ends, all equally probable.
    pub integers: Option<IntegerRange>,
    /// A number of a normal distribution.
    pub normal: Option<Normal>,
    /// For the grid: how many values of the range are taken.
    pub levels: Option<u64>,
}

/// A range of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// Its lower end.
    pub min: f64,
    /// Its upper end.
    pub max: f64,
}

/// A range of whole numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IntegerRange {
    /// The smallest.
    pub min: i64,
    /// The largest.
    pub max: i64,
}

/// A normal distribution, cut off at `min` and `max` if they are there.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Normal {
    /// Mean, before anything is cut off.
    pub mean: f64,
    /// Standard deviation, before anything is cut off.
    pub sd: f64,
    /// Nothing is smaller.
    pub min: Option<f64>,
    /// Nothing is larger.
    pub max: Option<f64>,
}

impl Head {
    /// At most one refused value.
    fn refused(&self) -> Option<FieldError> {
        let bad_name = |name: &&String| name.is_empty() || !name.chars().all(is_in_name);
        if let Some(name) = self.name.as_ref().filter(bad_name) {
            return Some(FieldError::new(
                "sweep.name",
                format!("{name:?}"),
                "letters, digits, `_` and `-`, at least one",
            ));
        }
        if self.trials == 0 || self.trials > MOST_RUNS {
            let expected = format!("a whole number from 1 to {MOST_RUNS}");
            return Some(FieldError::new("sweep.trials", self.trials, expected));
        }
        let seed = self.first_seed.filter(|&seed| seed > LARGEST_SEED - (self.trials - 1))?;
        let expected = format!("at most {}, so that the last seed is no larger than {LARGEST_SEED}", {
            LARGEST_SEED - (self.trials - 1)
        });
        Some(FieldError::new("sweep.first_seed", seed, expected))
    }
}

impl SweepFile {
    /// Checks every value; gives the factors, or everything that is wrong.
    ///
    /// # Errors
    /// A [`FieldError`] for each refused value, its field the path from the root of the file.
    pub fn check(&self) -> Result<Vec<Factor>, Vec<FieldError>> {
        let mut refused: Vec<FieldError> = self.sweep.refused().into_iter().collect();
        let mut factors: Vec<Factor> = Vec::new();
        for (index, file) in self.factors.iter().enumerate() {
            let checked = self.factor(file, &factors);
            match checked {
                Ok(factor) => factors.push(factor),
                Err(error) => refused.push(error.within(format!("factor.{index}"))),
            }
        }
        refused.extend(self.refused_counts(&factors));
        if refused.is_empty() { Ok(factors) } else { Err(refused) }
    }

    fn factor(&self, file: &FactorFile, others: &[Factor]) -> Result<Factor, FieldError> {
        check_key(&file.key).map_err(|_| {
            let expected = "a dotted path such as object.mass_kg or tool.asset:mass_kg";
            FieldError::new("key", format!("{:?}", file.key), expected)
        })?;
        if file.key == SEED {
            let expected = "another key: `trials` and `first_seed` in [sweep] say which seeds are run";
            return Err(FieldError::new("key", format!("{:?}", file.key), expected));
        }
        if others.iter().any(|other| other.key == file.key) {
            return Err(FieldError::new("key", "the key of another factor", "each key once"));
        }
        let values = file.checked_values()?;
        let levels = match (self.design, file.levels) {
            (Design::Grid {}, levels) => values.levels(levels)?,
            (_, None) => Vec::new(),
            (design, Some(levels)) => {
                let expected = format!("no levels: the design {} draws its own values", design.name());
                return Err(FieldError::new("levels", levels, expected));
            }
        };
        Ok(Factor { key: file.key.clone(), values, levels })
    }

    /// Too many or too few points, factors, runs.
    fn refused_counts(&self, factors: &[Factor]) -> Option<FieldError> {
        if self.factors.len() > MOST_FACTORS {
            return Some(FieldError::new("factor", self.factors.len(), format!("at most {MOST_FACTORS} factors")));
        }
        let path = format!("design.{}.points", self.design.name());
        let points = match self.design.points() {
            Some(0) => return Some(FieldError::new(path, 0, "at least 1")),
            Some(_) if self.factors.is_empty() => {
                return Some(FieldError::new(path, "no [[factor]]", "at least one factor to draw values of"));
            }
            Some(points) => points,
            None => {
                let counts = factors.iter().map(|factor| factor.levels.len() as u64);
                counts.fold(1, u64::saturating_mul)
            }
        };
        let runs = points.saturating_mul(self.sweep.trials);
        (runs > MOST_RUNS).then(|| {
            let field = if self.design.points().is_some() { path } else { "design".into() };
            FieldError::new(field, format!("{runs} runs"), format!("at most {MOST_RUNS} runs"))
        })
    }
}

impl FactorFile {
    /// The one statement of values that it makes.
    fn checked_values(&self) -> Result<Values, FieldError> {
        const KINDS: [&str; 5] = ["values", "uniform", "log_uniform", "integers", "normal"];
        let stated = [
            self.values.clone().map(Values::list),
            self.uniform.map(Values::uniform),
            self.log_uniform.map(Values::log_uniform),
            self.integers.map(Values::integers),
            self.normal.map(Values::normal),
        ];
        let names: Vec<&str> =
            KINDS.into_iter().zip(&stated).filter(|(_, value)| value.is_some()).map(|(name, _)| name).collect();
        match (names.as_slice(), stated.into_iter().flatten().next()) {
            ([_], Some(values)) => values,
            _ => {
                let found = if names.is_empty() { "no values".to_owned() } else { listed(&names) };
                let last = names.last().copied().unwrap_or("key");
                Err(FieldError::new(last, found, format!("exactly one of {}", listed(&KINDS))))
            }
        }
    }
}
