//! Signed clearance between a tool and an object in the tool's frame, with the direction that opens it.
//!
//! Unlike [`crate::outline::separation_m`] this prepares the outlines once, allocates nothing per query, and tells the
//! direction; the depth of an overlap is exact for two convex outlines, so that the clearance is 1-Lipschitz throughout.

use nalgebra::{Point2, UnitComplex, Vector2};

use crate::field::FieldError;
use crate::outline::{Convex, Gap, Outline, PlacedOutline, gap};
use crate::tool::Tool;

/// A tool and an object whose clearance is asked for at many places.
#[derive(Debug, Clone)]
pub(super) struct Bodies {
    pieces: Vec<Convex>,
    object: Convex,
    tool_radius_m: f64,
    object_radius_m: f64,
}

impl Bodies {
    /// Prepares a valid tool and a valid object.
    pub(super) fn new(tool: &Tool, object: &Outline) -> Result<Self, FieldError> {
        tool.validate().map_err(|error| error.within("tool"))?;
        object.validate().map_err(|error| error.within("object"))?;
        let placed = |piece: &PlacedOutline| Convex::new(&piece.shape).moved(|corner| piece.pose() * corner);
        let pieces: Vec<Convex> = tool.pieces.iter().map(placed).collect();
        let farthest = |piece: &Convex| {
            piece.corners.iter().map(|corner| corner.coords.norm()).fold(0.0, f64::max) + piece.radius_m
        };
        let tool_radius_m = pieces.iter().map(farthest).fold(0.0, f64::max);
        Ok(Self { pieces, object: Convex::new(object), tool_radius_m, object_radius_m: object.radius_m() })
    }

    /// The same tool with the disc about the object's origin that holds the object at every angle.
    pub(super) fn with_circumscribed_disc(&self) -> Self {
        let object = Convex { corners: vec![Point2::origin()], radius_m: self.object_radius_m };
        Self { object, ..self.clone() }
    }

    /// Greatest displacement of a point of the outline per radian of the object's angle, m: 0 for a disc.
    pub(super) fn lever_m(&self) -> f64 {
        self.object_radius_m - self.object.radius_m
    }

    /// Distance within which tool and object lie wherever they touch, m.
    pub(super) fn reach_m(&self) -> f64 {
        self.tool_radius_m + self.object_radius_m
    }

    /// How far the object at `angle_rad` extends from its origin towards `direction` (unit vector, tool frame), m.
    pub(super) fn support_m(&self, direction: &Vector2<f64>, angle_rad: f64) -> f64 {
        let rotation = UnitComplex::new(angle_rad);
        let along = |corner: &Point2<f64>| (rotation * corner.coords).dot(direction);
        self.object.corners.iter().map(along).fold(f64::NEG_INFINITY, f64::max) + self.object.radius_m
    }

    /// Gaps between each piece of the tool and the object with its origin at `center` and `angle_rad`, both in the tool's
    /// frame.
    pub(super) fn gaps<'a>(&'a self, center: &'a Point2<f64>, angle_rad: f64) -> impl Iterator<Item = Gap> + 'a {
        let rotation = UnitComplex::new(angle_rad);
        self.pieces.iter().map(move |piece| gap(piece, &self.object, |corner| center + rotation * corner.coords))
    }

    /// The smallest of the gaps; a tool has at least one piece.
    pub(super) fn gap(&self, center: &Point2<f64>, angle_rad: f64) -> Gap {
        let none = Gap { distance_m: f64::INFINITY, outward: Vector2::zeros() };
        self.gaps(center, angle_rad)
            .fold(none, |least, gap| if gap.distance_m < least.distance_m { gap } else { least })
    }
}

#[cfg(test)]
#[path = "clearance_tests.rs"]
mod tests;
