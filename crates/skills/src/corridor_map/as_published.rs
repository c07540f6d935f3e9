//! The map of Eqs. (16) and (17) with the constants of Eqs. (18)–(20) exactly as printed, for comparison only.
//!
//! As printed the ends are not kept: the second line of k_L stands twice in Eq. (18), a product stands for a difference
//! in Eq. (19), and Δx1 of Eq. (20) is zero for every standing corridor and then replaced by an arbitrary number.

use serde::{Deserialize, Serialize};

use super::{CorridorMap, MotionEnds, check};
use crate::corridor::Bounds;
use crate::error::SkillError;
use crate::field::{FieldError, positive};

/// Options of Eq. (20): the "small enough values" that replace a divisor of zero.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct AsPublished {
    /// σ1, in place of Δx1 = 0, unit of the positions squared; 1e-6 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub sigma1: f64,
    /// σ2, in place of Δx3 + Δx1 = 0, unit of the positions squared; 1e-6 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub sigma2: f64,
}

impl Default for AsPublished {
    fn default() -> Self {
        Self { sigma1: 1e-6, sigma2: 1e-6 }
    }
}

impl AsPublished {
    /// Evaluates Eqs. (18)–(20) for a motion.
    pub(super) fn map(&self, ends: &MotionEnds) -> Result<PublishedMap, SkillError> {
        let MotionEnds { start: x0, goal: g, .. } = *ends;
        let (low0, high0) = (ends.start_bounds.lower.position, ends.start_bounds.upper.position);
        let (low_g, high_g) = (ends.goal_bounds.lower.position, ends.goal_bounds.upper.position);
        let (above0, below0) = ((high0 - x0).ln(), (x0 - low0).ln());
        let (above_g, below_g) = ((high_g - g).ln(), (g - low_g).ln());
        // Eq. (20)
        let or = |value: f64, fallback: f64| if value == 0.0 { fallback } else { value };
        let delta1 = or(high_g * low0 - high0 * low_g, self.sigma1);
        let delta3 = g * (high0 - low0) - x0 * (high_g - low_g);
        let delta2 = or(delta3 + delta1, self.sigma2);
        // Eq. (19), with the product as printed
        let k = -((above_g - below_g) * (high0 - low0) - (above0 * below0) * (high_g - low_g)) / delta2;
        // Eq. (18), with the second line of k_L twice as printed
        let high_bracket = low0 * above_g + low_g * below0 - low0 * below_g - low_g * above0;
        let low_bracket =
            high0 * above_g + high_g * below0 - high0 * below_g - high_g * below0 - high0 * below_g - high_g * above0;
        let k_high = (low0 * g - low_g * x0) / delta1 + high_bracket / (k * delta1);
        let k_low = (high0 * g - high_g * x0) / -delta1 - low_bracket / (k * delta1);
        for (argument, found) in [("k", k), ("k_high", k_high), ("k_low", k_low)] {
            let expected = "a finite value of Eqs. (18)-(20), which needs both ends strictly inside their bounds";
            check(argument, found, found.is_finite(), expected)?;
        }
        Ok(PublishedMap { k, k_high, k_low })
    }

    /// Checks the options.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("sigma1", self.sigma1)?;
        positive("sigma2", self.sigma2)
    }
}

/// Map of Eqs. (16) and (17) with given k, k_H and k_L.
#[derive(Debug, Clone, PartialEq)]
pub struct PublishedMap {
    /// k, one over the unit of the positions.
    pub k: f64,
    /// k_H, without unit.
    pub k_high: f64,
    /// k_L, without unit.
    pub k_low: f64,
}

impl PublishedMap {
    fn offset(&self, bounds: &Bounds) -> f64 {
        self.k_high * bounds.upper.position + self.k_low * bounds.lower.position
    }
}

impl CorridorMap for PublishedMap {
    /// Evaluates x^u = −(1/k)·log((x^H − x)/(x − x^L)) + k_H·x^H + k_L·x^L, Eq. (17); infinite on a bound, NaN outside.
    fn unconstrained(&self, bounds: &Bounds, _progress: f64, x: f64) -> f64 {
        let (lower, upper) = (bounds.lower.position, bounds.upper.position);
        -((upper - x) / (x - lower)).ln() / self.k + self.offset(bounds)
    }

    /// Evaluates x = x^L + (x^H − x^L)/(1 + e^{−k(x^u − (k_H·x^H + k_L·x^L))}), Eq. (16); on a bound where it rounds to
    /// it.
    fn constrained(&self, bounds: &Bounds, _progress: f64, unconstrained: f64) -> f64 {
        let (lower, upper) = (bounds.lower.position, bounds.upper.position);
        lower + (upper - lower) / (1.0 + (-self.k * (unconstrained - self.offset(bounds))).exp())
    }
}
