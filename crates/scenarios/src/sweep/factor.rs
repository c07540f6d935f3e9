//! Factors: a key of the scenario and the values that it takes, as levels of a grid or by their distribution.

use nalgebra::ComplexField;
use skills::field::FieldError;
use toml::Value;

use super::file::{IntegerRange, MOST_RUNS, Normal, Range};
use super::normal::{normal_quantile, normal_share};

/// A key that is varied.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// The key, as for `--set`.
    pub key: String,
    /// The values that it can take.
    pub values: Values,
    /// The values that a grid takes; empty for other designs.
    pub levels: Vec<Value>,
}

/// The values that a factor can take, each with its probability.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// These, equally probable.
    List(Vec<Value>),
    /// Any number of a range, equally probable.
    Uniform(Range),
    /// Any number of a range, their logarithms equally probable.
    LogUniform(Range),
    /// Any whole number of a range, equally probable.
    Integers(IntegerRange),
    /// Numbers of a normal distribution between bounds, which may be infinite.
    Normal {
        /// Mean and standard deviation of the whole distribution.
        whole: Normal,
        /// Shares of the whole distribution at which it is cut off.
        shares: [f64; 2],
    },
}

impl Values {
    pub(super) fn list(values: Vec<Value>) -> Result<Self, FieldError> {
        if values.is_empty() {
            return Err(FieldError::new("values", "an empty list", "at least one value"));
        }
        let again = |(index, value): (usize, &Value)| values.iter().take(index).any(|earlier| earlier == value);
        if let Some((index, value)) = values.iter().enumerate().find(|&pair| again(pair)) {
            let field = format!("values.{index}");
            return Err(FieldError::new(field, value, "each value once; for more runs raise `trials` in [sweep]"));
        }
        Ok(Self::List(values))
    }

    pub(super) fn uniform(range: Range) -> Result<Self, FieldError> {
        increasing(range).map_err(|error| error.within("uniform"))?;
        Ok(Self::Uniform(range))
    }

    pub(super) fn log_uniform(range: Range) -> Result<Self, FieldError> {
        if range.min <= 0.0 {
            let expected = "a number greater than 0: smaller ones have no logarithm";
            return Err(FieldError::new("log_uniform.min", range.min, expected));
        }
        increasing(range).map_err(|error| error.within("log_uniform"))?;
        Ok(Self::LogUniform(range))
    }

    pub(super) fn integers(range: IntegerRange) -> Result<Self, FieldError> {
        if range.min < range.max {
            return Ok(Self::Integers(range));
        }
        Err(FieldError::new("integers.max", range.max, format!("a whole number greater than min = {}", range.min)))
    }

    pub(super) fn normal(whole: Normal) -> Result<Self, FieldError> {
        let Normal { mean, sd, min, max } = whole;
        if sd <= 0.0 {
            return Err(FieldError::new("normal.sd", sd, "a number greater than 0"));
        }
        let low = min.map_or(0.0, |min| normal_share((min - mean) / sd));
        let high = max.map_or(1.0, |max| normal_share((max - mean) / sd));
        if low < high {
            return Ok(Self::Normal { whole, shares: [low, high] });
        }
        let field = if max.is_some() { "normal.max" } else { "normal.min" };
        let bound = max.or(min).unwrap_or(mean);
        let expected = "bounds between which some of the distribution lies, min below max";
        Err(FieldError::new(field, bound, expected))
    }

    /// The value below which a share of the distribution lies, for shares strictly between 0 and 1.
    #[must_use]
    pub fn at(&self, share: f64) -> Value {
        match self {
            Self::List(values) => {
                values.get(step(share, values.len())).cloned().unwrap_or_else(|| Value::String(String::new()))
            }
            Self::Uniform(range) => Value::Float(range.between(share)),
            Self::LogUniform(range) => Value::Float(range.between_logarithms(share)),
            Self::Integers(range) => Value::Integer(range.at(share)),
            Self::Normal { whole: Normal { mean, sd, min, max }, shares: [low, high] } => {
                let value = mean + sd * normal_quantile(low + share * (high - low));
                // rounding must not lead out of the bounds
                Value::Float(value.max(min.unwrap_or(f64::MIN)).min(max.unwrap_or(f64::MAX)))
            }
        }
    }

    /// The values that a grid takes: all, or `count` of a range, evenly spaced with its ends; of a normal distribution
    /// the middles of equally probable parts.
    ///
    /// # Errors
    /// A [`FieldError`] of the key `levels`.
    pub(super) fn levels(&self, count: Option<u64>) -> Result<Vec<Value>, FieldError> {
        let refused = |found: String, expected: &str| Err(FieldError::new("levels", found, expected));
        let count = match (self, count) {
            (Self::List(values), None) => return Ok(values.clone()),
            (Self::List(_), Some(count)) => return refused(count.to_string(), "no levels: the values are listed"),
            (Self::Integers(range), None) => range.count(),
            (_, None) => {
                return refused("none".into(), "how many values of the range the grid takes, such as levels = 5");
            }
            (_, Some(count)) => count,
        };
        if !(2..=MOST_RUNS).contains(&count) {
            return refused(count.to_string(), "a whole number of at least 2");
        }
        if let Self::Integers(range) = self {
            if count > range.count() {
                return refused(count.to_string(), &format!("at most {}, the numbers in the range", range.count()));
            }
            return Ok((0..count).map(|index| Value::Integer(range.level(index, count))).collect());
        }
        let last = (count - 1) as f64;
        Ok((0..count)
            .map(|index| match self {
                Self::Normal { .. } => self.at((index as f64 + 0.5) / count as f64),
                Self::LogUniform(range) => Value::Float(range.between_logarithms(index as f64 / last)),
                Self::Uniform(range) => Value::Float(range.between(index as f64 / last)),
                Self::List(_) | Self::Integers(_) => self.at((index as f64 + 0.5) / count as f64),
            })
            .collect())
    }
}

fn increasing(range: Range) -> Result<(), FieldError> {
    if range.min < range.max && (range.max - range.min).is_finite() {
        return Ok(());
    }
    Err(FieldError::new("max", range.max, format!("a number greater than min = {}", range.min)))
}

/// Which of `count` equally probable steps a share falls into.
fn step(share: f64, count: usize) -> usize {
    ((share * count as f64) as usize).min(count.saturating_sub(1))
}

impl Range {
    /// The number at a share of the way from one end to the other; the ends themselves at 0 and 1.
    fn between(self, share: f64) -> f64 {
        let value = self.min * (1.0 - share) + self.max * share;
        value.clamp(self.min, self.max)
    }

    /// The same, on the way of the logarithms.
    fn between_logarithms(self, share: f64) -> f64 {
        if share <= 0.0 {
            return self.min;
        }
        if share >= 1.0 {
            return self.max;
        }
        let logarithm = ComplexField::ln(self.min) * (1.0 - share) + ComplexField::ln(self.max) * share;
        ComplexField::exp(logarithm).clamp(self.min, self.max)
    }
}

impl IntegerRange {
    /// Number of whole numbers in it.
    fn count(self) -> u64 {
        self.max.abs_diff(self.min).saturating_add(1)
    }

    fn at(self, share: f64) -> i64 {
        let offset = ((share * self.count() as f64) as u64).min(self.count() - 1);
        self.min.saturating_add_unsigned(offset)
    }

    /// Level `index` of `count` evenly spaced ones.
    fn level(self, index: u64, count: u64) -> i64 {
        let (steps, width) = (u128::from(count - 1), u128::from(self.max.abs_diff(self.min)));
        let offset = (u128::from(index) * width + steps / 2) / steps;
        self.min.saturating_add_unsigned(u64::try_from(offset).unwrap_or(u64::MAX))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn floats(values: &[Value]) -> Vec<f64> {
        values.iter().filter_map(Value::as_float).collect()
    }

    #[test]
    fn levels_have_the_ends_of_the_range_and_equal_steps() {
        let uniform = Values::uniform(Range { min: 0.03, max: 0.06 }).unwrap();
        let levels = floats(&uniform.levels(Some(4)).unwrap());
        assert_eq!((levels[0], levels[3]), (0.03, 0.06));
        assert!((levels[1] - 0.04).abs() < 1e-16 && (levels[2] - 0.05).abs() < 1e-16, "{levels:?}");
        let decades = Values::log_uniform(Range { min: 0.01, max: 100.0 }).unwrap();
        let levels = floats(&decades.levels(Some(5)).unwrap());
        for (found, expected) in levels.iter().zip([0.01, 0.1, 1.0, 10.0, 100.0]) {
            assert!((found / expected - 1.0).abs() < 1e-14, "{levels:?}");
        }
        assert_eq!((levels[0], levels[4]), (0.01, 100.0));
    }

    #[test]
    fn whole_numbers_are_all_levels_or_evenly_spaced() {
        let range = Values::integers(IntegerRange { min: -1, max: 3 }).unwrap();
        let whole = |levels: Option<u64>| -> Vec<i64> {
            range.levels(levels).unwrap().iter().filter_map(Value::as_integer).collect()
        };
        assert_eq!((whole(None), whole(Some(3))), (vec![-1, 0, 1, 2, 3], vec![-1, 1, 3]));
        assert_eq!(range.levels(Some(6)).unwrap_err().field, "levels");
        // each of the five has a fifth of the shares
        assert_eq!([0.01, 0.19, 0.21, 0.99].map(|share| range.at(share).as_integer()), [-1, -1, 0, 3].map(Some));
    }

    #[test]
    fn a_normal_distribution_keeps_its_bounds_and_its_shape() {
        let (mean, sd) = (2.0, 0.5);
        let whole = Values::normal(Normal { mean, sd, min: None, max: None }).unwrap();
        let at = |values: &Values, share: f64| values.at(share).as_float().unwrap();
        assert!((at(&whole, 0.975) - (mean + sd * 1.959_963_984_540_054)).abs() < 1e-12);
        assert!((at(&whole, 0.5) - mean).abs() < 1e-12);
        // between the mean and infinity: half a normal distribution, whose median is its 75 % quantile
        let half = Values::normal(Normal { mean, sd, min: Some(mean), max: None }).unwrap();
        assert!((at(&half, 0.5) - (mean + sd * 0.674_489_750_196_081_7)).abs() < 1e-12);
        assert!(at(&half, 1e-16) >= mean);
    }

    #[test]
    fn what_is_no_distribution_is_refused_at_its_key() {
        let fields = [
            Values::list(vec![]).unwrap_err().field,
            Values::list(vec![Value::Integer(1), Value::Integer(2), Value::Integer(1)]).unwrap_err().field,
            Values::uniform(Range { min: 1.0, max: 1.0 }).unwrap_err().field,
            Values::uniform(Range { min: f64::MIN, max: f64::MAX }).unwrap_err().field,
            Values::log_uniform(Range { min: 0.0, max: 1.0 }).unwrap_err().field,
            Values::integers(IntegerRange { min: 2, max: 1 }).unwrap_err().field,
            Values::normal(Normal { mean: 0.0, sd: 0.0, min: None, max: None }).unwrap_err().field,
            Values::normal(Normal { mean: 0.0, sd: 1.0, min: Some(2.0), max: Some(1.0) }).unwrap_err().field,
        ];
        let expected = [
            "values",
            "values.2",
            "uniform.max",
            "uniform.max",
            "log_uniform.min",
            "integers.max",
            "normal.sd",
            "normal.max",
        ];
        assert_eq!(fields.each_ref().map(ToString::to_string), expected);
    }

    proptest! {
        #[test]
        fn quantiles_grow_with_the_share_and_stay_in_range(a in 1e-12..1.0_f64, b in 1e-12..1.0_f64) {
            let range = Range { min: 0.2, max: 7.0 };
            let normal = Normal { mean: 0.0, sd: 3.0, min: Some(0.2), max: Some(7.0) };
            for values in [Values::uniform(range), Values::log_uniform(range), Values::normal(normal)] {
                let values = values.unwrap();
                let [low, high] = [a.min(b), a.max(b)].map(|share| values.at(share.min(1.0 - 1e-12)).as_float().unwrap());
                prop_assert!(low <= high && low >= 0.2 && high <= 7.0);
            }
        }
    }
}
