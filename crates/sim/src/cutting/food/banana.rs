//! The banana: a bent tube with rounded ends, sliced into convex wedges.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Point3;
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, within};

use super::revolved::unit;
use super::shape::{default_sides, length, sides};
use crate::cutting::geometry::{ConvexCell, GeometryError};

/// Lengths of a banana that lies on its side: its center line is an arc in the x-y plane.
///
/// The origin is the middle of the center line, x its direction there, and its center of curvature lies along y.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Banana {
    /// Diameter between the ends, m.
    #[schemars(range(min = 1e-3, max = 1.0))]
    pub diameter_m: f64,
    /// Length of the center line, m.
    #[schemars(range(min = 1e-3, max = 1.0))]
    pub length_m: f64,
    /// Radius of curvature of the center line, m.
    #[schemars(range(max = 100.0))]
    pub curvature_radius_m: f64,
    /// Length of each rounded end, m.
    #[schemars(range(min = 1e-3))]
    pub end_length_m: f64,
    /// Diameter of the flat tips, m.
    pub tip_diameter_m: f64,
    /// Number of flat sides about the center line.
    #[serde(default = "default_sides")]
    pub sides: usize,
    /// Number of wedges between the ends; each end has some more.
    #[serde(default = "default_wedges")]
    pub wedges: usize,
}

/// Wedges of each rounded end.
pub const WEDGES_PER_END: usize = 4;

fn default_wedges() -> usize {
    10
}

impl Banana {
    /// Checks that the lengths make a banana.
    pub(super) fn validate(&self) -> Result<(), FieldError> {
        length("diameter_m", self.diameter_m)?;
        length("length_m", self.length_m)?;
        // the inner side would fold if the tube were bent about its own surface
        within("curvature_radius_m", self.curvature_radius_m, self.diameter_m, 100.0)?;
        if self.length_m > std::f64::consts::TAU * self.curvature_radius_m * 0.75 {
            let expected = "at most three quarters of a turn about curvature_radius_m";
            return Err(FieldError::new("length_m", self.length_m, expected));
        }
        within("end_length_m", self.end_length_m, 1e-3, 0.45 * self.length_m)?;
        within("tip_diameter_m", self.tip_diameter_m, 0.1 * self.diameter_m, self.diameter_m)?;
        sides(self.sides)?;
        match self.wedges {
            1..=64 => Ok(()),
            wedges => Err(FieldError::new("wedges", wedges, "a number from 1 to 64")),
        }
    }

    pub(super) fn scaled(&self, scale: f64) -> Self {
        Self {
            diameter_m: self.diameter_m * scale,
            length_m: self.length_m * scale,
            curvature_radius_m: self.curvature_radius_m * scale,
            end_length_m: self.end_length_m * scale,
            tip_diameter_m: self.tip_diameter_m * scale,
            ..*self
        }
    }

    /// The wedges, from one end to the other; neighbors share a ring of corners.
    pub(super) fn cells(&self) -> Result<Vec<ConvexCell>, GeometryError> {
        let rings = self.stations().into_iter().map(|(along, radius)| self.ring(along, radius)).collect::<Vec<_>>();
        rings.windows(2).map(|pair| wedge(&pair[0], &pair[1])).collect()
    }

    /// Places along the center line where it is sliced, from its middle, and the radius there, m.
    fn stations(&self) -> Vec<(f64, f64)> {
        let (radius, tip, end) = (self.diameter_m / 2.0, self.tip_diameter_m / 2.0, self.end_length_m);
        let straight = self.length_m / 2.0 - end;
        // a quarter of an ellipse from the tip to the full diameter
        let rounding = |step: usize| {
            let angle = FRAC_PI_2 * step as f64 / WEDGES_PER_END as f64;
            (straight + end * angle.cos(), tip + (radius - tip) * angle.sin())
        };
        let end = (0..WEDGES_PER_END).map(rounding).collect::<Vec<_>>();
        let middle = (0..=self.wedges).map(|wedge| {
            let share = 2.0 * wedge as f64 / self.wedges as f64 - 1.0;
            (straight * share, radius)
        });
        let behind = end.iter().map(|&(along, radius)| (-along, radius));
        behind.chain(middle).chain(end.iter().rev().copied()).collect()
    }

    /// The corners of a cross section, counterclockwise about the direction of the center line.
    fn ring(&self, along: f64, radius: f64) -> Vec<Point3<f64>> {
        let bend = self.curvature_radius_m;
        let (sine, cosine) = (along / bend).sin_cos();
        let corner = |side: usize| {
            let (across, up) = unit(side, self.sides);
            let arm = bend - radius * across;
            Point3::new(arm * sine, bend - arm * cosine, radius * up)
        };
        (0..self.sides).map(corner).collect()
    }
}

/// The convex hull of two cross sections with as many corners each.
///
/// Where the tube tapers, the four corners between two sides do not lie in a plane: they are joined along the diagonal that
/// bulges outwards.
fn wedge(behind: &[Point3<f64>], ahead: &[Point3<f64>]) -> Result<ConvexCell, GeometryError> {
    let count = behind.len();
    let vertices = behind.iter().chain(ahead).copied().collect::<Vec<_>>();
    let sides = (0..count).flat_map(|side| {
        let next = (side + 1) % count;
        outward(&vertices, [side, next, count + next, count + side])
    });
    let ends = [(0..count).rev().collect(), (count..2 * count).collect()];
    let faces = ends.into_iter().chain(sides).collect();
    ConvexCell::from_faces(vertices, faces)
}

/// Four corners farther from a plane than this are two triangles, m.
const PLANE_M: f64 = 1e-12;

/// A face of four corners, or the two triangles on the outer side of their tetrahedron.
fn outward(vertices: &[Point3<f64>], [a, b, c, d]: [usize; 4]) -> Vec<Vec<usize>> {
    let from_a = |corner: usize| vertices[corner] - vertices[a];
    let normal = from_a(b).cross(&from_a(c)).normalize();
    match normal.dot(&from_a(d)) {
        height if height.abs() < PLANE_M => vec![vec![a, b, c, d]],
        height if height < 0.0 => vec![vec![a, b, c], vec![a, c, d]],
        _ => vec![vec![a, b, d], vec![b, c, d]],
    }
}
