//! Numbers of the cutting model that belong neither to the food nor to the knife.

use serde::{Deserialize, Serialize};
use skills::field::{FieldError, finite, positive, within};

/// Resolution and limits of the cutting law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CuttingConfig {
    /// Width of a column of the section and height of a cell of the recorded surface, m.
    #[schemars(range(min = 1e-5, max = 0.005))]
    pub cell_m: f64,
    /// Mass that the arm shows at the knife, kg: stiffness and friction are bounded so that one step cannot reverse it.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub effective_mass_kg: f64,
    /// Mass that a food which is free on its board shows along the edge, kg: it gives way as far as its elasticity and this
    /// mass say. Absent for a food that is held.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub free_food_kg: Option<f64>,
    /// How far the blade bends sideways before the food pushes back, m.
    #[schemars(range(min = 0.0, max = 0.01))]
    pub blade_freedom_m: f64,
    /// Speed below which friction fades out, m/s.
    #[schemars(range(min = 1e-6, max = 0.01))]
    pub creep_speed_m_per_s: f64,
    /// Longest dent that a board leaves, as a multiple of the edge's height above it.
    #[schemars(range(min = 0.1, max = 10.0))]
    pub squeeze_ratio: f64,
}

impl Default for CuttingConfig {
    fn default() -> Self {
        Self {
            cell_m: 0.00025,
            effective_mass_kg: 2.0,
            free_food_kg: None,
            blade_freedom_m: 0.001,
            creep_speed_m_per_s: 0.001,
            squeeze_ratio: 1.0,
        }
    }
}

impl CuttingConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("cell_m", self.cell_m, 1e-5, 0.005)?;
        positive("effective_mass_kg", self.effective_mass_kg)?;
        self.free_food_kg.map_or(Ok(()), |mass_kg| positive("free_food_kg", mass_kg))?;
        within("blade_freedom_m", self.blade_freedom_m, 0.0, 0.01)?;
        within("creep_speed_m_per_s", self.creep_speed_m_per_s, 1e-6, 0.01)?;
        within("squeeze_ratio", self.squeeze_ratio, 0.1, 10.0)
    }
}

/// Surface of the board, as a line in the section's plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Board {
    /// Depth y of the surface at x = 0, m.
    pub y_m: f64,
    /// Slope dy/dx of the surface.
    pub slope: f64,
}

impl Board {
    /// A board square to the cutting direction at depth `y_m`.
    #[must_use]
    pub fn level(y_m: f64) -> Self {
        Self { y_m, slope: 0.0 }
    }

    /// Depth of the surface at `x`, m.
    #[must_use]
    pub fn depth_at(&self, x: f64) -> f64 {
        self.y_m + self.slope * x
    }

    /// Checks that both numbers are finite.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("y_m", &[self.y_m])?;
        finite("slope", &[self.slope])
    }
}
