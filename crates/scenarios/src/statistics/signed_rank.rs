//! Paired differences by ranks: the estimate of Hodges and Lehmann, its interval, and Wilcoxon's signed-rank test.
//!
//! Differences of zero take no part in the test (Wilcoxon 1945), but do in the estimate and its interval. Up to
//! [`LARGEST_EXACT`] differences the test's distribution is exact, also with ties: that of the ranks as they are, over all
//! signs. Beyond, it is the normal one with corrections for ties and continuity.

use serde::{Deserialize, Serialize};

use super::binomial::QUANTILE_95;
use super::location::sorted;
use super::{LEVEL, walsh};

/// Up to this many differences distributions are exact: 2⁵⁰ sign patterns are counted without rounding.
pub const LARGEST_EXACT: usize = 50;

/// What paired differences say.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SignedRank {
    /// Number of differences.
    pub pairs: usize,
    /// Number of differences that are zero.
    pub zeros: usize,
    /// Median of the Walsh averages (Hodges and Lehmann 1963).
    pub estimate: f64,
    /// Its interval between two Walsh averages, whose confidence is at least 95 % (up to the normal approximation beyond
    /// [`LARGEST_EXACT`] pairs); `null` below six pairs, for which there is none.
    pub interval_95: Option<[f64; 2]>,
    /// Two-sided probability of differences at least as lopsided, were the signs a matter of chance.
    pub p: f64,
    /// Whether `p` comes from the exact distribution.
    pub exact: bool,
}

/// What `differences` say; `None` if there are none, or if one is no finite number.
#[must_use]
pub fn signed_rank(differences: &[f64]) -> Option<SignedRank> {
    if !differences.iter().all(|difference| difference.is_finite()) {
        return None;
    }
    let sorted = sorted(differences);
    let mut nonzero: Vec<f64> = sorted.iter().copied().filter(|difference| *difference != 0.0).collect();
    nonzero.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let (ranks, ties) = doubled_ranks(&nonzero);
    let positive: u64 = ranks.iter().zip(&nonzero).filter(|(_, value)| **value > 0.0).map(|(rank, _)| rank).sum();
    let exact = nonzero.len() <= LARGEST_EXACT;
    Some(SignedRank {
        pairs: sorted.len(),
        zeros: sorted.len() - nonzero.len(),
        estimate: walsh::median(&sorted)?,
        interval_95: interval(&sorted),
        p: if exact { exact_p(&ranks, positive) } else { normal_p(nonzero.len(), ties, positive) },
        exact,
    })
}

/// Twice the ranks of the sizes of values in that order, which are whole numbers also where ties share a mean rank; and
/// the sum of t³ − t over groups of t ties.
fn doubled_ranks(by_size: &[f64]) -> (Vec<u64>, f64) {
    let mut ranks = Vec::with_capacity(by_size.len());
    let mut ties = 0.0;
    for group in by_size.chunk_by(|a, b| a.abs() == b.abs()) {
        let (before, size) = (ranks.len() as u64, group.len() as u64);
        ranks.extend(std::iter::repeat_n(2 * before + size + 1, group.len()));
        ties += (size as f64).powi(3) - size as f64;
    }
    (ranks, ties)
}

/// Number of sign patterns for each sum of the ranks with a positive sign.
fn patterns(ranks: &[u64]) -> Vec<f64> {
    let total: u64 = ranks.iter().sum();
    let mut counts = vec![0.0; total as usize + 1];
    if let Some(none) = counts.first_mut() {
        *none = 1.0;
    }
    for rank in ranks {
        let without = counts.clone();
        let shifted = counts.iter_mut().skip(*rank as usize).zip(&without);
        shifted.for_each(|(count, without)| *count += without);
    }
    counts
}

fn exact_p(ranks: &[u64], positive: u64) -> f64 {
    let counts = patterns(ranks);
    // the distribution is symmetric: the shorter tail counts twice
    let tail = positive.min(ranks.iter().sum::<u64>() - positive) as usize;
    let patterns: f64 = counts.iter().take(tail + 1).sum();
    (2.0 * patterns * 0.5_f64.powf(ranks.len() as f64)).min(1.0)
}

fn normal_p(count: usize, ties: f64, doubled_positive: u64) -> f64 {
    let n = count as f64;
    let off = (0.5 * doubled_positive as f64 - n * (n + 1.0) / 4.0).abs();
    let variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ties / 48.0;
    (2.0 * upper_tail((off - 0.5).max(0.0) / variance.sqrt())).min(1.0)
}

/// The interval between the k-th smallest and the k-th largest Walsh average.
fn interval(sorted: &[f64]) -> Option<[f64; 2]> {
    let count = sorted.len();
    let k = if count <= LARGEST_EXACT { exact_rank(count) } else { normal_rank(count) };
    Some([walsh::ordered(sorted, k)?, walsh::ordered(sorted, walsh::count(count) + 1 - k)?])
}

/// Largest k for which fewer than k of the Walsh averages are positive with a probability of at most 2.5 %.
fn exact_rank(count: usize) -> u64 {
    let counts = patterns(&(1..=count as u64).collect::<Vec<_>>());
    let most = 0.5 * LEVEL * 2.0_f64.powf(count as f64);
    let cumulative = counts.iter().scan(0.0, |sum, count| {
        *sum += count;
        Some(*sum)
    });
    cumulative.take_while(|sum| *sum <= most).count() as u64
}

fn normal_rank(count: usize) -> u64 {
    let n = count as f64;
    let half = QUANTILE_95 * (n * (n + 1.0) * (2.0 * n + 1.0) / 24.0).sqrt();
    // beyond fifty values the rank is in the hundreds: the cast cuts its fraction off
    (n * (n + 1.0) / 4.0 + 0.5 - half).max(1.0) as u64
}

/// Probability that a standard normal value is above `z` ≥ 0: series near zero, continued fraction beyond (Abramowitz and
/// Stegun 1964, 26.2.10 and 26.2.14).
fn upper_tail(z: f64) -> f64 {
    let density = (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
    if z > 3.0 {
        return density / (1..=TERMS).rev().fold(z, |below, k| z + f64::from(k) / below);
    }
    let (mut term, mut sum) = (z, z);
    for k in 1..=TERMS {
        term *= z * z / f64::from(2 * k + 1);
        sum += term;
    }
    0.5 - density * sum
}

/// Terms after which series and fraction have converged to rounding.
const TERMS: u32 = 200;

#[cfg(test)]
#[path = "signed_rank_tests.rs"]
mod tests;
