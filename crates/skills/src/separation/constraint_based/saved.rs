//! The constraint-irrelevant skill as plain data, for files.

use serde::{Deserialize, Serialize};

use super::ConstraintBased;
use crate::corridor_map::CorridorMapConfig;
use crate::error::SkillError;
use crate::primitive::{RestoreError, SavedPrimitive};

/// Everything that a [`ConstraintBased`] skill moves by; restored, its motions are equal bit by bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedConstraintBased {
    /// Map between the corridor and the unconstrained coordinate.
    pub map: CorridorMapConfig,
    /// Primitive of Eq. (21).
    pub primitive: SavedPrimitive,
}

impl SavedConstraintBased {
    /// Checks the data and makes a skill of `coordinates` coordinates of them.
    ///
    /// # Errors
    /// A [`RestoreError`] if the map is invalid, or the primitive cannot be built anew or has another dimension.
    pub fn restore(self, coordinates: usize) -> Result<ConstraintBased, RestoreError> {
        self.map.validate().map_err(|error| error.within("map"))?;
        let refused = |source: SkillError| RestoreError::Primitive { path: "primitive".into(), source };
        let primitive = self.primitive.restore().map_err(refused)?;
        let found = primitive.dimension();
        if found != coordinates {
            let operation = "restore primitive";
            return Err(refused(SkillError::Dimension { operation, found, expected: coordinates }));
        }
        Ok(ConstraintBased { primitive, map: self.map, unconstrained: Vec::new(), reports: Vec::new() })
    }
}

impl ConstraintBased {
    /// Returns what the skill moves by, as plain data.
    #[must_use]
    pub fn saved(&self) -> SavedConstraintBased {
        SavedConstraintBased { map: self.map.clone(), primitive: self.primitive.saved() }
    }
}
