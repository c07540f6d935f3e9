//! Learned primitives as plain data, to be written to a file and read again.

use serde::{Deserialize, Serialize};

use super::generalizing::SavedGeneralizing;
use super::kernelized::SavedKernelized;
use super::pose::PoseError;
use super::{MovementPrimitive, SavedDmp};
use crate::error::SkillError;
use crate::field::FieldError;

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

/// States why saved skills cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RestoreError {
    /// A value cannot be that of a learned skill; the field is told relative to the saved skill.
    #[error("restore skills: {0}")]
    Field(#[from] FieldError),
    /// A primitive cannot be built anew.
    #[error("restore skills: {path}: {source}")]
    Primitive {
        /// Path of the primitive relative to the saved skill, such as `pushes.0.path`.
        path: String,
        /// What is wrong with it.
        source: SkillError,
    },
    /// A pose primitive cannot be built anew.
    #[error("restore skills: {path}: {source}")]
    Pose {
        /// Path of the primitive relative to the saved skill, such as `plain`.
        path: String,
        /// What is wrong with it.
        source: PoseError,
    },
}

impl RestoreError {
    /// Where the value at fault is, relative to the saved skill.
    #[must_use]
    pub fn path(&self) -> &str {
        match self {
            Self::Field(error) => &error.field,
            Self::Primitive { path, .. } | Self::Pose { path, .. } => path,
        }
    }

    /// The same of a skill that is part of another: `part` is its place in it.
    #[must_use]
    pub fn within(self, part: &str) -> Self {
        let below = |path: String| if path.is_empty() { part.to_owned() } else { format!("{part}.{path}") };
        match self {
            Self::Field(error) => Self::Field(error.within(part)),
            Self::Primitive { path, source } => Self::Primitive { path: below(path), source },
            Self::Pose { path, source } => Self::Pose { path: below(path), source },
        }
    }
}
