//! Renewing a hold: when steering can do no more from where the object is held, and where it should be held instead.
//!
//! The paper announces in Remark 3 that contact is adjusted in real time where the object's error grows, without a law.
//! In the terms of [`Steering`], with drag d = (1 − κ)/κ: on a face e + d u stays what it is, so that steering towards
//! uᵈ = e/d leaves half of e + d u, and more where the surface ends before uᵈ. If the object is let go and held anew at
//! u = −e/d, on the other side of the surface, e + d u is zero, and rolling fades offset and deviation together.
//!
//! Rules. A hold on a face is spent if the deviation exceeds a limit, the offset has come to a share of uᵈ, and a hold at
//! −e/d, as far as the surface allows it, would leave a deviation that is smaller by at least half of the limit. A hold is
//! leaving, on a face or a bulge, if the contact lies beyond the usable surface by more than a limit; it is renewed at
//! −e/d on a face and in its middle on a bulge, where leaning mends the deviation. In a hollow, which centers the
//! object and could not pass it sideways, no hold is renewed. The hysteresis lies in the place: after a renewal the object
//! must roll across the surface before its hold can be spent again.

use serde::{Deserialize, Serialize};

use super::steering::Steering;
use crate::field::{FieldError, not_negative, positive, within};

/// When a hold is renewed during a push, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct HoldRenewalConfig {
    /// Deviation of the object from its line that is not worth a renewal, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub deviation_m: f64,
    /// Share of the offset wanted by the steering at which a hold counts as spent.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub used_share: f64,
    /// How far beyond its usable surface a contact may get, m.
    #[schemars(range(min = 0.0))]
    pub overhang_m: f64,
    /// How far the tool backs off from the object, m.
    #[schemars(range(min = LEAST_LIFT_M, max = LARGEST_LIFT_M))]
    pub lift_m: f64,
    /// Way of the object to its line's end below which no hold is renewed, m.
    #[schemars(range(min = 0.0))]
    pub least_remaining_m: f64,
    /// Renewals in one push at most; none if zero.
    pub most_per_push: usize,
}

impl Default for HoldRenewalConfig {
    fn default() -> Self {
        Self {
            deviation_m: 0.001,
            used_share: 0.8,
            overhang_m: 0.001,
            lift_m: 0.003,
            least_remaining_m: 0.012,
            most_per_push: 3,
        }
    }
}

/// Shortest way that a tool backs off, m: less than this a tracking error undoes.
const LEAST_LIFT_M: f64 = 0.0005;
/// Longest way that a tool backs off, m.
const LARGEST_LIFT_M: f64 = 0.1;

impl HoldRenewalConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("deviation_m", self.deviation_m)?;
        within("used_share", self.used_share, 0.0, 1.0)?;
        not_negative("overhang_m", self.overhang_m)?;
        within("lift_m", self.lift_m, LEAST_LIFT_M, LARGEST_LIFT_M)?;
        not_negative("least_remaining_m", self.least_remaining_m)
    }
}

impl Steering {
    /// The offset at which the object should be held anew, m; `None` as long as the hold is good.
    #[must_use]
    pub fn renewed_offset_m(&self, config: &HoldRenewalConfig, offset_m: f64, deviation_m: f64) -> Option<f64> {
        let wanted_m = if self.rolls_on_a_face() {
            self.within_room_m(-deviation_m / self.drag)
        } else if self.bulges() {
            0.0
        } else {
            return None;
        };
        let is_leaving = self.overhang_m(offset_m) > config.overhang_m;
        (is_leaving || self.is_spent(config, offset_m, deviation_m, wanted_m)).then_some(wanted_m)
    }

    /// Whether steering has got out of this hold what it can, and would get more out of one at `other_m`.
    fn is_spent(&self, config: &HoldRenewalConfig, offset_m: f64, deviation_m: f64, other_m: f64) -> bool {
        if !self.rolls_on_a_face() || deviation_m.abs() < config.deviation_m {
            return false;
        }
        let wanted_m = self.wanted_offset_m(deviation_m);
        let reached_m = offset_m * wanted_m.signum();
        let left_m = |offset_m: f64| self.deviation_left_m(offset_m, deviation_m).abs();
        reached_m >= config.used_share * wanted_m.abs()
            && left_m(offset_m) - left_m(other_m) >= 0.5 * config.deviation_m
    }

    /// The deviation that is left when steering on a face has come to rest, m.
    fn deviation_left_m(&self, offset_m: f64, deviation_m: f64) -> f64 {
        let kept_m = deviation_m + self.drag * offset_m;
        kept_m - self.drag * self.within_room_m(kept_m / (2.0 * self.drag))
    }
}

#[cfg(test)]
#[path = "renewal_tests.rs"]
mod tests;
