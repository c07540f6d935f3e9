//! Food files: what a file states about a food, and the food that this makes.

use serde::{Deserialize, Serialize};
use skills::field::FieldError;

use super::{FoodLook, FoodRange, FoodSample, Shape};
use crate::cutting::geometry::Solid;
use crate::cutting::material::Material;

/// What a food file states.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FoodFile {
    /// Name, as scenarios and reports call it.
    pub name: String,
    /// One line about the food.
    #[serde(default)]
    pub description: String,
    /// Shape by its lengths.
    pub shape: Shape,
    /// What it is made of.
    pub material: Material,
    /// How far specimens differ from what is stated above.
    #[serde(default)]
    pub range: FoodRange,
    /// Colors by which it is drawn.
    #[serde(default)]
    pub look: FoodLook,
}

/// A food: a solid that can be cut, and what it is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Food {
    /// Name, as scenarios and reports call it.
    pub name: String,
    /// Shape in the food's frame, whose z axis points up: the food lies as it would on a board.
    pub solid: Solid,
    /// What it is made of.
    pub material: Material,
    /// Colors by which it is drawn.
    pub look: FoodLook,
}

impl FoodFile {
    /// Makes the food that the file states.
    ///
    /// # Errors
    /// A [`FieldError`] naming the key of the file at fault, such as `shape.banana.diameter_m`.
    pub fn food(&self) -> Result<Food, FieldError> {
        self.specimen(&FoodSample::of(&self.material))
    }

    /// Makes a food that differs from the one stated in size and toughness, such as one drawn by [`FoodRange::draw`].
    ///
    /// # Errors
    /// A [`FieldError`] naming the key of the file at fault, or the value of the sample that cannot be.
    pub fn specimen(&self, sample: &FoodSample) -> Result<Food, FieldError> {
        self.validate()?;
        sample.validate()?;
        let shape = self.shape.scaled(sample.scale);
        let unbuilt = |found| FieldError::new("shape", found, "lengths that make a solid");
        let cells = shape.cells().map_err(unbuilt)?;
        let solid = Solid::from_cells(cells).map_err(unbuilt)?;
        let material = Material { toughness_j_per_m2: sample.toughness_j_per_m2, ..self.material.clone() };
        Ok(Food { name: self.name.clone(), solid, material, look: self.look })
    }

    /// Checks everything that the file states.
    ///
    /// # Errors
    /// A [`FieldError`] naming the key of the file at fault.
    pub fn validate(&self) -> Result<(), FieldError> {
        if self.name.trim().is_empty() {
            return Err(FieldError::new("name", "an empty name", "a name"));
        }
        self.shape.validate().map_err(|error| error.within("shape"))?;
        self.material.validate().map_err(|error| error.within("material"))?;
        self.range.validate(&self.material).map_err(|error| error.within("range"))?;
        self.look.validate().map_err(|error| error.within("look"))
    }
}

#[cfg(test)]
#[path = "file_tests.rs"]
mod tests;
