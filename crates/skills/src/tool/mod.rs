//! Tools as data: outline, contact surfaces, mass and friction.
//!
//! A tool's frame is the frame of the actuator that holds it: its origin is the grip point.

mod surface;

use nalgebra::{Isometry2, Point2};
use serde::{Deserialize, Serialize};

pub use surface::{Contact, ContactSurface, SurfaceShape};

use crate::field::{FieldError, not_negative, positive};
use crate::outline::PlacedOutline;

/// A rigid tool: the union of convex pieces, with the parts of its outline that may push.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tool {
    /// Name, as scenarios and reports call it.
    pub name: String,
    /// One line about the tool.
    #[serde(default)]
    pub description: String,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Coefficient of friction between the tool and what it pushes.
    pub friction: f64,
    /// Convex pieces in the tool frame; their union is the tool.
    pub pieces: Vec<PlacedOutline>,
    /// Parts of the outline that may push.
    pub surfaces: Vec<ContactSurface>,
}

impl Tool {
    /// Checks pieces, surfaces and numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("mass_kg", self.mass_kg)?;
        not_negative("friction", self.friction)?;
        if self.pieces.is_empty() {
            return Err(FieldError::new("pieces", "none", "at least one convex piece"));
        }
        for (index, piece) in self.pieces.iter().enumerate() {
            piece.validate().map_err(|error| error.within(format!("pieces.{index}")))?;
        }
        if self.surfaces.is_empty() {
            return Err(FieldError::new("surfaces", "none", "at least one contact surface"));
        }
        for (index, surface) in self.surfaces.iter().enumerate() {
            surface.validate().map_err(|error| error.within(format!("surfaces.{index}")))?;
            let middle = surface.middle();
            let distance = self.signed_distance_m(&middle.point);
            if distance.abs() > ON_OUTLINE_TOLERANCE_M {
                return Err(FieldError::new(
                    format!("surfaces.{index}"),
                    format!("the surface '{}' lies {distance:.4} m off the outline", surface.name),
                    "a surface on the outline of the pieces",
                ));
            }
        }
        Ok(())
    }

    /// Signed distance of a point in the tool frame from the tool, m: negative inside (exact outside).
    #[must_use]
    pub fn signed_distance_m(&self, point: &Point2<f64>) -> f64 {
        self.pieces.iter().map(|piece| piece.signed_distance_m(point)).fold(f64::INFINITY, f64::min)
    }

    /// Index of the contact surface nearest to a point in the tool frame, with its distance from the point, m.
    #[must_use]
    pub fn nearest_surface(&self, point: &Point2<f64>) -> Option<(usize, f64)> {
        let distances = self.surfaces.iter().map(|surface| (surface.nearest(point).point - point).norm());
        distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Centroid of the pieces in the tool frame, m, weighting each by its area.
    #[must_use]
    pub fn centroid(&self) -> Point2<f64> {
        let area: f64 = self.pieces.iter().map(|piece| piece.shape.area_m2()).sum();
        let moment: nalgebra::Vector2<f64> = self
            .pieces
            .iter()
            .map(|piece| (piece.pose() * piece.shape.centroid()).coords * piece.shape.area_m2())
            .sum();
        Point2::from(moment / area)
    }

    /// Moment of inertia about the centroid, kg m², the mass spread over the pieces by area.
    #[must_use]
    pub fn inertia_kg_m2(&self) -> f64 {
        let area: f64 = self.pieces.iter().map(|piece| piece.shape.area_m2()).sum();
        let centroid = self.centroid();
        let moment = |piece: &PlacedOutline| {
            let arm = piece.pose() * piece.shape.centroid() - centroid;
            piece.shape.area_m2() * (piece.shape.inertia_per_mass_m2() + arm.norm_squared())
        };
        self.mass_kg * self.pieces.iter().map(moment).sum::<f64>() / area
    }

    /// Tool pose for which the contact of a surface's middle touches a disc of radius `radius_m` about `center_world`.
    ///
    /// `angle_rad` is the tool's orientation; `gap_m` the distance left between tool and disc (negative presses).
    #[must_use]
    pub fn pose_touching(
        &self,
        surface: &Contact,
        center_world: &Point2<f64>,
        radius_m: f64,
        gap_m: f64,
        angle_rad: f64,
    ) -> Isometry2<f64> {
        let rotation = nalgebra::UnitComplex::new(angle_rad);
        let contact_to_center = surface.point.coords + surface.normal.into_inner() * (radius_m + gap_m);
        Isometry2::from_parts((center_world - rotation * contact_to_center).into(), rotation)
    }
}

/// A surface given in a file to a tenth of a millimeter is on the outline.
const ON_OUTLINE_TOLERANCE_M: f64 = 1e-4;
