//! Signed clearance between a tool and an object in the tool's frame, with the direction that opens it.
//!
//! Unlike [`crate::outline::separation_m`] this prepares the outlines once, allocates nothing per query, and tells the
//! direction; the depth of an overlap is exact for two convex outlines, so that the clearance is 1-Lipschitz throughout.

use nalgebra::{Point2, UnitComplex, Vector2};

use crate::field::FieldError;
use crate::outline::Outline;
use crate::tool::Tool;

/// A convex outline as a polygon (or one point) and a radius round it.
#[derive(Debug, Clone)]
struct Rounded {
    corners: Vec<Point2<f64>>,
    radius_m: f64,
}

impl Rounded {
    fn new(outline: &Outline) -> Self {
        match outline {
            Outline::Disc { radius_m } => Self { corners: vec![Point2::origin()], radius_m: *radius_m },
            Outline::Box { .. } | Outline::Polygon { .. } => {
                Self { corners: outline.drawing(0).into_iter().map(Point2::from).collect(), radius_m: 0.0 }
            }
        }
    }

    /// Edges from corner to corner, counterclockwise; none of a point.
    fn edges(&self) -> impl Iterator<Item = (Point2<f64>, Point2<f64>)> + '_ {
        let next = self.corners.iter().cycle().skip(1);
        let some = if self.corners.len() > 1 { self.corners.len() } else { 0 };
        self.corners.iter().copied().zip(next.copied()).take(some)
    }
}

/// Clearance between a piece of the tool and the object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gap {
    /// Distance, m; in overlap minus its depth.
    pub(super) distance_m: f64,
    /// Direction in which the object leaves the tool, unit vector in the tool's frame.
    pub(super) outward: Vector2<f64>,
}

/// A tool and an object whose clearance is asked for at many places.
#[derive(Debug, Clone)]
pub(super) struct Bodies {
    pieces: Vec<Rounded>,
    object: Rounded,
    tool_radius_m: f64,
    object_radius_m: f64,
}

impl Bodies {
    /// Prepares a valid tool and a valid object.
    pub(super) fn new(tool: &Tool, object: &Outline) -> Result<Self, FieldError> {
        tool.validate().map_err(|error| error.within("tool"))?;
        object.validate().map_err(|error| error.within("object"))?;
        let pieces = tool.pieces.iter().map(|piece| {
            let mut rounded = Rounded::new(&piece.shape);
            rounded.corners.iter_mut().for_each(|corner| *corner = piece.pose() * *corner);
            rounded
        });
        let pieces: Vec<Rounded> = pieces.collect();
        let farthest = |piece: &Rounded| {
            piece.corners.iter().map(|corner| corner.coords.norm()).fold(0.0, f64::max) + piece.radius_m
        };
        let tool_radius_m = pieces.iter().map(farthest).fold(0.0, f64::max);
        Ok(Self { pieces, object: Rounded::new(object), tool_radius_m, object_radius_m: object.radius_m() })
    }

    /// The same tool with the disc about the object's origin that holds the object at every angle.
    pub(super) fn with_circumscribed_disc(&self) -> Self {
        let object = Rounded { corners: vec![Point2::origin()], radius_m: self.object_radius_m };
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

// the object's corners are `placed` in the frame of the piece
fn gap(piece: &Rounded, object: &Rounded, placed: impl Fn(&Point2<f64>) -> Point2<f64>) -> Gap {
    let radii_m = piece.radius_m + object.radius_m;
    let core = match overlap(piece, object, &placed) {
        Some(core) if core.distance_m < 0.0 => core,
        _ => apart(piece, object, &placed),
    };
    Gap { distance_m: core.distance_m - radii_m, ..core }
}

/// Greatest distance over all edges' outward normals: exact, as a negative depth, where the cores overlap (separating
/// axes); nothing for two points.
fn overlap(piece: &Rounded, object: &Rounded, placed: &impl Fn(&Point2<f64>) -> Point2<f64>) -> Option<Gap> {
    let mut best: Option<Gap> = None;
    let mut keep = |distance_m: f64, outward: Vector2<f64>| {
        if best.is_none_or(|best| distance_m > best.distance_m) {
            best = Some(Gap { distance_m, outward });
        }
    };
    for (a, b) in piece.edges() {
        let normal = right_of(&(b - a));
        let distance = |corner| (placed(corner) - a).dot(&normal);
        keep(object.corners.iter().map(distance).fold(f64::INFINITY, f64::min), normal);
    }
    for (a, b) in object.edges() {
        let (a, b) = (placed(&a), placed(&b));
        let normal = right_of(&(b - a));
        let distance = |corner: &Point2<f64>| (corner - a).dot(&normal);
        keep(piece.corners.iter().map(distance).fold(f64::INFINITY, f64::min), -normal);
    }
    best
}

/// Distance of two cores that do not overlap: of a corner of one from a corner or an edge of the other.
fn apart(piece: &Rounded, object: &Rounded, placed: &impl Fn(&Point2<f64>) -> Point2<f64>) -> Gap {
    let mut nearest = (f64::INFINITY, Vector2::zeros());
    let mut keep = |way: Vector2<f64>| {
        if way.norm_squared() < nearest.0 {
            nearest = (way.norm_squared(), way);
        }
    };
    for corner in object.corners.iter().map(placed) {
        piece.corners.iter().for_each(|other| keep(corner - other));
        piece.edges().for_each(|(a, b)| keep(corner - foot(&corner, &a, &b)));
    }
    for (a, b) in object.edges() {
        let (a, b) = (placed(&a), placed(&b));
        piece.corners.iter().for_each(|corner| keep(foot(corner, &a, &b) - corner));
    }
    let distance_m = nearest.0.sqrt();
    // two cores that just touch have no direction between them; the separating axis has one
    let outward =
        nearest.1.try_normalize(SMALLEST_WAY_M).or_else(|| overlap(piece, object, placed).map(|gap| gap.outward));
    Gap { distance_m, outward: outward.unwrap_or_else(Vector2::x) }
}

/// Distance below which its direction is lost in rounding, m.
const SMALLEST_WAY_M: f64 = 1e-12;

fn right_of(edge: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(edge.y, -edge.x) / edge.norm()
}

fn foot(point: &Point2<f64>, a: &Point2<f64>, b: &Point2<f64>) -> Point2<f64> {
    let edge = b - a;
    a + edge * ((point - a).dot(&edge) / edge.norm_squared()).clamp(0.0, 1.0)
}

#[cfg(test)]
#[path = "clearance_tests.rs"]
mod tests;
