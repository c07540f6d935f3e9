//! Whether a difference is real.

use serde::{Deserialize, Serialize};

use crate::statistics::{LEVEL, smallest_p};

/// Whether a difference is real.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Its corrected probability is below 5 %.
    Real,
    /// It may be chance.
    NotToldApart,
    /// So few pairs that nothing they could have shown would have been real.
    TooFew,
}

impl Verdict {
    /// The verdict on a corrected probability from `pairs` pairs, in a family of `family` tests.
    pub(super) fn of(corrected_p: f64, pairs: usize, family: usize) -> Self {
        if smallest_p(pairs) * family as f64 >= LEVEL {
            Self::TooFew
        } else if corrected_p < LEVEL {
            Self::Real
        } else {
            Self::NotToldApart
        }
    }

    /// In words.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Real => "real",
            Self::NotToldApart => "not told apart",
            Self::TooFew => "too few",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_pairs_are_too_few_whatever_they_show() {
        // all of five point the same way with a probability of 2/32
        assert_eq!(Verdict::of(0.0625, 5, 1), Verdict::TooFew);
        assert_eq!(Verdict::of(0.03125, 6, 1), Verdict::Real);
        assert_eq!(Verdict::of(0.0625, 6, 2), Verdict::TooFew);
        assert_eq!(Verdict::of(0.05, 20, 2), Verdict::NotToldApart);
        assert_eq!(Verdict::of(1.0, 0, 1), Verdict::TooFew);
    }
}
