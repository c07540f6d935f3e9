//! The paddle: a plate with a flat, bulging or hollow face.
//!
//! A hollow is no union of convex pieces. It is cut into columns whose upper sides are short chords of its arc; the contact
//! surface is the arc itself.

use nalgebra::Point2;
use serde::{Deserialize, Serialize};

use super::{
    SHORTEST_FACE_M, ToolShape, at_least, facing_down, facing_left, facing_right, facing_up, length, polygon, rectangle,
};
use crate::field::{FieldError, not_negative, positive, within};
use crate::outline::PlacedOutline;
use crate::tool::{ContactSurface, SurfaceShape};

/// Plate across y, its face toward +y; the origin is the middle of its back.
///
/// Surfaces: `face`, `left`, `right`, `back`. A disc stays in a hollow of a radius larger than its own, and drifts off a
/// bulge: pushed without slip through s, its angle φ off the middle follows dφ/ds = κ sin φ / (R + r), with the
/// face's radius r positive for a bulge, negative for a hollow, and κ = 1/(1 + c²/R²) for a disc of radius R and friction
/// length c.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Paddle {
    /// Width, m.
    pub width_m: f64,
    /// Thickness where it is thinnest, m.
    pub thickness_m: f64,
    /// Form of the face.
    pub face: PaddleFace,
    /// Ends of each surface that are left out, m.
    #[schemars(range(min = 0.0))]
    pub edge_margin_m: f64,
}

/// Form of a paddle's face.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PaddleFace {
    /// Straight: a disc neither stays nor leaves by itself.
    #[default]
    Flat,
    /// Bulging: a disc leaves it.
    Convex {
        /// Radius of the bulge, m; the width is at most 1.9 of it.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius_m: f64,
    },
    /// Hollow: a smaller disc stays in it.
    Concave {
        /// Radius of the hollow, m; the width is at most 1.9 of it.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius_m: f64,
    },
}

impl Default for Paddle {
    fn default() -> Self {
        Self { width_m: 0.040, thickness_m: 0.010, face: PaddleFace::Flat, edge_margin_m: 0.001 }
    }
}

/// Widest face by its radius: wider ones would end in blades.
pub(super) const WIDEST_FACE: f64 = 1.9;
/// Largest radius of a face, m; beyond it a face is flat.
const LARGEST_RADIUS_M: f64 = 10.0;
/// Largest distance of a chord from its arc, m: a fifth of what a surface may lie off the outline.
const CHORD_ERROR_M: f64 = 2e-5;

/// The arc of a face that is not flat.
struct FaceArc {
    radius_m: f64,
    /// Angle from the middle to either rim, rad.
    half_angle_rad: f64,
}

impl FaceArc {
    /// Height above the middle of a hollow (below that of a bulge) at an angle from it, m.
    fn height_m(&self, angle_rad: f64) -> f64 {
        2.0 * self.radius_m * (angle_rad / 2.0).sin().powi(2)
    }

    /// Ends of the chords as angle from the middle, from left to right.
    fn chord_ends(&self) -> impl DoubleEndedIterator<Item = f64> {
        let chord_rad = 2.0 * (1.0 - CHORD_ERROR_M / self.radius_m).clamp(-1.0, 1.0).acos();
        let chords = (2.0 * self.half_angle_rad / chord_rad).ceil().max(1.0) as u32;
        let half_angle_rad = self.half_angle_rad;
        (0..=chords).map(move |end| half_angle_rad * (2.0 * f64::from(end) / f64::from(chords) - 1.0))
    }
}

impl Paddle {
    fn arc(&self) -> Option<FaceArc> {
        match self.face {
            PaddleFace::Flat => None,
            PaddleFace::Convex { radius_m } | PaddleFace::Concave { radius_m } => {
                Some(FaceArc { radius_m, half_angle_rad: (self.width_m / 2.0 / radius_m).asin() })
            }
        }
    }

    /// The face as a surface: the arc without its margins.
    fn face(&self) -> ContactSurface {
        let Some(FaceArc { radius_m, half_angle_rad }) = self.arc() else {
            let half_m = self.width_m / 2.0 - self.edge_margin_m;
            return facing_up("face", self.thickness_m, -half_m, half_m);
        };
        let (center_y, signed_m) = match self.face {
            PaddleFace::Concave { .. } => (self.thickness_m + radius_m, -radius_m),
            _ => (self.thickness_m - radius_m * half_angle_rad.cos(), radius_m),
        };
        let shape = SurfaceShape::Arc {
            center_m: [0.0, center_y],
            radius_m: signed_m,
            direction_rad: std::f64::consts::FRAC_PI_2,
            half_angle_rad: half_angle_rad - self.edge_margin_m / radius_m,
        };
        ContactSurface::new("face", shape)
    }

    /// Height of the face's rims over the back, m.
    fn rim_m(&self) -> f64 {
        let rise = |arc: FaceArc| arc.height_m(arc.half_angle_rad);
        let hollow_m = if matches!(self.face, PaddleFace::Concave { .. }) { self.arc().map_or(0.0, rise) } else { 0.0 };
        self.thickness_m + hollow_m
    }
}

impl ToolShape for Paddle {
    fn validate(&self) -> Result<(), FieldError> {
        length("width_m", self.width_m)?;
        length("thickness_m", self.thickness_m)?;
        not_negative("edge_margin_m", self.edge_margin_m)?;
        let ends_m = 2.0 * self.edge_margin_m + SHORTEST_FACE_M;
        at_least("width_m", self.width_m, ends_m, "face and back, less two of edge_margin_m")?;
        at_least("thickness_m", self.thickness_m, ends_m, "its ends push too, less two of edge_margin_m")?;
        let (field, radius_m) = match self.face {
            PaddleFace::Flat => return Ok(()),
            PaddleFace::Convex { radius_m } => ("face.convex.radius_m", radius_m),
            PaddleFace::Concave { radius_m } => ("face.concave.radius_m", radius_m),
        };
        positive(field, radius_m)?;
        at_least(field, radius_m, self.width_m / WIDEST_FACE, "width_m by 1.9, lest the rims end in blades")?;
        within(field, radius_m, 0.0, LARGEST_RADIUS_M).map_err(|mut error| {
            error.expected = format!("at most {LARGEST_RADIUS_M} m; write `face = \"flat\"` for a straight face");
            error
        })
    }

    fn pieces(&self) -> Vec<PlacedOutline> {
        let half_m = self.width_m / 2.0;
        let Some(arc) = self.arc() else { return vec![rectangle(-half_m, half_m, 0.0, self.thickness_m)] };
        let crown_m = self.thickness_m + arc.height_m(arc.half_angle_rad);
        let at = |angle_rad: f64| {
            let height_m = match self.face {
                PaddleFace::Concave { .. } => self.thickness_m + arc.height_m(angle_rad),
                _ => crown_m - arc.height_m(angle_rad),
            };
            Point2::new(arc.radius_m * angle_rad.sin(), height_m)
        };
        match self.face {
            PaddleFace::Concave { .. } => {
                let ends: Vec<Point2<f64>> = arc.chord_ends().map(at).collect();
                let column = |(left, right): (&Point2<f64>, &Point2<f64>)| {
                    polygon([Point2::new(left.x, 0.0), Point2::new(right.x, 0.0), *right, *left])
                };
                ends.iter().zip(ends.iter().skip(1)).map(column).collect()
            }
            _ => {
                let back = [Point2::new(-half_m, 0.0), Point2::new(half_m, 0.0)];
                vec![polygon(back.into_iter().chain(arc.chord_ends().rev().map(at)))]
            }
        }
    }

    fn surfaces(&self) -> Vec<ContactSurface> {
        let (half_m, margin, rim_m) = (self.width_m / 2.0, self.edge_margin_m, self.rim_m());
        vec![
            self.face(),
            facing_left("left", -half_m, margin, rim_m - margin),
            facing_right("right", half_m, margin, rim_m - margin),
            facing_down("back", 0.0, margin - half_m, half_m - margin),
        ]
    }
}

#[cfg(test)]
#[path = "paddle_tests.rs"]
mod tests;
