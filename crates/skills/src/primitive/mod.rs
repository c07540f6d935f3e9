//! Movement primitives: the contract of what can be rolled out, and the list of kinds that can be learned.
//!
//! A further kind is one file with an implementation of [`MovementPrimitive`], and its lines in this one.

mod dmp;
pub mod generalizing;
pub mod kernelized;
pub mod pose;
mod retiming;
mod rollout;
mod saved;

use std::fmt;

use serde::{Deserialize, Serialize};

pub use dmp::{Dmp, DmpConfig, DmpForm, DmpPair, DmpStepper, SavedDmp, rollout_pair};
pub use generalizing::{Generalizing, GeneralizingConfig};
pub use kernelized::{Kernelized, KernelizedConfig};
pub use retiming::MotionLimits;
pub use rollout::{Rollout, RolloutRequest};
pub use saved::{RestoreError, SavedPrimitive};

use crate::error::SkillError;
use crate::field::FieldError;
use crate::trajectory::Trajectory;

/// Learned motion that can be rolled out to another start, goal and duration.
///
/// Contract: a rollout begins exactly at the requested start, tends to the goal, and is a pure function of the primitive
/// and the request.
pub trait MovementPrimitive: fmt::Debug + Send + Sync {
    /// Returns the number d of coordinates.
    fn dimension(&self) -> usize;

    /// Rolls the primitive out to the requested start, goal and duration.
    ///
    /// # Errors
    /// If the request has another dimension, a value that is not finite, or a duration or step outside its range.
    fn rollout(&self, request: &RolloutRequest) -> Result<Rollout, SkillError>;

    /// Copies what defines the primitive into plain data; what is restored of it rolls out to the same bits.
    fn saved(&self) -> SavedPrimitive;
}

/// Kinds of movement primitive, as a table in a file: `[primitive.dmp]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PrimitiveConfig {
    /// Dynamic movement primitive, Eqs. (1)–(5).
    Dmp(DmpConfig),
    /// Kernelized movement primitive.
    Kernelized(KernelizedConfig),
    /// Dynamic movement primitives mixed for the task by rules chosen from the demonstrations.
    Generalizing(GeneralizingConfig),
}

impl Default for PrimitiveConfig {
    fn default() -> Self {
        Self::Dmp(DmpConfig::default())
    }
}

impl PrimitiveConfig {
    /// Checks the options of the kind.
    ///
    /// # Errors
    /// A [`FieldError`] with a field such as `dmp.bases`.
    pub fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::Dmp(config) => config.validate().map_err(|error| error.within("dmp")),
            Self::Kernelized(config) => config.validate().map_err(|error| error.within("kernelized")),
            Self::Generalizing(config) => config.validate().map_err(|error| error.within("generalizing")),
        }
    }

    /// Learns a primitive of this kind from one or more demonstrations of equal dimension.
    ///
    /// # Errors
    /// If the options are invalid, there is no demonstration, the dimensions differ, or the fit fails.
    pub fn learn(&self, demonstrations: &[Trajectory]) -> Result<Box<dyn MovementPrimitive>, SkillError> {
        self.validate()?;
        match self {
            Self::Dmp(config) => Ok(Box::new(Dmp::learn(config, demonstrations)?)),
            Self::Kernelized(config) => Ok(Box::new(Kernelized::learn(config, demonstrations)?)),
            Self::Generalizing(config) => Ok(Box::new(Generalizing::learn(config, demonstrations)?)),
        }
    }
}
