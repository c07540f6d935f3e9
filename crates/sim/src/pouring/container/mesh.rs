//! Triangles to draw a vessel with.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use nalgebra::{Point3, Vector3};

use super::piece::{Piece, PieceShape};

/// Sides that stand for a disc's circle.
const DISC_SIDES: u32 = 48;

/// Faces of a block that look along −y and y.
const LEFT: usize = 2;
const RIGHT: usize = 3;
/// Lengths that differ by less are equal, m.
const SAME_M: f64 = 1e-7;
/// Largest deviation from one of the cosine of the angle between a plate and its side of the wall.
const ACROSS_ERROR: f64 = 1e-9;

/// A closed triangle mesh; normals by the right-hand rule point out of the material.
#[derive(Clone, Debug, Default)]
pub struct DrawingMesh {
    /// Corners in the container's frame, m.
    pub points: Vec<Point3<f64>>,
    /// Indices of corners, three per triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// A plate of a round wall: its corners, cut to its own side, and where it is.
struct Plate {
    corners: [Point3<f64>; 8],
    /// Number of its side, and lower and upper end in units of [`SAME_M`].
    place: (usize, [i64; 2]),
}

impl Plate {
    /// `None` for a piece that is none: a plate is a box that lies across the radius through its middle.
    fn of(piece: &Piece, facets: usize) -> Option<Self> {
        let PieceShape::Box { half_extents_m: [x, y, z] } = piece.shape else { return None };
        let pose = &piece.container_from_piece;
        let middle = pose.translation.vector;
        let radial = Vector3::new(middle.x, middle.y, 0.0).try_normalize(SAME_M)?;
        let around = Vector3::z().cross(&radial);
        if (pose.rotation * Vector3::y()).dot(&around) < 1.0 - ACROSS_ERROR {
            return None;
        }
        let slope = (PI / facets as f64).tan();
        let corners = std::array::from_fn(|index| {
            let sign = |bit: usize| if index & bit == 0 { -1.0 } else { 1.0 };
            let corner = pose * Point3::new(sign(1) * x, sign(2) * y, sign(4) * z);
            let (out, along) = (corner.coords.dot(&radial), corner.coords.dot(&around));
            let end = (out * slope).max(0.0);
            corner + around * (along.clamp(-end, end) - along)
        });
        let facet = (middle.y.atan2(middle.x).rem_euclid(TAU) * facets as f64 / TAU).round() as usize % facets;
        let heights = [0, 7].map(|corner: usize| corners.get(corner).map_or(0.0, |corner: &Point3<f64>| corner.z));
        Some(Self { corners, place: (facet, heights.map(|height| (height / SAME_M).round() as i64)) })
    }
}

impl DrawingMesh {
    pub(super) fn of(pieces: &[Piece]) -> Self {
        let mut mesh = Self::default();
        for piece in pieces {
            let start = mesh.points.len();
            match &piece.shape {
                PieceShape::Box { half_extents_m: [x, y, z] } => {
                    let sign = |index: usize, bit: usize| if index & bit == 0 { -1.0 } else { 1.0 };
                    mesh.block(std::array::from_fn(|i| Point3::new(sign(i, 1) * x, sign(i, 2) * y, sign(i, 4) * z)));
                }
                PieceShape::Block { corners } => mesh.block(*corners),
                PieceShape::Disc { radius_m, half_thickness_m } => mesh.disc(*radius_m, *half_thickness_m),
            }
            for point in mesh.points.iter_mut().skip(start) {
                *point = piece.container_from_piece * *point;
            }
        }
        mesh
    }

    /// The same pieces as they look: plates of a wall of `facets` sides overlap for no grain to slip through, and are drawn cut
    /// to their own sides, without the faces that neighbors share, which shine through glass as slats.
    pub(super) fn mitered(pieces: &[Piece], facets: usize) -> Self {
        let plates: Vec<Option<Plate>> = pieces.iter().map(|piece| Plate::of(piece, facets)).collect();
        let places: BTreeSet<_> = plates.iter().flatten().map(|plate| plate.place).collect();
        let mut mesh = Self::default();
        for (piece, plate) in pieces.iter().zip(plates) {
            let Some(Plate { corners, place: (facet, heights) }) = plate else {
                mesh.append(Self::of(std::slice::from_ref(piece)));
                continue;
            };
            let beside = |facet: usize| places.contains(&(facet % facets, heights));
            mesh.block_with(corners, |face| match face {
                LEFT => !beside(facet + facets - 1),
                RIGHT => !beside(facet + 1),
                _ => true,
            });
        }
        mesh
    }

    fn append(&mut self, other: Self) {
        let first = self.points.len() as u32;
        self.points.extend(other.points);
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
    }

    fn block(&mut self, corners: [Point3<f64>; 8]) {
        self.block_with(corners, |_| true);
    }

    /// The faces of a block that are `wanted` by their index.
    fn block_with(&mut self, corners: [Point3<f64>; 8], wanted: impl Fn(usize) -> bool) {
        const QUADS: [[u32; 4]; 6] =
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let first = self.points.len() as u32;
        self.points.extend(corners);
        for (_, [a, b, c, d]) in QUADS.into_iter().enumerate().filter(|(face, _)| wanted(*face)) {
            self.triangles.push([first + a, first + b, first + c]);
            self.triangles.push([first + a, first + c, first + d]);
        }
    }

    fn disc(&mut self, radius: f64, half_thickness: f64) {
        let first = self.points.len() as u32;
        self.points.push(Point3::new(0.0, 0.0, -half_thickness));
        self.points.push(Point3::new(0.0, 0.0, half_thickness));
        for side in 0..DISC_SIDES {
            let (sin, cos) = (TAU * f64::from(side) / f64::from(DISC_SIDES)).sin_cos();
            self.points.push(Point3::new(radius * cos, radius * sin, -half_thickness));
            self.points.push(Point3::new(radius * cos, radius * sin, half_thickness));
        }
        for side in 0..DISC_SIDES {
            let low = first + 2 + 2 * side;
            let next = first + 2 + 2 * ((side + 1) % DISC_SIDES);
            self.triangles.extend([
                [first, next, low],
                [first + 1, low + 1, next + 1],
                [low, next, next + 1],
                [low, next + 1, low + 1],
            ]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pouring::container::profile::Meridian;
    use crate::pouring::container::revolved;

    #[test]
    fn a_round_wall_is_drawn_without_the_faces_between_its_plates() {
        let (facets, radius_m, wall_m) = (16, 0.03, 0.003);
        let wall = Meridian::new(vec![(0.0, radius_m), (0.05, radius_m)]);
        let plates = revolved::plates(&wall, facets, wall_m, None);
        let mesh = DrawingMesh::mitered(&plates, facets);
        // inside, outside, top and bottom of each plate: two triangles each
        assert_eq!(mesh.triangles.len(), facets * 8);
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|corner| mesh.points[corner as usize]);
            let normal = (b - a).cross(&(c - a)).normalize();
            let out = Vector3::new(a.x + b.x + c.x, a.y + b.y + c.y, 0.0).normalize();
            assert!(normal.z.abs() > 0.99 || normal.dot(&out).abs() > 0.95, "{normal}");
        }
        // a plate that is missing lays two faces bare
        assert_eq!(DrawingMesh::mitered(&plates[1..], facets).triangles.len(), (facets - 1) * 8 + 4);
    }
}
