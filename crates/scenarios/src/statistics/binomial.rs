//! Shares of successes: their interval, and the test of two of them that were counted on the same trials.

/// Normal quantile of a two-sided 95 % interval.
pub(super) const QUANTILE_95: f64 = 1.959_963_984_540_054;

/// Wilson's 95 % interval of a share of `successes` in `count` (Wilson 1927); the whole range if `count` is zero.
#[must_use]
pub fn wilson(successes: usize, count: usize) -> [f64; 2] {
    if count == 0 {
        return [0.0, 1.0];
    }
    let n = count as f64;
    let share = successes as f64 / n;
    let z2 = QUANTILE_95 * QUANTILE_95;
    let center = share + z2 / (2.0 * n);
    let half = QUANTILE_95 * (share * (1.0 - share) / n + z2 / (4.0 * n * n)).sqrt();
    let scale = 1.0 + z2 / n;
    // a share of exactly 0 or 1 leaves its bound at 0 or 1 but for rounding
    let low = if successes == 0 { 0.0 } else { (center - half) / scale };
    let high = if successes == count { 1.0 } else { (center + half) / scale };
    [low, high]
}

/// Two-sided probability of McNemar's exact test (McNemar 1947): `only_first` trials succeeded under the first
/// treatment alone, `only_second` under the second alone; the others tell nothing.
#[must_use]
pub fn mcnemar(only_first: usize, only_second: usize) -> f64 {
    let count = only_first + only_second;
    (2.0 * fair_at_most(only_first.min(only_second), count)).min(1.0)
}

/// Probability of at most `most` heads in `count` tosses of a fair coin.
pub(super) fn fair_at_most(most: usize, count: usize) -> f64 {
    // logarithms: 2⁻ⁿ alone vanishes beyond a thousand tosses
    let mut log_share = -(count as f64) * std::f64::consts::LN_2;
    let mut sum = log_share.exp();
    for heads in 1..=most.min(count) {
        log_share += ((count - heads + 1) as f64 / heads as f64).ln();
        sum += log_share.exp();
    }
    sum.min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Printed values have four digits.
    const PRINTED: f64 = 5e-5;
    /// Sums of rounded logarithms.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn wilson_agrees_with_published_values() {
        // Newcombe 1998, Table I: 81 of 263, 15 of 148, 0 of 20, 1 of 29
        let expect =
            [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)];
        for (successes, count, low, high) in expect {
            let found = wilson(successes, count);
            assert!((found[0] - low).abs() < PRINTED && (found[1] - high).abs() < PRINTED, "{found:?}");
        }
        assert_eq!(wilson(4, 4)[1], 1.0);
        assert_eq!(wilson(0, 0), [0.0, 1.0]);
    }

    #[test]
    fn mcnemar_agrees_with_scipy() {
        // scipy 1.17.1: binomtest(min(b, c), b + c, 0.5).pvalue
        let expect = [
            (5, 1, 0.21875),
            (10, 2, 0.03857421875),
            (0, 7, 0.015625),
            (25, 11, 0.028816719655878845),
            (59, 6, 4.964650327128616e-12),
        ];
        for (first, second, p) in expect {
            assert!((mcnemar(first, second) - p).abs() < ROUNDING * p.max(1e-3), "{first} {second}");
            assert_eq!(mcnemar(first, second), mcnemar(second, first));
        }
        assert_eq!([mcnemar(0, 0), mcnemar(3, 3)], [1.0, 1.0]);
    }

    #[test]
    fn thousands_of_tosses_do_not_vanish() {
        // scipy 1.17.1: binom.cdf(2400, 5000, 0.5)
        assert!((fair_at_most(2400, 5000) - 0.002_441_824_868_758_747).abs() < ROUNDING);
    }
}
