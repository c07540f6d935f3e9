//! Tool files: what a file states about a tool, and the tool that this makes in the actuator's frame.

use nalgebra::{Isometry2, Vector2};
use serde::{Deserialize, Serialize};

use super::family::ToolFamily;
use super::{ContactSurface, Tool};
use crate::field::{FieldError, finite, within};
use crate::outline::PlacedOutline;

/// What a tool file states: either a family with its lengths, or pieces and surfaces one by one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ToolFile {
    /// Name, as scenarios and reports call it.
    pub name: String,
    /// One line about the tool.
    #[serde(default)]
    pub description: String,
    /// Mass, kg.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass_kg: f64,
    /// Coefficient of friction between the tool and what it pushes.
    #[schemars(range(min = 0.0))]
    pub friction: f64,
    /// Where the tool's own frame lies in the actuator's; both are the same if absent.
    #[serde(default)]
    pub grip: Grip,
    /// Shape by its family.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub family: Option<ToolFamily>,
    /// Convex pieces in the tool's own frame; their union is the tool.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pieces: Vec<PlacedOutline>,
    /// Parts of the outline that may push, in the tool's own frame.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub surfaces: Vec<ContactSurface>,
}

/// How the actuator holds the tool: the pose of the tool's own frame in the actuator's, T_A^T of Sec. IV.A.2.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Grip {
    /// Position of the tool's own origin in the actuator's frame, m.
    pub position_m: [f64; 2],
    /// Rotation of the tool's own frame in the actuator's, rad.
    pub angle_rad: f64,
}

/// A tool is held in reach of its actuator, m; more is a length in millimeters.
const FARTHEST_GRIP_M: f64 = 1.0;

impl Grip {
    /// Returns the pose of the tool's own frame in the actuator's frame.
    #[must_use]
    pub fn actuator_from_tool(&self) -> Isometry2<f64> {
        Isometry2::new(Vector2::from(self.position_m), self.angle_rad)
    }

    /// Checks that the pose is finite and within a meter.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        let [x, y] = self.position_m;
        [x, y].into_iter().try_for_each(|at| within("position_m", at, -FARTHEST_GRIP_M, FARTHEST_GRIP_M))?;
        finite("angle_rad", &[self.angle_rad])
    }
}

impl ToolFile {
    /// Makes the tool, its frame that of the actuator: expands the family and applies the grip.
    ///
    /// # Errors
    /// A [`FieldError`] naming the key of the file at fault, such as `family.hook.throat_m`.
    pub fn tool(&self) -> Result<Tool, FieldError> {
        self.grip.validate().map_err(|error| error.within("grip"))?;
        // a grip moves the shape but cannot spoil it: what is wrong with it is wrong in the tool's own frame
        let own = self.ungripped()?;
        let pose = self.grip.actuator_from_tool();
        let pieces = own.pieces.iter().map(|piece| piece.transformed(&pose)).collect();
        let surfaces = own.surfaces.iter().map(|surface| surface.transformed(&pose)).collect();
        Ok(Tool { pieces, surfaces, ..own })
    }

    /// The tool in its own frame.
    fn ungripped(&self) -> Result<Tool, FieldError> {
        let (pieces, surfaces) = match &self.family {
            None if self.pieces.is_empty() && self.surfaces.is_empty() => {
                return Err(FieldError::new("pieces", "neither pieces nor a family", EITHER));
            }
            None => (self.pieces.clone(), self.surfaces.clone()),
            Some(_) if !self.pieces.is_empty() => {
                return Err(FieldError::new("pieces", "pieces beside a family", EITHER));
            }
            Some(_) if !self.surfaces.is_empty() => {
                return Err(FieldError::new("surfaces", "surfaces beside a family", EITHER));
            }
            Some(family) => {
                family.validate().map_err(|error| error.within("family"))?;
                (family.shape().pieces(), family.shape().surfaces())
            }
        };
        let (name, description) = (self.name.clone(), self.description.clone());
        let tool = Tool { name, description, mass_kg: self.mass_kg, friction: self.friction, pieces, surfaces };
        tool.validate()?;
        Ok(tool)
    }
}

/// The two ways to state a shape.
const EITHER: &str = "either `family`, or `pieces` with `surfaces`";

#[cfg(test)]
#[path = "file_tests.rs"]
mod tests;
