//! The kernelized primitive as plain data, for files.

use serde::{Deserialize, Serialize};

use super::{Kernelized, KernelizedConfig, Reference};
use crate::error::SkillError;
use crate::field::{FieldError, finite, positive};

/// Everything a [`Kernelized`] primitive was learned to; restored, its rollouts are equal bit by bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedKernelized {
    /// Options it was learned with.
    pub config: KernelizedConfig,
    /// Reference distribution of each coordinate.
    pub references: Vec<Reference>,
}

impl SavedKernelized {
    /// Checks the data and solves the primitive of them anew.
    ///
    /// # Errors
    /// If the options are invalid, there is no coordinate, a table has not N rows, a value is not finite, or a covariance
    /// is not positive.
    pub fn restore(self) -> Result<Kernelized, SkillError> {
        self.config.validate()?;
        let operation = "restore primitive";
        if self.references.is_empty() {
            return Err(SkillError::Dimension { operation, found: 0, expected: 1 });
        }
        let count = self.config.references;
        for reference in &self.references {
            for found in [reference.means.len(), reference.covariances.len()] {
                if found != count {
                    let expected = format!("{count}, one per reference point");
                    return Err(SkillError::RowCount { operation, found, expected });
                }
            }
            positive("scale", reference.scale)?;
            finite("means", reference.means.as_flattened())?;
            finite("covariances", reference.covariances.as_flattened())?;
            for [value, both, rate] in &reference.covariances {
                if !(*value > 0.0 && *rate > 0.0 && both * both <= value * rate) {
                    let found = format!("[{value}, {both}, {rate}]");
                    return Err(FieldError::new("covariances", found, "a positive semidefinite covariance").into());
                }
            }
        }
        Kernelized::solve(self.config, self.references)
    }
}

impl Kernelized {
    /// Returns everything that was learned, as plain data.
    #[must_use]
    pub fn saved(&self) -> SavedKernelized {
        SavedKernelized { config: self.config.clone(), references: self.references().cloned().collect() }
    }
}
