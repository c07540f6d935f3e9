//! Two variants, trial by trial.

use super::Verdict;
use super::result::{Difference, SuccessDifference};
use crate::campaign::Row;
use crate::statistics::{mcnemar, signed_rank};
use crate::trials::Status;

/// Successes of `rows` against those of `first`, seed by seed; not yet corrected.
pub(super) fn successes(variant: usize, first: &[Row], rows: &[Row]) -> SuccessDifference {
    let succeeded = |row: &Row| row.status == Status::Success;
    let count = |of: [bool; 2]| {
        first.iter().zip(rows).filter(|(first, this)| [succeeded(first), succeeded(this)] == of).count()
    };
    let (only_first, only_this) = (count([true, false]), count([false, true]));
    let p = mcnemar(only_first, only_this);
    SuccessDifference {
        variant,
        both: count([true, true]),
        only_first,
        only_this,
        neither: count([false, false]),
        p,
        corrected_p: p,
        verdict: Verdict::NotToldApart,
    }
}

/// The values of a variant less those of the first, for each of `seeds`; not yet corrected.
pub(super) fn difference(variant: usize, first: &[Option<f64>], values: &[Option<f64>], seeds: &[u64]) -> Difference {
    let pairs = || first.iter().zip(values).take(seeds.len());
    let differences: Vec<f64> = pairs().filter_map(|(first, this)| Some((*this)? - (*first)?)).collect();
    let missing = seeds.iter().zip(pairs()).filter(|(_, (first, this))| first.is_none() || this.is_none());
    let test = signed_rank(&differences);
    Difference {
        variant,
        missing_seeds: missing.map(|(seed, _)| *seed).collect(),
        test,
        corrected_p: test.map(|test| test.p),
        verdict: Verdict::TooFew,
        better: None,
    }
}
