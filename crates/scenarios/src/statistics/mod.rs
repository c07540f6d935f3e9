//! Statistics of experiments: what many trials say together, and how sure one can be of it.
//!
//! Nothing here assumes a distribution: medians with order statistics, paired differences by ranks, shares by the
//! binomial. Intervals are two-sided with a confidence of at least 95 %.

mod binomial;
mod holm;
mod location;
mod signed_rank;
mod walsh;

pub use binomial::{mcnemar, wilson};
pub use holm::holm;
pub use location::{Location, quantile};
pub use signed_rank::{LARGEST_EXACT, SignedRank, signed_rank};

/// Share of cases in which an interval may miss the true value, and in which a test may see what is not there.
pub const LEVEL: f64 = 0.05;

/// Smallest probability that a paired test of `pairs` pairs can arrive at: all of them point the same way, 2 · 2⁻ⁿ.
#[must_use]
pub fn smallest_p(pairs: usize) -> f64 {
    (2.0 * 0.5_f64.powf(pairs as f64)).min(1.0)
}
