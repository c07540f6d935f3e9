//! Families of tools: pieces and contact surfaces from a few lengths.
//!
//! Table 1 of the paper describes two tools, the stick and the L; their defaults are its numbers. The other families are
//! shapes of the same size on which a push behaves differently: a hollow keeps a disc, a bulge loses it, a hook cages it.
//!
//! A family has a frame of its own, which the file's grip places in the actuator's. Surfaces are named by where they lie;
//! those in an inner corner begin where a disc of the stated radius fits in. A further family is one file with an
//! implementation of [`ToolShape`], and its lines in this one.

mod ell;
mod hook;
mod paddle;
mod rake;
mod stick;
mod tee;

use nalgebra::Point2;
use serde::{Deserialize, Serialize};

pub use ell::Ell;
pub use hook::Hook;
pub use paddle::{Paddle, PaddleFace};
pub use rake::Rake;
pub use stick::Stick;
pub use tee::Tee;

use super::{ContactSurface, SurfaceShape};
use crate::field::FieldError;
use crate::outline::{Outline, PlacedOutline};

/// Shape of a tool from a few lengths, in a frame of its own.
///
/// Contract: pieces and surfaces of lengths that pass [`validate`](Self::validate) make a valid tool.
pub trait ToolShape {
    /// Checks the lengths, alone and against each other.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending length.
    fn validate(&self) -> Result<(), FieldError>;

    /// Returns the convex pieces whose union is the tool.
    fn pieces(&self) -> Vec<PlacedOutline>;

    /// Returns the parts of the outline that may push.
    fn surfaces(&self) -> Vec<ContactSurface>;
}

/// Families of tools, as a table in a file: `family.l = {}` or `family.hook = { throat_m = 0.03 }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ToolFamily {
    /// Stick with a round head: tool 1 of Table 1.
    Stick(Stick),
    /// Two arms at a right angle: tool 2 of Table 1.
    L(Ell),
    /// Bar on a stem.
    T(Tee),
    /// Shank, bar and prong around a throat.
    Hook(Hook),
    /// Bar with tines.
    Rake(Rake),
    /// Plate with a flat, bulging or hollow face.
    Paddle(Paddle),
}

impl ToolFamily {
    /// Returns the shape of this family.
    #[must_use]
    pub fn shape(&self) -> &dyn ToolShape {
        match self {
            Self::Stick(stick) => stick,
            Self::L(ell) => ell,
            Self::T(tee) => tee,
            Self::Hook(hook) => hook,
            Self::Rake(rake) => rake,
            Self::Paddle(paddle) => paddle,
        }
    }

    /// Returns the name of the family as written in a file.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Stick(_) => "stick",
            Self::L(_) => "l",
            Self::T(_) => "t",
            Self::Hook(_) => "hook",
            Self::Rake(_) => "rake",
            Self::Paddle(_) => "paddle",
        }
    }

    /// Checks the lengths of the family.
    ///
    /// # Errors
    /// A [`FieldError`] with a field such as `hook.throat_m`.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.shape().validate().map_err(|error| error.within(self.name()))
    }
}

/// Longest length of a tool, m; more is a length in millimeters.
const LONGEST_M: f64 = 1.0;
/// Shortest contact surface, m: what positions are known to.
const SHORTEST_FACE_M: f64 = 5e-4;
/// Gap between a disc in a cage and its walls, both sides together, m.
const PLAY_M: f64 = 2e-3;
/// Sums of lengths of some centimeters are compared to within this, m.
const ROUNDING_M: f64 = 1e-12;

/// Checks that a length is positive and that of a tool.
fn length(field: &str, value: f64) -> Result<(), FieldError> {
    if value.is_finite() && value > 0.0 && value <= LONGEST_M {
        Ok(())
    } else {
        Err(FieldError::new(field, value, format!("a length greater than 0 and at most {LONGEST_M} m")))
    }
}

/// Checks a length against a sum of others.
fn at_least(field: &str, value: f64, least_m: f64, reason: &str) -> Result<(), FieldError> {
    if value >= least_m - ROUNDING_M {
        Ok(())
    } else {
        Err(FieldError::new(field, value, format!("at least {} m: {reason}", rounded(least_m))))
    }
}

/// Checks a length against a difference of others.
fn at_most(field: &str, value: f64, most_m: f64, reason: &str) -> Result<(), FieldError> {
    if value <= most_m + ROUNDING_M {
        Ok(())
    } else {
        Err(FieldError::new(field, value, format!("at most {} m: {reason}", rounded(most_m))))
    }
}

/// A length without the noise of its last bits, for a message.
fn rounded(length_m: f64) -> f64 {
    (length_m * 1e6).round() / 1e6
}

/// A rectangle by its sides, m.
fn rectangle(left: f64, right: f64, low: f64, high: f64) -> PlacedOutline {
    let shape = Outline::Box { width_m: right - left, height_m: high - low };
    PlacedOutline { shape, position_m: [0.5 * (left + right), 0.5 * (low + high)], angle_rad: 0.0 }
}

/// A convex polygon, its vertices counterclockwise, m.
fn polygon(vertices: impl IntoIterator<Item = Point2<f64>>) -> PlacedOutline {
    let shape = Outline::Polygon { vertices_m: vertices.into_iter().map(Into::into).collect() };
    PlacedOutline { shape, position_m: [0.0, 0.0], angle_rad: 0.0 }
}

/// A straight surface with its normal to the right of the way from `start` to `end`, m.
fn face(name: &str, start: Point2<f64>, end: Point2<f64>) -> ContactSurface {
    ContactSurface::new(name, SurfaceShape::Face { start_m: start.into(), end_m: end.into() })
}

/// A surface at height `y` with its normal along +y.
fn facing_up(name: &str, y: f64, left: f64, right: f64) -> ContactSurface {
    face(name, Point2::new(right, y), Point2::new(left, y))
}

/// A surface at height `y` with its normal along -y.
fn facing_down(name: &str, y: f64, left: f64, right: f64) -> ContactSurface {
    face(name, Point2::new(left, y), Point2::new(right, y))
}

/// A surface at `x` with its normal along -x.
fn facing_left(name: &str, x: f64, low: f64, high: f64) -> ContactSurface {
    face(name, Point2::new(x, high), Point2::new(x, low))
}

/// A surface at `x` with its normal along +x.
fn facing_right(name: &str, x: f64, low: f64, high: f64) -> ContactSurface {
    face(name, Point2::new(x, low), Point2::new(x, high))
}

#[cfg(test)]
mod tests;
