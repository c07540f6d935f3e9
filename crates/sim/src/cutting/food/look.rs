//! Colors by which a food is drawn.

use serde::{Deserialize, Serialize};
use skills::field::{FieldError, within};

/// Colors of a food: red, green and blue, each 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FoodLook {
    /// Color of the skin or crust.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub skin_rgb: [f64; 3],
    /// Color of the faces of cuts.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub flesh_rgb: [f64; 3],
}

impl Default for FoodLook {
    fn default() -> Self {
        Self { skin_rgb: [0.80, 0.66, 0.40], flesh_rgb: [0.96, 0.90, 0.76] }
    }
}

impl FoodLook {
    /// Checks that every value is one of a color.
    ///
    /// # Errors
    /// A [`FieldError`] naming the color.
    pub fn validate(&self) -> Result<(), FieldError> {
        for (field, color) in [("skin_rgb", self.skin_rgb), ("flesh_rgb", self.flesh_rgb)] {
            color.iter().try_for_each(|value| within(field, *value, 0.0, 1.0))?;
        }
        Ok(())
    }
}
