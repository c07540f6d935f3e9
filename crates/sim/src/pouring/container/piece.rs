//! One convex piece of a vessel's wall.

use nalgebra::{Isometry3, Point3};
use rapier3d::math::{Pose, Vector};
use rapier3d::prelude::SharedShape;

/// Shape of a piece in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum PieceShape {
    /// Box of half extents along x, y, z, m.
    Box {
        /// Half extents, m.
        half_extents_m: [f64; 3],
    },
    /// Disc about z.
    Disc {
        /// Radius, m.
        radius_m: f64,
        /// Half of the thickness, m.
        half_thickness_m: f64,
    },
    /// Six-sided block with corners as a box numbers them: bit 0 of the index is x, bit 1 y, bit 2 z.
    Block {
        /// Corners, m.
        corners: [Point3<f64>; 8],
    },
}

/// A convex piece and where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Pose of the piece in the container's frame.
    pub container_from_piece: Isometry3<f64>,
    /// Its shape.
    pub shape: PieceShape,
}

impl Piece {
    /// The piece as the engine wants it.
    pub(super) fn placed_shape(&self) -> (Pose, SharedShape) {
        let pose = Pose::from(self.container_from_piece);
        match &self.shape {
            PieceShape::Box { half_extents_m: [x, y, z] } => (pose, SharedShape::cuboid(*x, *y, *z)),
            PieceShape::Disc { radius_m, half_thickness_m } => {
                // the engine's cylinders stand along y
                let upright = nalgebra::UnitQuaternion::from_axis_angle(
                    &nalgebra::Vector3::x_axis(),
                    std::f64::consts::FRAC_PI_2,
                );
                let pose = Pose::from(self.container_from_piece * upright);
                (pose, SharedShape::cylinder(*half_thickness_m, *radius_m))
            }
            PieceShape::Block { corners } => {
                let points: Vec<Vector> = corners.iter().map(|c| Vector::new(c.x, c.y, c.z)).collect();
                let hull = SharedShape::convex_hull(&points);
                assert!(hull.is_some(), "a checked spout has corners that span a volume: {points:?}");
                (pose, hull.unwrap_or_else(|| SharedShape::ball(0.0)))
            }
        }
    }
}
