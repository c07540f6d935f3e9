//! Tools as data: outline, contact surfaces, mass and friction.
//!
//! A tool's frame is the frame of the actuator that holds it: its origin is the grip point. A file may describe the tool
//! in a frame of its own and state the grip between the two: see [`ToolFile`].

pub mod family;
mod file;
mod friction;
mod surface;

use nalgebra::{Isometry2, Point2};
use serde::{Deserialize, Serialize};

pub use file::{Grip, ToolFile};
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
    /// Coefficient of friction between the tool and what it pushes, where a surface states none of its own.
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
            self.check_place(surface).map_err(|error| error.within(format!("surfaces.{index}")))?;
        }
        self.check_friction()
    }

    /// Checks that middle and ends of a surface lie on the outline, and that its normal points out of the tool.
    fn check_place(&self, surface: &ContactSurface) -> Result<(), FieldError> {
        let half = surface.length_m() / 2.0;
        for place_m in [0.0, -half, half] {
            let contact = surface.contact_at(place_m);
            let distance = self.signed_distance_m(&contact.point);
            if distance.abs() > ON_OUTLINE_TOLERANCE_M {
                let found =
                    format!("the surface '{}', of which a point lies {distance:.4} m off the outline", surface.name);
                return Err(FieldError::new("shape", found, "a surface on the outline of the pieces"));
            }
        }
        let middle = surface.middle();
        if self.signed_distance_m(&(middle.point + middle.normal.into_inner() * OUTSIDE_M)) < 0.0 {
            let found = format!("the surface '{}', whose normal points into the tool", surface.name);
            return Err(FieldError::new(
                "shape",
                found,
                "a normal out of the tool: a face has it to the right of its way",
            ));
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

    /// Tool pose at which `contact` touches a disc of radius `radius_m` about `center_world`, the disc on its normal.
    ///
    /// `angle_rad` is the tool's orientation; `gap_m` the distance left between tool and disc (negative presses). In a
    /// hollow the disc must be smaller than the hollow's circle.
    #[must_use]
    pub fn pose_touching(
        &self,
        contact: &Contact,
        center_world: &Point2<f64>,
        radius_m: f64,
        gap_m: f64,
        angle_rad: f64,
    ) -> Isometry2<f64> {
        let rotation = nalgebra::UnitComplex::new(angle_rad);
        let center_in_tool = contact.point.coords + contact.normal.into_inner() * (radius_m + gap_m);
        Isometry2::from_parts((center_world - rotation * center_in_tool).into(), rotation)
    }
}

/// A surface given in a file to a tenth of a millimeter is on the outline.
const ON_OUTLINE_TOLERANCE_M: f64 = 1e-4;
/// A point this far out along a surface's normal lies outside the tool, m.
const OUTSIDE_M: f64 = 2.0 * ON_OUTLINE_TOLERANCE_M;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Outline;
    use approx::assert_relative_eq;
    use nalgebra::Vector2;

    /// A few roundings of lengths of some centimeters.
    const ROUNDING_M: f64 = 1e-15;

    /// A bar of 40 x 10 mm about the origin that pushes with its upper side.
    fn bar() -> Tool {
        let shape = Outline::Box { width_m: 0.04, height_m: 0.01 };
        let pieces = vec![PlacedOutline { shape, position_m: [0.0, 0.0], angle_rad: 0.0 }];
        let shape = SurfaceShape::Face { start_m: [0.02, 0.005], end_m: [-0.02, 0.005] };
        let surfaces = vec![ContactSurface::new("top", shape)];
        Tool { name: "bar".into(), description: String::new(), mass_kg: 0.01, friction: 0.3, pieces, surfaces }
    }

    fn refused(change: impl Fn(&mut Tool)) -> FieldError {
        let mut tool = bar();
        change(&mut tool);
        tool.validate().unwrap_err()
    }

    fn face(start_m: [f64; 2], end_m: [f64; 2]) -> SurfaceShape {
        SurfaceShape::Face { start_m, end_m }
    }

    #[test]
    fn values_that_make_no_tool_are_refused_by_field() {
        assert_eq!(bar().validate(), Ok(()));
        assert_eq!(refused(|tool| tool.mass_kg = 0.0).field, "mass_kg");
        assert_eq!(refused(|tool| tool.friction = -0.1).field, "friction");
        assert_eq!(refused(|tool| tool.pieces.clear()).field, "pieces");
        assert_eq!(refused(|tool| tool.pieces[0].angle_rad = f64::NAN).field, "pieces.0.angle_rad");
        assert_eq!(
            refused(|tool| tool.pieces[0].shape = Outline::Disc { radius_m: 0.0 }).field,
            "pieces.0.shape.disc.radius_m"
        );
        assert_eq!(refused(|tool| tool.surfaces.clear()).field, "surfaces");
        let nowhere = face([0.0, 0.005], [0.0, 0.005]);
        assert_eq!(refused(|tool| tool.surfaces[0].shape = nowhere.clone()).field, "surfaces.0.shape.face.end_m");
    }

    #[test]
    fn a_surface_off_the_outline_is_refused() {
        // above it, inside it, and with only its middle on it
        for (start_m, end_m) in
            [([0.02, 0.006], [-0.02, 0.006]), ([0.02, 0.0], [-0.02, 0.0]), ([0.02, 0.009], [-0.02, 0.001])]
        {
            let error = refused(|tool| tool.surfaces[0].shape = face(start_m, end_m));
            assert!(error.field == "surfaces.0.shape" && error.found.contains("off the outline"), "{error}");
        }
    }

    #[test]
    fn a_surface_whose_normal_points_into_the_tool_is_refused() {
        let error = refused(|tool| tool.surfaces[0].shape = face([-0.02, 0.005], [0.02, 0.005]));
        assert!(error.field == "surfaces.0.shape" && error.found.contains("into the tool"), "{error}");
    }

    #[test]
    fn a_tool_that_touches_leaves_the_gap_between_contact_and_disc() {
        let direction_rad = -std::f64::consts::FRAC_PI_2;
        let hollow = SurfaceShape::Arc { center_m: [0.0, -0.03], radius_m: -0.03, direction_rad, half_angle_rad: 0.5 };
        let hollow = ContactSurface::new("hollow", hollow);
        let center = Point2::new(0.3, -0.2);
        for surface in [&bar().surfaces[0], &hollow] {
            for (place_m, gap_m, angle_rad) in [(0.0, 0.0, 0.0), (0.004, 0.001, 0.7), (-0.01, -0.0005, -2.0)] {
                let contact = surface.contact_at(place_m);
                let pose = bar().pose_touching(&contact, &center, 0.012, gap_m, angle_rad);
                let (point, normal) = (pose * contact.point, pose.rotation * contact.normal.into_inner());
                assert_relative_eq!(center - point, normal * (0.012 + gap_m), epsilon = ROUNDING_M);
                assert_relative_eq!(pose.rotation.angle(), angle_rad, epsilon = ROUNDING_M);
                // seen from the tool, the disc lies on the normal of that very contact
                assert_relative_eq!(surface.place_m(&pose.inverse_transform_point(&center)), place_m, epsilon = 1e-12);
            }
        }
    }

    #[test]
    fn the_middle_of_a_bar_weighs_as_its_box() {
        assert_relative_eq!(bar().centroid().coords, Vector2::zeros(), epsilon = ROUNDING_M);
        assert_relative_eq!(bar().inertia_kg_m2(), 0.01 * (0.04 * 0.04 + 0.01 * 0.01) / 12.0, epsilon = 1e-18);
    }
}
