//! The M-form x^u = M + S·W·ℓ_δ(p) + b: Eq. (17) about the middle M of the corridor, with k in units of its width.
//!
//! Departs from the paper: k = 1/(S·W) follows the width instead of being one number for both ends, and an offset that
//! runs with the minimum-jerk law from one end to the other keeps both; hence no condition on the ends.

use serde::{Deserialize, Serialize};

use super::{LogitFamily, MotionEnds};
use crate::error::SkillError;
use crate::field::{FieldError, within};

/// Options of the M-form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MForm {
    /// Strength S of the logit in widths of the corridor, 0.001 to 1; 1/4 by default, which has slope one in the
    /// middle.
    #[schemars(range(min = 0.001, max = 1.0))]
    pub strength: f64,
}

impl Default for MForm {
    fn default() -> Self {
        Self { strength: 0.25 }
    }
}

impl MForm {
    /// Builds the map of a motion.
    pub(super) fn map(&self, ends: &MotionEnds, delta: f64) -> Result<LogitFamily, SkillError> {
        LogitFamily::new(1.0, self.strength, delta, ends)
    }

    /// Checks the options.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("strength", self.strength, 0.001, 1.0)
    }
}
