//! Shapes of foods from a few lengths.

use std::f64::consts::{FRAC_PI_2, PI};

use serde::{Deserialize, Serialize};
use skills::field::{FieldError, within};

use super::Banana;
use super::revolved::{Axis, ProfilePoint, revolved};
use crate::cutting::geometry::{ConvexCell, GeometryError};

/// The shape of a food. Its frame has the origin in the middle of the shape and z upwards, as it would lie on a board.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Cuboid, parallel to the axes.
    Block(Block),
    /// Lying cylinder.
    Cylinder(Cylinder),
    /// Flat disc with a rounded edge.
    Disc(Disc),
    /// Ellipsoid, or sphere.
    Ellipsoid(Ellipsoid),
    /// Lying berry: half an ellipsoid at the stem, a paraboloid to the tip.
    Berry(Berry),
    /// Bent, tapered tube.
    Banana(Banana),
}

/// Lengths of a cuboid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Extent along x, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub length_m: f64,
    /// Extent along y, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub width_m: f64,
    /// Extent along z, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub height_m: f64,
}

/// Lengths of a cylinder whose axis is x.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Diameter, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub diameter_m: f64,
    /// Length of the axis, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub length_m: f64,
    /// Number of flat sides.
    #[serde(default = "default_sides")]
    pub sides: usize,
}

/// Lengths of a disc whose axis is z.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Diameter, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub diameter_m: f64,
    /// Thickness, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub thickness_m: f64,
    /// Radius of the rounding of both edges, m: at most half the thickness.
    #[schemars(range(min = 0.0))]
    pub edge_radius_m: f64,
    /// Number of flat sides.
    #[serde(default = "default_sides")]
    pub sides: usize,
}

/// Lengths of an ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ellipsoid {
    /// Diameter along x, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub length_m: f64,
    /// Diameter along y, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub width_m: f64,
    /// Diameter along z, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub height_m: f64,
    /// Number of flat sides about the axis x; half as many from pole to pole.
    #[serde(default = "default_sides")]
    pub sides: usize,
}

/// Lengths of a berry whose axis is x; the tip points along x.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Berry {
    /// Greatest diameter, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub diameter_m: f64,
    /// Length from stem to tip, m.
    #[schemars(range(min = LENGTHS_M[0], max = LENGTHS_M[1]))]
    pub length_m: f64,
    /// Length of the half ellipsoid at the stem, m.
    #[schemars(range(min = LENGTHS_M[0]))]
    pub shoulder_m: f64,
    /// Number of flat sides about the axis.
    #[serde(default = "default_sides")]
    pub sides: usize,
}

/// Flat sides of a round food: one of 30 mm diameter is round to 0.07 mm.
pub(super) fn default_sides() -> usize {
    32
}

/// Lengths of foods on a board, m; others are lengths in millimeters.
const LENGTHS_M: [f64; 2] = [1e-3, 1.0];

/// Fewer sides are not round, more are finer than any cut.
const SIDES: [usize; 2] = [8, 128];

impl Shape {
    /// Checks that the lengths make a shape.
    ///
    /// # Errors
    /// A [`FieldError`] naming the length.
    pub fn validate(&self) -> Result<(), FieldError> {
        let (kind, checked) = match self {
            Self::Block(block) => ("block", block.validate()),
            Self::Cylinder(cylinder) => ("cylinder", cylinder.validate()),
            Self::Disc(disc) => ("disc", disc.validate()),
            Self::Ellipsoid(ellipsoid) => ("ellipsoid", ellipsoid.validate()),
            Self::Berry(berry) => ("berry", berry.validate()),
            Self::Banana(banana) => ("banana", banana.validate()),
        };
        checked.map_err(|error| error.within(kind))
    }

    /// Returns the convex cells of the shape, which hold together where they share faces.
    ///
    /// # Errors
    /// A [`GeometryError`] if the lengths make no shape; [`Shape::validate`] says which one is at fault.
    pub fn cells(&self) -> Result<Vec<ConvexCell>, GeometryError> {
        match self {
            Self::Block(block) => block.cell().map(|cell| vec![cell]),
            Self::Cylinder(cylinder) => cylinder.cell().map(|cell| vec![cell]),
            Self::Disc(disc) => disc.cell().map(|cell| vec![cell]),
            Self::Ellipsoid(ellipsoid) => ellipsoid.cell().map(|cell| vec![cell]),
            Self::Berry(berry) => berry.cell().map(|cell| vec![cell]),
            Self::Banana(banana) => banana.cells(),
        }
    }

    /// Returns the shape with all lengths multiplied by `scale`.
    #[must_use]
    pub fn scaled(&self, scale: f64) -> Self {
        match *self {
            Self::Block(block) => Self::Block(Block {
                length_m: block.length_m * scale,
                width_m: block.width_m * scale,
                height_m: block.height_m * scale,
            }),
            Self::Cylinder(cylinder) => Self::Cylinder(Cylinder {
                diameter_m: cylinder.diameter_m * scale,
                length_m: cylinder.length_m * scale,
                ..cylinder
            }),
            Self::Disc(disc) => Self::Disc(Disc {
                diameter_m: disc.diameter_m * scale,
                thickness_m: disc.thickness_m * scale,
                edge_radius_m: disc.edge_radius_m * scale,
                ..disc
            }),
            Self::Ellipsoid(ellipsoid) => Self::Ellipsoid(Ellipsoid {
                length_m: ellipsoid.length_m * scale,
                width_m: ellipsoid.width_m * scale,
                height_m: ellipsoid.height_m * scale,
                ..ellipsoid
            }),
            Self::Berry(berry) => Self::Berry(Berry {
                diameter_m: berry.diameter_m * scale,
                length_m: berry.length_m * scale,
                shoulder_m: berry.shoulder_m * scale,
                ..berry
            }),
            Self::Banana(banana) => Self::Banana(banana.scaled(scale)),
        }
    }
}

/// Checks a length of a food.
pub(super) fn length(field: &str, value_m: f64) -> Result<(), FieldError> {
    within(field, value_m, LENGTHS_M[0], LENGTHS_M[1])
}

/// Checks a number of sides.
pub(super) fn sides(count: usize) -> Result<(), FieldError> {
    if (SIDES[0]..=SIDES[1]).contains(&count) && count.is_multiple_of(4) {
        return Ok(());
    }
    Err(FieldError::new("sides", count, format!("a multiple of 4 from {} to {}", SIDES[0], SIDES[1])))
}

impl Block {
    fn validate(&self) -> Result<(), FieldError> {
        length("length_m", self.length_m)?;
        length("width_m", self.width_m)?;
        length("height_m", self.height_m)
    }

    fn cell(&self) -> Result<ConvexCell, GeometryError> {
        ConvexCell::from_box(&(nalgebra::Vector3::new(self.length_m, self.width_m, self.height_m) / 2.0))
    }
}

impl Cylinder {
    fn validate(&self) -> Result<(), FieldError> {
        length("diameter_m", self.diameter_m)?;
        length("length_m", self.length_m)?;
        sides(self.sides)
    }

    fn cell(&self) -> Result<ConvexCell, GeometryError> {
        let (radius, half) = (self.diameter_m / 2.0, self.length_m / 2.0);
        revolved(&[(-half, radius), (half, radius)], self.sides, Axis::X)
    }
}

impl Disc {
    fn validate(&self) -> Result<(), FieldError> {
        length("diameter_m", self.diameter_m)?;
        length("thickness_m", self.thickness_m)?;
        let most = self.thickness_m.min(self.diameter_m) / 2.0 - LENGTHS_M[0] / 10.0;
        within("edge_radius_m", self.edge_radius_m, 0.0, most)?;
        sides(self.sides)
    }

    fn cell(&self) -> Result<ConvexCell, GeometryError> {
        let (radius, half, edge) = (self.diameter_m / 2.0, self.thickness_m / 2.0, self.edge_radius_m);
        let steps = if edge == 0.0 { 0 } else { self.sides / 8 };
        let rounding = |step: usize| {
            let angle = FRAC_PI_2 * step as f64 / steps.max(1) as f64;
            (half - edge * (1.0 - angle.cos()), radius - edge * (1.0 - angle.sin()))
        };
        // from the flat face to the rim and, mirrored, back to the other face
        let upper = (0..=steps).map(rounding).collect::<Vec<ProfilePoint>>();
        let lower = upper.iter().map(|&(along, radius)| (-along, radius));
        let profile = lower.chain(upper.iter().rev().copied()).collect::<Vec<_>>();
        revolved(&profile, self.sides, Axis::Z)
    }
}

impl Ellipsoid {
    fn validate(&self) -> Result<(), FieldError> {
        length("length_m", self.length_m)?;
        length("width_m", self.width_m)?;
        length("height_m", self.height_m)?;
        sides(self.sides)
    }

    fn cell(&self) -> Result<ConvexCell, GeometryError> {
        let rings = self.sides / 2;
        let arc = |ring: usize| match PI * ring as f64 / rings as f64 {
            _ if ring == 0 => (-1.0, 0.0),
            _ if ring == rings => (1.0, 0.0),
            angle => (-angle.cos(), angle.sin()),
        };
        let sphere = revolved(&(0..=rings).map(arc).collect::<Vec<_>>(), self.sides, Axis::X)?;
        sphere.stretched(&(nalgebra::Vector3::new(self.length_m, self.width_m, self.height_m) / 2.0))
    }
}

impl Berry {
    fn validate(&self) -> Result<(), FieldError> {
        length("diameter_m", self.diameter_m)?;
        length("length_m", self.length_m)?;
        within("shoulder_m", self.shoulder_m, LENGTHS_M[0], self.length_m - LENGTHS_M[0])?;
        sides(self.sides)
    }

    /// Radius R √(1 − u²) over the shoulder and R √(1 − u) towards the tip, u from 0 at the thickest place to 1.
    fn cell(&self) -> Result<ConvexCell, GeometryError> {
        let radius = self.diameter_m / 2.0;
        let (shoulder, tip) = (self.shoulder_m, self.length_m - self.shoulder_m);
        let thickest = shoulder - self.length_m / 2.0;
        let steps = self.sides / 4;
        let angle = |step: usize| FRAC_PI_2 * step as f64 / steps as f64;
        let behind = (1..steps).map(|step| (thickest - shoulder * angle(step).cos(), radius * angle(step).sin()));
        let ahead = (0..steps).map(|step| (thickest + tip * angle(step).sin().powi(2), radius * angle(step).cos()));
        let ends = [(thickest - shoulder, 0.0), (thickest + tip, 0.0)];
        let profile = std::iter::once(ends[0]).chain(behind).chain(ahead).chain(std::iter::once(ends[1]));
        revolved(&profile.collect::<Vec<_>>(), self.sides, Axis::X)
    }
}

#[cfg(test)]
#[path = "shape_tests.rs"]
mod tests;
