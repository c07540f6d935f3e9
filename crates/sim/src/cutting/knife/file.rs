//! Knife files: what a file states about a knife, and the knife that this makes.

use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, positive, within};

use super::edge::Edge;
use super::family::BladeFamily;
use super::solid::{self, MassOf, Piece};

/// What a knife file states.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KnifeFile {
    /// Name, as scenarios and reports call it.
    pub name: String,
    /// One line about the knife.
    #[serde(default)]
    pub description: String,
    /// Coefficient of friction between the blade and food.
    #[schemars(range(min = 0.0, max = 2.0))]
    pub friction: f64,
    /// Density of the blade, kg/m³.
    #[schemars(range(min = 500.0, max = 20_000.0))]
    pub density_kg_per_m3: f64,
    /// Shape of the blade by its family.
    pub blade: BladeFamily,
    /// Handle behind the heel.
    pub handle: Handle,
}

/// A box behind the heel, its upper side level with the spine, that the hand or flange holds in its middle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Handle {
    /// Length along the edge, m.
    #[schemars(range(min = 0.02, max = 0.5))]
    pub length_m: f64,
    /// Height along the cutting direction, m.
    #[schemars(range(min = 0.005, max = 0.1))]
    pub height_m: f64,
    /// Thickness along the normal of the blade, m.
    #[schemars(range(min = 0.005, max = 0.1))]
    pub thickness_m: f64,
    /// Mass, kg.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass_kg: f64,
}

/// A knife ready for use, in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Knife {
    /// Name, as scenarios and reports call it.
    pub name: String,
    /// What cuts.
    pub edge: Edge,
    /// Convex pieces for contact and display: first the blade's, last the handle.
    pub pieces: Vec<Piece>,
    /// Mass, center of mass and inertia of blade and handle.
    pub mass: MassOf,
    /// Pose of the grip, the middle of the handle; its axes are those of the knife.
    pub knife_from_grip: Isometry3<f64>,
}

impl Handle {
    /// Checks the lengths and the mass.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("length_m", self.length_m, 0.02, 0.5)?;
        within("height_m", self.height_m, 0.005, 0.1)?;
        within("thickness_m", self.thickness_m, 0.005, 0.1)?;
        positive("mass_kg", self.mass_kg)
    }
}

impl KnifeFile {
    /// Makes the knife.
    ///
    /// # Errors
    /// A [`FieldError`] naming the key of the file at fault, such as `blade.chef.length_m`.
    pub fn knife(&self) -> Result<Knife, FieldError> {
        within("friction", self.friction, 0.0, 2.0)?;
        within("density_kg_per_m3", self.density_kg_per_m3, 500.0, 20_000.0)?;
        self.blade.validate().map_err(|error| error.within("blade"))?;
        self.handle.validate().map_err(|error| error.within("handle"))?;
        let (handle, grip) = self.placed_handle();
        let flat = || FieldError::new("blade", "pieces without volume", "lengths that make a solid blade");
        let mut pieces = self.blade.pieces();
        let mut mass = MassOf::hull(&handle, 1.0).ok_or_else(flat)?.scaled_to(self.handle.mass_kg);
        for piece in &pieces {
            mass = mass.and(&MassOf::hull(piece, self.density_kg_per_m3).ok_or_else(flat)?);
        }
        pieces.push(handle);
        let edge = self.blade.edge(self.friction);
        edge.validate().map_err(|error| error.within("blade"))?;
        Ok(Knife { name: self.name.clone(), edge, pieces, mass, knife_from_grip: grip })
    }

    /// The handle's corners and the pose of its middle.
    fn placed_handle(&self) -> (Piece, Isometry3<f64>) {
        let Handle { length_m, height_m, thickness_m, .. } = self.handle;
        let top = -self.blade.back_m();
        // a bow is held behind its leg, which stands behind the end of the wire
        let front = if let BladeFamily::Wire(wire) = &self.blade { -wire.rod_m } else { 0.0 };
        let half = 0.5 * thickness_m;
        let piece = solid::cuboid([front - length_m, top, -half], [front, top + height_m, half]);
        let middle = Translation3::new(front - 0.5 * length_m, top + 0.5 * height_m, 0.0);
        (piece, Isometry3::from_parts(middle, UnitQuaternion::identity()))
    }
}
