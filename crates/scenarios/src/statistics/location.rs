//! Where the values of a sample lie: mean, quartiles, and the median with its interval.

use serde::{Deserialize, Serialize};

use super::LEVEL;
use super::binomial::fair_at_most;

/// Where the values of a sample lie.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Location {
    /// Number of values.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Median.
    pub median: f64,
    /// Interval of the median between two order statistics, whose confidence is at least 95 %; `null` below six values,
    /// for which there is none.
    pub median_interval_95: Option<[f64; 2]>,
    /// First and third quartile, [`quantile`].
    pub quartiles: [f64; 2],
    /// Least and greatest value.
    pub range: [f64; 2],
}

impl Location {
    /// Where `values` lie; `None` if there are none, or if one is no finite number.
    #[must_use]
    pub fn of(values: &[f64]) -> Option<Self> {
        if !values.iter().all(|value| value.is_finite()) {
            return None;
        }
        let sorted = sorted(values);
        let (least, greatest) = (*sorted.first()?, *sorted.last()?);
        Some(Self {
            count: sorted.len(),
            // rounding must not carry the mean out of the range
            mean: (values.iter().sum::<f64>() / values.len() as f64).clamp(least, greatest),
            median: quantile(&sorted, 0.5)?,
            median_interval_95: median_interval(&sorted),
            quartiles: [quantile(&sorted, 0.25)?, quantile(&sorted, 0.75)?],
            range: [least, greatest],
        })
    }
}

/// The values in ascending order.
pub(super) fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// Quantile of values in ascending order at `share` from 0 to 1, linear between the values: type 7 of Hyndman and Fan
/// 1996, as R and NumPy compute it. `None` without values.
#[must_use]
pub fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = share.clamp(0.0, 1.0) * last as f64;
    // the place lies from 0 to the last index
    let below = (place.floor() as usize).min(last);
    let (low, high) = (*sorted.get(below)?, *sorted.get((below + 1).min(last))?);
    Some(low + (place - below as f64) * (high - low))
}

/// The narrowest interval between the k-th smallest and the k-th largest value that holds the median with 95 %.
fn median_interval(sorted: &[f64]) -> Option<[f64; 2]> {
    let count = sorted.len();
    // the median lies below the k-th smallest with the probability of fewer than k heads
    let k = (0..count).take_while(|k| 2.0 * fair_at_most(*k, count) <= LEVEL).count();
    Some([*sorted.get(k.checked_sub(1)?)?, *sorted.get(count - k)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_agree_with_numpy() {
        // NumPy: quantile(x, [.25, .5, .75]) = 2.15, 3.3, 4.6; mean 3.5545454545454547
        let found = Location::of(&[2.1, 3.4, 1.9, 5.0, 4.2, 2.8, 3.3, 7.7, 0.4, 2.2, 6.1]).unwrap();
        let values = [found.quartiles[0], found.median, found.quartiles[1], found.mean];
        let expect = [2.15, 3.3, 4.6, 3.554_545_454_545_454_7];
        assert!(values.iter().zip(expect).all(|(a, b)| (a - b).abs() < 1e-14), "{values:?}");
        assert_eq!(found.range, [0.4, 7.7]);
    }

    #[test]
    fn the_median_lies_between_the_order_statistics_of_the_tables() {
        // scipy 1.17.1: k is the number of heads whose binom.cdf(heads, n, 0.5) is at most 0.025
        for (count, k) in [(6, 1), (8, 1), (10, 2), (15, 4), (20, 6), (25, 8), (50, 18), (100, 40), (500, 228)] {
            let values: Vec<f64> = (1..=count).map(f64::from).collect();
            let interval = Location::of(&values).unwrap().median_interval_95.unwrap();
            assert_eq!(interval, [f64::from(k), f64::from(count + 1 - k)], "{count}");
        }
        assert_eq!(Location::of(&[1.0; 5]).unwrap().median_interval_95, None);
    }

    #[test]
    fn what_is_no_sample_lies_nowhere() {
        assert_eq!(Location::of(&[]), None);
        assert_eq!(Location::of(&[1.0, f64::NAN]), None);
        assert_eq!(Location::of(&[3.0]).unwrap().median, 3.0);
    }
}
