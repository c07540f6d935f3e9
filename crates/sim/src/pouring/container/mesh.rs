//! Triangles to draw a vessel with.

use std::f64::consts::TAU;

use nalgebra::Point3;

use super::piece::{Piece, PieceShape};

/// Sides that stand for a disc's circle.
const DISC_SIDES: u32 = 48;

/// A closed triangle mesh; normals by the right-hand rule point out of the material.
#[derive(Clone, Debug, Default)]
pub struct DrawingMesh {
    /// Corners in the container's frame, m.
    pub points: Vec<Point3<f64>>,
    /// Indices of corners, three per triangle.
    pub triangles: Vec<[u32; 3]>,
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

    fn block(&mut self, corners: [Point3<f64>; 8]) {
        const QUADS: [[u32; 4]; 6] =
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let first = self.points.len() as u32;
        self.points.extend(corners);
        for [a, b, c, d] in QUADS {
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
