//! The surface of a solid as triangles, for display and for checks.

use std::collections::BTreeMap;

use nalgebra::{Point3, Unit, Vector3};

use super::bonds::{self, FaceFrame, SeamFace};
use super::cell::{ConvexCell, FaceKind};
use super::{Solid, polygon};

/// What a triangle of a surface belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// The skin or crust.
    Skin,
    /// The face of a cut.
    Cut,
}

/// The outer surface of a solid.
///
/// Its triangles enclose the solid. After plane cuts every edge is shared by two triangles; where strips of a cut that
/// steers leave steps, corners of one triangle may lie within an edge of another.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Corners in the food's frame, m.
    pub vertices: Vec<Point3<f64>>,
    /// Indices of corners, counterclockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Outward normal of each triangle's face.
    pub normals: Vec<Unit<Vector3<f64>>>,
    /// What each triangle belongs to.
    pub surfaces: Vec<Surface>,
}

/// Exposed parts of a seam with less area are rounding, m²: a hundredth of a micrometer by a hundredth.
const SMALLEST_PART_M2: f64 = 1e-16;

impl Solid {
    /// Returns the outer surface; faces between cells that hold together are left out.
    #[must_use]
    pub fn mesh(&self) -> TriangleMesh {
        let mut builder = Builder::default();
        for cell in &self.cells {
            for face in &cell.faces {
                let surface = match face.kind {
                    FaceKind::Skin => Surface::Skin,
                    FaceKind::Cut => Surface::Cut,
                    FaceKind::Seam(_) => continue,
                };
                builder.add(&cell.corner_points(face), face.normal, surface);
            }
        }
        let faces = bonds::seam_faces(&self.cells);
        for seam in faces.chunk_by(|one, other| one.seam == other.seam) {
            for one in seam {
                let exposed = exposed(&self.cells, one, seam);
                exposed.iter().for_each(|outline| builder.add(outline, one.face.normal, Surface::Cut));
            }
        }
        builder.mesh
    }
}

/// The parts of a seam's face that no other cell lies against.
fn exposed(cells: &[ConvexCell], one: &SeamFace<'_>, seam: &[SeamFace<'_>]) -> Vec<Vec<Point3<f64>>> {
    let cell = &cells[one.cell];
    let against = |other: &&SeamFace<'_>| other.cell != one.cell && other.face.normal.dot(&one.face.normal) < 0.0;
    let others = seam.iter().filter(against).collect::<Vec<_>>();
    if others.iter().any(|other| bonds::coincide(cell, one.face, &cells[other.cell], other.face)) {
        return Vec::new();
    }
    let frame = FaceFrame::new(cell.vertices[one.face.corners[0]], &one.face.normal);
    let outline = frame.outline(cell, one.face);
    let others = others.iter().map(|other| frame.outline(&cells[other.cell], other.face));
    let others = others.filter(|other| polygon::area(&polygon::overlap(&outline, other)) >= SMALLEST_PART_M2);
    match others.collect::<Vec<_>>() {
        // no detour by the face's frame: the corners stay those of the neighbors, bit by bit
        none if none.is_empty() => vec![cell.corner_points(one.face)],
        others => {
            let parts = polygon::difference(&outline, &others, SMALLEST_PART_M2);
            parts.iter().map(|part| part.iter().map(|point| frame.in_space(point)).collect()).collect()
        }
    }
}

/// A mesh in the making, with the numbers of its vertices by their coordinates.
#[derive(Default)]
struct Builder {
    mesh: TriangleMesh,
    numbers: BTreeMap<[u64; 3], u32>,
}

impl Builder {
    /// Adds a convex polygon as a fan of triangles.
    fn add(&mut self, outline: &[Point3<f64>], normal: Unit<Vector3<f64>>, surface: Surface) {
        let corners = outline.iter().map(|point| self.number(point)).collect::<Vec<_>>();
        for pair in corners[1..].windows(2) {
            self.mesh.triangles.push([corners[0], pair[0], pair[1]]);
            self.mesh.normals.push(normal);
            self.mesh.surfaces.push(surface);
        }
    }

    fn number(&mut self, point: &Point3<f64>) -> u32 {
        // adding 0 turns -0 into 0, which is the same place
        let place = [point.x, point.y, point.z].map(|value| (value + 0.0).to_bits());
        let next = self.mesh.vertices.len() as u32;
        *self.numbers.entry(place).or_insert_with(|| {
            self.mesh.vertices.push(*point);
            next
        })
    }
}

#[cfg(test)]
#[path = "mesh_tests.rs"]
mod tests;
