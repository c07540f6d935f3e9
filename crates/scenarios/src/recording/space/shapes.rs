//! Drawings as Rerun's shapes: solid primitives and meshes.

use nalgebra::{Isometry3, Point3, Vector3};
use rerun::components::FillMode;
use rerun::{
    Boxes3D, Capsules3D, Cylinders3D, Ellipsoids3D, Mesh3D, RecordingStream, RecordingStreamResult, Transform3D,
};
use sim::spatial::{Drawing, DrawnShape, Rgba, TriangleMesh};

/// A point as Rerun takes it.
pub(super) fn plain(point: &Point3<f64>) -> [f32; 3] {
    [point.x as f32, point.y as f32, point.z as f32]
}

/// A vector as Rerun takes it.
pub(super) fn plain_vector(vector: &Vector3<f64>) -> [f32; 3] {
    [vector.x as f32, vector.y as f32, vector.z as f32]
}

/// The quaternion of a pose, x first.
pub(super) fn quaternion(pose: &Isometry3<f64>) -> rerun::Quaternion {
    rerun::Quaternion::from_xyzw([
        pose.rotation.i as f32,
        pose.rotation.j as f32,
        pose.rotation.k as f32,
        pose.rotation.w as f32,
    ])
}

/// A color as bytes.
pub(super) fn bytes(color: Rgba) -> [u8; 4] {
    // a cast saturates
    color.map(|share| (share * 255.0).round() as u8)
}

/// Entity of one of the drawings below `path`.
pub(super) fn shape_path(path: &str, index: usize) -> String {
    format!("{path}/shape_{index}")
}

/// Sends drawings below `path`, each as an entity of its own, without time.
pub(super) fn send_static(stream: &RecordingStream, path: &str, drawings: &[Drawing]) -> RecordingStreamResult<()> {
    drawings.iter().enumerate().try_for_each(|(index, drawing)| {
        let path = shape_path(path, index);
        stream.log_static(path.as_str(), &placed(&drawing.body_from_shape))?;
        stream.log_static(path.as_str(), shape(drawing).as_ref())
    })
}

/// Sends drawings below `path` at the stream's present time.
pub(super) fn send(stream: &RecordingStream, path: &str, drawings: &[Drawing]) -> RecordingStreamResult<()> {
    drawings.iter().enumerate().try_for_each(|(index, drawing)| {
        let path = shape_path(path, index);
        stream.log(path.as_str(), &placed(&drawing.body_from_shape))?;
        stream.log(path.as_str(), shape(drawing).as_ref())
    })
}

fn placed(pose: &Isometry3<f64>) -> Transform3D {
    Transform3D::from_translation_rotation(plain_vector(&pose.translation.vector), quaternion(pose))
}

fn shape(drawing: &Drawing) -> Box<dyn rerun::AsComponents> {
    let color = bytes(drawing.color);
    match &drawing.shape {
        DrawnShape::Box { size_m } => Box::new(
            Boxes3D::from_half_sizes([plain_vector(&(size_m * 0.5))])
                .with_colors([color])
                .with_fill_mode(FillMode::Solid),
        ),
        DrawnShape::Cylinder { radius_m, length_m } => Box::new(
            Cylinders3D::from_lengths_and_radii([*length_m as f32], [*radius_m as f32])
                .with_colors([color])
                .with_fill_mode(FillMode::Solid),
        ),
        // a capsule begins at its origin here, and is centered there
        DrawnShape::Capsule { radius_m, length_m } => Box::new(
            Capsules3D::from_lengths_and_radii([*length_m as f32], [*radius_m as f32])
                .with_translations([[0.0, 0.0, -0.5 * *length_m as f32]])
                .with_colors([color])
                .with_fill_mode(FillMode::Solid),
        ),
        DrawnShape::Sphere { radius_m } => {
            Box::new(Ellipsoids3D::from_radii([*radius_m as f32]).with_colors([color]).with_fill_mode(FillMode::Solid))
        }
        DrawnShape::Mesh(mesh) => Box::new(triangles(mesh, color)),
    }
}

fn triangles(mesh: &TriangleMesh, color: [u8; 4]) -> Mesh3D {
    let has_normals = mesh.normals.len() == mesh.vertices.len();
    let faceted = if has_normals { None } else { Some(faceted(mesh)) };
    let mesh = faceted.as_ref().unwrap_or(mesh);
    let drawn = Mesh3D::new(mesh.vertices.iter().map(plain))
        .with_triangle_indices(mesh.triangles.iter().copied())
        .with_vertex_normals(mesh.normals.iter().map(plain_vector));
    if mesh.colors.len() == mesh.vertices.len() && !mesh.colors.is_empty() {
        drawn.with_vertex_colors(mesh.colors.iter().map(|color| bytes(*color)))
    } else {
        drawn.with_albedo_factor(rerun::Rgba32::from_unmultiplied_rgba(color[0], color[1], color[2], color[3]))
    }
}

/// The same surface with corners of its own for every triangle, which face where the triangle faces: viewers light only
/// meshes whose corners have normals.
fn faceted(mesh: &TriangleMesh) -> TriangleMesh {
    let mut apart = TriangleMesh::default();
    for corners in &mesh.triangles {
        let places = corners.map(|corner| mesh.vertices.get(corner as usize));
        let [Some(a), Some(b), Some(c)] = places else { continue };
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(Vector3::z);
        let first = apart.vertices.len() as u32;
        apart.triangles.push([first, first + 1, first + 2]);
        apart.vertices.extend([a, b, c]);
        apart.normals.extend([normal; 3]);
        apart.colors.extend(corners.iter().filter_map(|corner| mesh.colors.get(*corner as usize)));
    }
    apart
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_triangle_of_a_faceted_mesh_faces_outward_with_its_own_corners() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mesh = TriangleMesh {
            vertices: corners.map(Point3::from).to_vec(),
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 9, 1]],
            colors: vec![[1.0; 4]; 4],
            ..TriangleMesh::default()
        };
        let apart = faceted(&mesh);
        assert_eq!((apart.vertices.len(), apart.triangles.as_slice()), (6, [[0, 1, 2], [3, 4, 5]].as_slice()));
        assert_eq!([apart.normals[0], apart.normals[3]], [-Vector3::z(), -Vector3::y()]);
        assert_eq!(apart.colors.len(), 6);
    }
}
