//! Bodies of revolution: one convex cell from a convex profile.

use nalgebra::Point3;

use crate::cutting::geometry::{ConvexCell, GeometryError};

/// A point of a profile: place along the axis and distance from it, m.
pub(super) type ProfilePoint = (f64, f64);

/// Where the axis of a body points in the food's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axis {
    /// Along x: the body lies.
    X,
    /// Along z: the body stands.
    Z,
}

/// Turns a profile about an axis, with corners on the true surface.
///
/// The profile begins and ends on the axis, or with a flat end; in between it keeps off the axis.
pub(super) fn revolved(profile: &[ProfilePoint], sides: usize, axis: Axis) -> Result<ConvexCell, GeometryError> {
    let mut vertices = Vec::new();
    let rings = profile.iter().map(|&(along, radius)| ring(&mut vertices, along, radius, sides, axis));
    let rings = rings.collect::<Vec<_>>();
    let mut faces = rings.windows(2).flat_map(|pair| band(&pair[0], &pair[1])).collect::<Vec<_>>();
    faces.extend(rings.first().filter(|ring| ring.len() > 1).map(|ring| ring.iter().rev().copied().collect()));
    faces.extend(rings.last().filter(|ring| ring.len() > 1).cloned());
    ConvexCell::from_faces(vertices, faces)
}

/// Adds the corners of one ring, counterclockwise about the axis, and returns their indices; a single one on the axis.
fn ring(vertices: &mut Vec<Point3<f64>>, along: f64, radius: f64, sides: usize, axis: Axis) -> Vec<usize> {
    let start = vertices.len();
    let count = if radius == 0.0 { 1 } else { sides };
    vertices.extend((0..count).map(|side| {
        let (across, up) = unit(side, sides);
        match axis {
            Axis::X => Point3::new(along, radius * across, radius * up),
            Axis::Z => Point3::new(radius * across, radius * up, along),
        }
    }));
    (start..start + count).collect()
}

/// The direction of one corner of a regular polygon. A side faces along each axis, so that a lying body lies on a face.
pub(super) fn unit(side: usize, sides: usize) -> (f64, f64) {
    let angle = std::f64::consts::TAU * (side as f64 + 0.5) / sides as f64;
    (angle.cos(), angle.sin())
}

/// The faces between two rings.
fn band(behind: &[usize], ahead: &[usize]) -> Vec<Vec<usize>> {
    let sides = behind.len().max(ahead.len());
    let corner = |ring: &[usize], side: usize| ring[side % ring.len()];
    let face = |side: usize| {
        let around = [corner(behind, side), corner(behind, side + 1), corner(ahead, side + 1), corner(ahead, side)];
        let mut face = around.to_vec();
        face.dedup();
        face
    };
    (0..sides).map(face).collect()
}
