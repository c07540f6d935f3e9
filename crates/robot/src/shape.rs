//! Primitive shapes of a link, for drawing and collision.

use nalgebra::{Isometry3, Vector3};

/// A primitive solid, centered on its own frame.
#[derive(Debug, Clone, Copy, PartialEq)]
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
}

/// A primitive placed on a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// The URDF link it belongs to.
    pub link: String,
    /// The solid.
    pub geometry: Geometry,
    /// Pose of the solid in the body frame.
    pub body_from_shape: Isometry3<f64>,
    /// Red, green, blue, opacity, each 0 to 1, if the URDF gives a color.
    pub color_rgba: Option<[f64; 4]>,
}
