//! What a scene's bodies look like: primitives and triangle meshes with a color, for whoever draws them.

use nalgebra::{Isometry3, Point3, Vector3};

/// Red, green, blue, opacity, each 0 to 1.
pub type Rgba = [f32; 4];

/// A colored shape, placed on the body that it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The shape in its own frame.
    pub shape: DrawnShape,
    /// Pose of the shape in the body (in the world for what does not move).
    pub body_from_shape: Isometry3<f64>,
    /// Its color.
    pub color: Rgba,
}

/// A shape, centered on its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum DrawnShape {
    /// A cuboid with these full edge lengths, m.
    Box {
        /// Edge lengths along x, y, z, m.
        size_m: Vector3<f64>,
    },
    /// A cylinder about z.
    Cylinder {
        /// Radius, m.
        radius_m: f64,
        /// Full length, m.
        length_m: f64,
    },
    /// A cylinder about z with half a ball on each end.
    Capsule {
        /// Radius, m.
        radius_m: f64,
        /// Length of the cylindrical part, m.
        length_m: f64,
    },
    /// A ball.
    Sphere {
        /// Radius, m.
        radius_m: f64,
    },
    /// Triangles.
    Mesh(TriangleMesh),
}

/// Triangles that are seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Corners in the body's frame, m.
    pub vertices: Vec<Point3<f64>>,
    /// Indices of three corners each, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Normal of each corner; empty for faceted bodies, whose viewers compute them.
    pub normals: Vec<Vector3<f64>>,
    /// Color of each corner; empty if the drawing's color serves all.
    pub colors: Vec<Rgba>,
}

impl Drawing {
    /// A drawing of a link's shape; `color` serves where the file gives none. `None` for a mesh whose file was not read.
    #[must_use]
    pub fn of_link_shape(shape: &robot::Shape, color: Rgba) -> Option<Self> {
        let drawn = match &shape.geometry {
            robot::Geometry::Box { size_m } => DrawnShape::Box { size_m: *size_m },
            robot::Geometry::Cylinder { radius_m, length_m } => {
                DrawnShape::Cylinder { radius_m: *radius_m, length_m: *length_m }
            }
            robot::Geometry::Capsule { radius_m, length_m } => {
                DrawnShape::Capsule { radius_m: *radius_m, length_m: *length_m }
            }
            robot::Geometry::Sphere { radius_m } => DrawnShape::Sphere { radius_m: *radius_m },
            robot::Geometry::Mesh { triangles, .. } => {
                let mesh = triangles.as_ref()?;
                DrawnShape::Mesh(TriangleMesh {
                    vertices: mesh.vertices_m.clone(),
                    triangles: mesh.triangles.clone(),
                    ..TriangleMesh::default()
                })
            }
        };
        let color = shape.color_rgba.map_or(color, |rgba| rgba.map(|value| value as f32));
        Some(Self { shape: drawn, body_from_shape: shape.body_from_shape, color })
    }
}
