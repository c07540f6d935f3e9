//! What a candidate costs: how often its runs fail, and what its measure sums up to.

use serde::{Deserialize, Serialize};
use skills::field::FieldError;

use crate::campaign::Row;
use crate::trials::Status;

/// Cost of a run that fails, beside which every measure is small. Finite, since the search sorts costs.
const FAILURE: f64 = 1e9;

/// What the measures of several seeds are summed up to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Aggregate {
    /// Their mean.
    #[default]
    Mean,
    /// The worst of them.
    Worst,
    /// A value that this share of them does not exceed, 0 to 1, by linear interpolation.
    Quantile(f64),
}

impl Aggregate {
    pub(super) fn refused(self) -> Option<FieldError> {
        match self {
            Self::Quantile(share) if !(0.0..=1.0).contains(&share) => {
                Some(FieldError::new("quantile", share, "a number from 0 to 1"))
            }
            _ => None,
        }
    }

    /// Sums up costs; `None` for none.
    #[must_use]
    pub fn of(self, mut costs: Vec<f64>) -> Option<f64> {
        costs.sort_by(f64::total_cmp);
        let last = costs.len().checked_sub(1)?;
        match self {
            Self::Mean => Some(costs.iter().sum::<f64>() / costs.len() as f64),
            Self::Worst => costs.last().copied(),
            Self::Quantile(share) => {
                let place = share * last as f64;
                let low = costs.get(place.floor() as usize)?;
                let high = costs.get(place.ceil() as usize)?;
                Some(low + (high - low) * place.fract())
            }
        }
    }
}

/// The cost of a candidate by its rows: `sign` is 1 for a measure that is to be small, −1 for one that is to be large.
///
/// A candidate of which more runs fail is worse, whatever the measure of the others says.
pub(super) fn cost(rows: &[Row], measure: &str, sign: f64, aggregate: Aggregate) -> f64 {
    let failed = rows.iter().filter(|row| row.status != Status::Success).count();
    let values = rows.iter().filter_map(|row| row.value(measure)).map(|value| sign * value).collect();
    let share = failed as f64 / rows.len().max(1) as f64;
    FAILURE * share + aggregate.of(values).unwrap_or(FAILURE).clamp(-FAILURE, FAILURE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn aggregates_are_those_of_the_textbook() {
        let values = || vec![4.0, 1.0, 3.0, 2.0];
        assert_eq!(Aggregate::Mean.of(values()), Some(2.5));
        assert_eq!(Aggregate::Worst.of(values()), Some(4.0));
        assert_eq!(Aggregate::Quantile(0.5).of(values()), Some(2.5));
        assert_eq!(Aggregate::Quantile(1.0).of(values()), Some(4.0));
        assert_eq!(Aggregate::Mean.of(Vec::new()), None);
    }
}
