//! A knife as the arm holds it.

use nalgebra::{Isometry3, Matrix3};
use parry3d::math::Vector;
use parry3d::shape::{ConvexPolyhedron, SharedShape};

use crate::cutting::knife::{self, Knife};
use crate::spatial::{Drawing, DrawnShape, HeldTool, Rgba, ToolPiece, TriangleMesh};

const STEEL: Rgba = [0.78, 0.80, 0.83, 1.0];
const HANDLE: Rgba = [0.16, 0.15, 0.15, 1.0];

/// Pose of the tool's frame in the knife's: the middle of the edge instead of its heel, with the same axes.
#[must_use]
pub fn knife_from_tool(knife: &Knife) -> Isometry3<f64> {
    Isometry3::translation(0.5 * knife.edge.length_m(), 0.0, 0.0)
}

/// The knife as a tool of the arm, its frame in the middle of the edge: x along it toward the tip, y the direction of the cut,
/// z the normal of the blade.
///
/// Its pieces touch the board. They do not touch the food of a [`super::CuttingProcess`], which takes care of that.
#[must_use]
pub fn held_knife(knife: &Knife, grip_from_tool: Isometry3<f64>) -> HeldTool {
    let tool_from_knife = knife_from_tool(knife).inverse();
    let turn: Matrix3<f64> = tool_from_knife.rotation.to_rotation_matrix().into_inner();
    let hulls: Vec<_> = knife.pieces.iter().filter_map(hull).collect();
    let last = hulls.len().saturating_sub(1);
    let drawing = |(index, hull): (usize, &ConvexPolyhedron)| Drawing {
        shape: DrawnShape::Mesh(mesh_of(hull)),
        body_from_shape: tool_from_knife,
        color: if index == last { HANDLE } else { STEEL },
    };
    let drawings = hulls.iter().enumerate().map(drawing).collect();
    let piece = |hull: ConvexPolyhedron| ToolPiece {
        shape: SharedShape::new(hull),
        tool_from_piece: tool_from_knife,
        friction: knife.edge.friction,
    };
    HeldTool {
        name: knife.name.clone(),
        mass_kg: knife.mass.mass_kg,
        center_of_mass_m: tool_from_knife * knife.mass.center_in_knife,
        inertia_kg_m2: turn * knife.mass.inertia_in_knife_kg_m2 * turn.transpose(),
        grip_from_tool,
        pieces: hulls.into_iter().map(piece).collect(),
        drawings,
    }
}

fn hull(piece: &knife::Piece) -> Option<ConvexPolyhedron> {
    let corners: Vec<Vector> = piece.iter().map(|corner| Vector::new(corner.x, corner.y, corner.z)).collect();
    ConvexPolyhedron::from_convex_hull(&corners)
}

fn mesh_of(hull: &ConvexPolyhedron) -> TriangleMesh {
    let (vertices, triangles) = hull.to_trimesh();
    let vertices = vertices.iter().map(|corner| nalgebra::Point3::new(corner.x, corner.y, corner.z)).collect();
    TriangleMesh { vertices, triangles, ..TriangleMesh::default() }
}
