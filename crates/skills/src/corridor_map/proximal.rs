//! The proximal map x^u = x + S·W·ℓ_δ(p) + b: the position, pushed back by a log-barrier where a bound is near.
//!
//! Not in the paper. A person who reacts to a bound only when it is near has x^u = x elsewhere; Eq. (17) bends the
//! whole width of the corridor.

use serde::{Deserialize, Serialize};

use super::{LogitFamily, MotionEnds};
use crate::error::SkillError;
use crate::field::{FieldError, within};

/// Options of the proximal map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Proximal {
    /// Strength S of the correction in widths of the corridor, 0.001 to 1; 0.05 by default.
    #[schemars(range(min = 0.001, max = 1.0))]
    pub strength: f64,
}

impl Default for Proximal {
    fn default() -> Self {
        Self { strength: 0.05 }
    }
}

impl Proximal {
    /// Builds the map of a motion.
    pub(super) fn map(&self, ends: &MotionEnds, delta: f64) -> Result<LogitFamily, SkillError> {
        LogitFamily::new(0.0, self.strength, delta, ends)
    }

    /// Checks the options.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("strength", self.strength, 0.001, 1.0)
    }
}
