//! Learned primitives as plain data, to be written to a file and read again.

use serde::{Deserialize, Serialize};

use super::generalizing::SavedGeneralizing;
use super::kernelized::SavedKernelized;
use super::{MovementPrimitive, SavedDmp};
use crate::error::SkillError;

/// Everything that defines a learned primitive; what is restored rolls out to the same bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SavedPrimitive {
    /// Dynamic movement primitive.
    Dmp(SavedDmp),
    /// Kernelized movement primitive.
    Kernelized(SavedKernelized),
    /// Primitive with a generalization that was chosen by leaving demonstrations out.
    Generalizing(SavedGeneralizing),
}

impl SavedPrimitive {
    /// Builds the primitive anew.
    ///
    /// # Errors
    /// If the numbers cannot be those of a learned primitive: of other shapes than they say, out of range or not finite.
    pub fn restore(self) -> Result<Box<dyn MovementPrimitive>, SkillError> {
        Ok(match self {
            Self::Dmp(saved) => Box::new(saved.restore()?),
            Self::Kernelized(saved) => Box::new(saved.restore()?),
            Self::Generalizing(saved) => Box::new(saved.restore()?),
        })
    }
}
