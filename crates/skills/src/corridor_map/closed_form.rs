//! The constants of Proposition 1, Eqs. (18)–(20) and (35)–(38), in a form without false singularities.
//!
//! Departs from the paper: k_L is eliminated first, so that Δx1 of Eq. (20), which vanishes for every standing
//! corridor, does not occur; where the claims of Proposition 1 do not hold the M-form is taken instead, and the reason
//! reported.

use serde::{Deserialize, Serialize};

use super::ends::share;
use super::logistic::{extended_logit, inside, logit};
use super::{CorridorMap, MotionEnds, Validity};
use crate::corridor::Bounds;
use crate::field::{FieldError, positive};

/// Map x^u = x^L + k_H·W + ℓ_δ(p)/k, Eq. (17) with k_L = 1 − k_H: one k and one k_H for the whole motion.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalForm {
    inverse_k: f64,
    k_high: f64,
    delta: f64,
}

impl NormalForm {
    /// Solves Eq. (35) for 1/k = (p0 − pg)/(ℓ0/W0 − ℓg/Wg) and k_H = p0 − ℓ0/(kW0), whether or not k > 0 and
    /// 0 < k_H < 1; nothing if an end is within δ of a bound or outside, or if k is zero or infinite.
    ///
    /// Equal shares in equal widths leave k free; the limit of near ones, 1/k = W·p(1 − p), is taken.
    #[must_use]
    pub fn solve(ends: &MotionEnds, delta: f64) -> Option<Self> {
        if !delta_inside(ends, delta) {
            return None;
        }
        let ((p0, pg), (start_width, goal_width)) = (ends.shares(), ends.widths());
        let inverse_k = if p0 == pg && start_width == goal_width {
            start_width * p0 * (1.0 - p0)
        } else {
            (p0 - pg) / (logit(p0) / start_width - logit(pg) / goal_width)
        };
        let map = Self { inverse_k, k_high: p0 - logit(p0) * inverse_k / start_width, delta };
        (inverse_k.is_finite() && inverse_k != 0.0).then_some(map)
    }

    /// Returns k, one over the unit of the positions.
    #[must_use]
    pub fn k(&self) -> f64 {
        1.0 / self.inverse_k
    }

    /// Returns k_H = 1 − k_L.
    #[must_use]
    pub fn k_high(&self) -> f64 {
        self.k_high
    }

    fn offset(&self, bounds: &Bounds) -> f64 {
        let lower = bounds.lower.position;
        lower + self.k_high * (bounds.upper.position - lower)
    }
}

impl CorridorMap for NormalForm {
    fn unconstrained(&self, bounds: &Bounds, _progress: f64, x: f64) -> f64 {
        self.offset(bounds) + extended_logit(share(bounds, x), self.delta) * self.inverse_k
    }

    fn constrained(&self, bounds: &Bounds, _progress: f64, unconstrained: f64) -> f64 {
        inside(bounds, (unconstrained - self.offset(bounds)) / self.inverse_k)
    }
}

/// Options of the closed form: the steepness k·√(W0·Wg) outside which it is not used.
///
/// Between equal widths the steepness is at least 4; a great one squeezes most of the corridor into a small part of
/// x^u.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ClosedForm {
    /// Least steepness, without unit; 1 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub min_steepness: f64,
    /// Greatest steepness, without unit; 40 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub max_steepness: f64,
}

impl Default for ClosedForm {
    fn default() -> Self {
        Self { min_steepness: 1.0, max_steepness: 40.0 }
    }
}

impl ClosedForm {
    /// Solves for the map of a motion, or tells why it is not used.
    pub(super) fn map(&self, ends: &MotionEnds, delta: f64) -> Result<NormalForm, Fallback> {
        if !delta_inside(ends, delta) {
            return Err(Fallback::EndOutside { clearance: ends.clearance(), delta });
        }
        let validity = Validity::of(ends);
        let map = NormalForm::solve(ends, delta).filter(|_| !validity.singular).ok_or(Fallback::Singular)?;
        if validity.reversing {
            return Err(Fallback::Reversing { k: map.k() });
        }
        if validity.offset_outside {
            return Err(Fallback::OffsetOutside { k_high: map.k_high });
        }
        let (start_width, goal_width) = ends.widths();
        let steepness = map.k() * (start_width * goal_width).sqrt();
        if steepness >= self.min_steepness && steepness <= self.max_steepness {
            return Ok(map);
        }
        Err(Fallback::Steepness { steepness, least: self.min_steepness, greatest: self.max_steepness })
    }

    /// Checks the options.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("min_steepness", self.min_steepness)?;
        positive("max_steepness", self.max_steepness)?;
        if self.max_steepness < self.min_steepness {
            let expected = "at least min_steepness";
            return Err(FieldError::new("max_steepness", self.max_steepness, expected));
        }
        Ok(())
    }
}

/// Why the constants of Proposition 1 are not used for a motion, and the M-form is.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Fallback {
    /// An end is on or outside a bound, or nearer to it than the linear margin.
    #[error("an end lies {clearance} widths inside its bounds; expected at least {delta}")]
    EndOutside {
        /// Distance of that end from its nearer bound, in widths.
        clearance: f64,
        /// Linear margin δ, in widths.
        delta: f64,
    },
    /// Start and goal lie at one share of different widths, or k would be zero.
    #[error("start and goal leave k undetermined or zero; expected unequal shares of the width at start and goal")]
    Singular,
    /// The map would turn the coordinate round.
    #[error("k is {k}; expected a positive number")]
    Reversing {
        /// k, one over the unit of the positions.
        k: f64,
    },
    /// The weights of the bounds are no weights.
    #[error("k_H is {k_high}; expected a number between 0 and 1")]
    OffsetOutside {
        /// k_H = 1 − k_L.
        k_high: f64,
    },
    /// The map would be too flat or too steep.
    #[error("k is {steepness} over the width; expected {least} to {greatest}")]
    Steepness {
        /// k·√(W0·Wg).
        steepness: f64,
        /// Least steepness.
        least: f64,
        /// Greatest steepness.
        greatest: f64,
    },
}

// both ends at least δ inside, where the continued logit is the logit
fn delta_inside(ends: &MotionEnds, delta: f64) -> bool {
    let clearance = ends.clearance();
    clearance > 0.0 && clearance >= delta
}

#[cfg(test)]
mod tests {
    use super::*;

    const DELTA: f64 = 0.01;

    fn ends(p0: f64, start_width: f64, pg: f64, goal_width: f64) -> MotionEnds {
        MotionEnds {
            start: p0 * start_width,
            start_bounds: Bounds::still(0.0, start_width),
            goal: pg * goal_width,
            goal_bounds: Bounds::still(0.0, goal_width),
        }
    }

    fn fallback(ends: &MotionEnds) -> Fallback {
        ClosedForm::default().map(ends, DELTA).unwrap_err()
    }

    #[test]
    fn each_reason_to_fall_back_is_reported() {
        assert!(matches!(fallback(&ends(0.0, 1.0, 0.5, 1.0)), Fallback::EndOutside { clearance: 0.0, .. }));
        assert!(matches!(fallback(&ends(0.001, 1.0, 0.5, 1.0)), Fallback::EndOutside { .. }));
        assert!(matches!(fallback(&ends(0.75, 1.0, 0.75, 2.0)), Fallback::Singular));
        assert!(matches!(fallback(&ends(0.75, 1.0, 0.9, 4.0)), Fallback::Reversing { k } if k < 0.0));
        assert!(matches!(fallback(&ends(0.75, 1.0, 0.9, 1.75)), Fallback::OffsetOutside { k_high } if k_high < 0.0));
        assert!(
            matches!(fallback(&ends(0.02, 1.0, 0.021, 1.0)), Fallback::Steepness { steepness, .. } if steepness > 40.0)
        );
    }

    #[test]
    fn equal_shares_of_equal_widths_take_the_tangent() {
        let map = ClosedForm::default().map(&ends(0.5, 2.0, 0.5, 2.0), DELTA).unwrap();
        assert_eq!((map.k(), map.k_high()), (2.0, 0.5));
        let near = NormalForm::solve(&ends(0.8, 2.0, 0.800_001, 2.0), DELTA).unwrap();
        let at = NormalForm::solve(&ends(0.8, 2.0, 0.8, 2.0), DELTA).unwrap();
        assert!((near.k() / at.k() - 1.0).abs() < 1e-5 && (near.k_high() - at.k_high()).abs() < 1e-5);
    }
}
