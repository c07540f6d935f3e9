//! Drawings as Rerun's shapes: solid primitives and meshes.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Point3, Vector3};
use rerun::components::FillMode;
use rerun::{
    Boxes3D, Capsules3D, Cylinders3D, Ellipsoids3D, Mesh3D, RecordingStream, RecordingStreamResult, Transform3D,
};
use sim::spatial::{Drawing, DrawnShape, Rgba, TriangleMesh};

/// Cosine of the angle up to which two faces that meet are lit as one round surface: 30 degrees.
const SMOOTH_COS: f64 = 0.866;
/// Corners nearer than this are one, m.
const WELD_M: f64 = 1e-6;

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
    let lit = if has_normals { None } else { Some(lit(mesh)) };
    let mesh = lit.as_ref().unwrap_or(mesh);
    let drawn = Mesh3D::new(mesh.vertices.iter().map(plain))
        .with_triangle_indices(mesh.triangles.iter().copied())
        .with_vertex_normals(mesh.normals.iter().map(plain_vector));
    if mesh.colors.len() == mesh.vertices.len() && !mesh.colors.is_empty() {
        drawn.with_vertex_colors(mesh.colors.iter().map(|color| bytes(*color)))
    } else {
        drawn.with_albedo_factor(rerun::Rgba32::from_unmultiplied_rgba(color[0], color[1], color[2], color[3]))
    }
}

/// The same surface with corners of its own for every triangle, lit round where the surface bends little and flat at its
/// edges: viewers light only meshes whose corners have normals.
fn lit(mesh: &TriangleMesh) -> TriangleMesh {
    let triangle = |corners: &[u32; 3]| {
        let [Some(a), Some(b), Some(c)] = corners.map(|corner| mesh.vertices.get(corner as usize)) else { return None };
        Some([*a, *b, *c])
    };
    // twice the area as a vector: large faces count more where several meet
    let area = |[a, b, c]: [Point3<f64>; 3]| (b - a).cross(&(c - a));
    let mut around: BTreeMap<[i64; 3], Vec<Vector3<f64>>> = BTreeMap::new();
    for corners in mesh.triangles.iter().filter_map(triangle) {
        corners.iter().for_each(|corner| around.entry(welded(corner)).or_default().push(area(corners)));
    }
    let mut apart = TriangleMesh::default();
    for corners in &mesh.triangles {
        let Some(places) = triangle(corners) else { continue };
        let normal = area(places).try_normalize(0.0).unwrap_or_else(Vector3::z);
        let bends_little = |area: &&Vector3<f64>| area.dot(&normal) >= area.norm() * SMOOTH_COS;
        let mean = |corner: &Point3<f64>| {
            let near: Vector3<f64> = around.get(&welded(corner)).into_iter().flatten().filter(bends_little).sum();
            near.try_normalize(0.0).unwrap_or(normal)
        };
        let first = apart.vertices.len() as u32;
        apart.triangles.push([first, first + 1, first + 2]);
        apart.vertices.extend(places);
        apart.normals.extend(places.iter().map(mean));
        apart.colors.extend(corners.iter().filter_map(|corner| mesh.colors.get(*corner as usize)));
    }
    apart
}

/// The place of a corner, equal for corners that are less than about a micrometer apart.
fn welded(corner: &Point3<f64>) -> [i64; 3] {
    // a cast saturates
    [corner.x, corner.y, corner.z].map(|value| (value / WELD_M).round() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_triangle_has_corners_of_its_own_which_face_outward_where_edges_are_sharp() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mesh = TriangleMesh {
            vertices: corners.map(Point3::from).to_vec(),
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 9, 1]],
            colors: vec![[1.0; 4]; 4],
            ..TriangleMesh::default()
        };
        let apart = lit(&mesh);
        assert_eq!((apart.vertices.len(), apart.triangles.as_slice()), (6, [[0, 1, 2], [3, 4, 5]].as_slice()));
        assert_eq!([apart.normals[0], apart.normals[3]], [-Vector3::z(), -Vector3::y()]);
        assert_eq!(apart.colors.len(), 6);
    }

    #[test]
    fn a_tube_of_many_sides_is_lit_as_a_round_one() {
        // the wall of a tube of 32 sides, each a triangle pair with corners of its own
        let mut mesh = TriangleMesh::default();
        for side in 0..32 {
            let at = |side: i32, z: f64| {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(side % 32) / 32.0).sin_cos();
                Point3::new(cos, sin, z)
            };
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend([at(side, 0.0), at(side + 1, 0.0), at(side + 1, 1.0), at(side, 1.0)]);
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
        let lit = lit(&mesh);
        for (corner, normal) in lit.vertices.iter().zip(&lit.normals) {
            // a corner belongs to two triangles of one side and to one of the other: off the radius by a sixth of 11 degrees
            assert!(normal.dot(&Vector3::new(corner.x, corner.y, 0.0)) > 0.999, "{corner} {normal}");
        }
    }
}
