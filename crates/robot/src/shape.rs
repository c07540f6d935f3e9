//! Shapes of a link, for drawing and collision.

use std::sync::Arc;

use nalgebra::{Isometry3, Vector3};

use crate::mesh::TriangleMesh;

/// A primitive solid, centered on its own frame, or a mesh in it.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// A cuboid with these full edge lengths (m).
    Box {
        /// Edge lengths along x, y, z (m).
        size_m: Vector3<f64>,
    },
    /// A cylinder about z.
    Cylinder {
        /// Radius (m).
        radius_m: f64,
        /// Full length along z (m).
        length_m: f64,
    },
    /// A cylinder about z with a half sphere on each end.
    Capsule {
        /// Radius (m).
        radius_m: f64,
        /// Length of the cylindrical part along z (m).
        length_m: f64,
    },
    /// A ball.
    Sphere {
        /// Radius (m).
        radius_m: f64,
    },
    /// A surface of triangles from a file.
    Mesh {
        /// The file as the URDF names it.
        uri: String,
        /// Factors along x, y, z; negative ones mirror.
        scale: Vector3<f64>,
        /// The triangles, scaled; `None` until [`crate::Manipulator::resolve_meshes`] has read them.
        triangles: Option<Arc<TriangleMesh>>,
    },
}

/// A shape placed on a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// The URDF link it belongs to.
    pub link: String,
    /// The solid or mesh.
    pub geometry: Geometry,
    /// Pose of the shape's frame in the body frame.
    pub body_from_shape: Isometry3<f64>,
    /// Red, green, blue, opacity, each 0 to 1, if the URDF gives a color.
    pub color_rgba: Option<[f64; 4]>,
}
