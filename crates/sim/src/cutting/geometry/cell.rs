//! Convex polyhedra, the cells that solids are made of.

use nalgebra::{Point2, Point3, Unit, Vector3};

use super::{GeometryError, topology};

/// What lies on the other side of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FaceKind {
    /// The outside, since the food grew or was baked.
    Skin,
    /// The outside, since a cut.
    Cut,
    /// Cells of the same solid, where they have a face with the same number against it; else the outside, since a cut.
    Seam(u32),
}

/// A plane face of a cell.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Face {
    /// Indices of the vertices, counterclockwise as seen from outside.
    pub(super) corners: Vec<usize>,
    /// Outward normal. It is handed down when the face is cut, never computed anew: a sliver has the normal of its parent.
    pub(super) normal: Unit<Vector3<f64>>,
    pub(super) kind: FaceKind,
}

/// A closed convex polyhedron: vertices in the food's frame, and plane faces.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexCell {
    pub(super) vertices: Vec<Point3<f64>>,
    pub(super) faces: Vec<Face>,
}

/// A vertex may lie this far outside of a face's plane, m: a thousandth of a micrometer, far below any cut's width.
const OUT_OF_PLANE_M: f64 = 1e-9;

/// The smallest area of a face of a cell that is built: its normal would be noise otherwise, m².
const SMALLEST_FACE_M2: f64 = 1e-12;

impl ConvexCell {
    /// Makes a cuboid of the given half extents (m), centered on the origin and parallel to the axes.
    ///
    /// # Errors
    /// A [`GeometryError`] if an extent is not finite and positive.
    pub fn from_box(half_extents: &Vector3<f64>) -> Result<Self, GeometryError> {
        let (x, y, z) = (half_extents.x, half_extents.y, half_extents.z);
        let base = [[-x, -y], [x, -y], [x, y], [-x, y]].map(Point2::from);
        Self::prism(&base, -z, z)
    }

    /// Extrudes a convex, counterclockwise polygon of the x-y plane (m) from height `low_m` to `high_m`.
    ///
    /// # Errors
    /// A [`GeometryError`] if the polygon is not convex and counterclockwise, or the prism has no height.
    pub fn prism(base: &[Point2<f64>], low_m: f64, high_m: f64) -> Result<Self, GeometryError> {
        let count = base.len();
        let at_height = |height: f64| base.iter().map(move |point| Point3::new(point.x, point.y, height));
        let sides = (0..count).map(|side| {
            let next = (side + 1) % count;
            vec![side, next, count + next, count + side]
        });
        let faces = [(0..count).rev().collect(), (count..2 * count).collect()].into_iter().chain(sides);
        Self::from_faces(at_height(low_m).chain(at_height(high_m)).collect(), faces.collect())
    }

    /// Makes a cell of vertices (m, food frame) and faces (vertex indices, counterclockwise as seen from outside).
    ///
    /// # Errors
    /// A [`GeometryError`] if the faces do not close, are not plane to a nanometer, or enclose no convex body.
    pub fn from_faces(vertices: Vec<Point3<f64>>, faces: Vec<Vec<usize>>) -> Result<Self, GeometryError> {
        if let Some(vertex) = vertices.iter().find(|vertex| !vertex.iter().all(|value| value.is_finite())) {
            let found = format!("the vertex {vertex}");
            return Err(GeometryError::Value { operation: "build cell", found, expected: "finite coordinates" });
        }
        topology::check_closed(vertices.len(), &faces)?;
        let faces = faces.into_iter().enumerate().map(|(index, corners)| {
            let Some(normal) = newell_normal(&vertices, &corners) else {
                let found = "has no area".into();
                return Err(GeometryError::Face { face: index, found, vertices: vertices.len() });
            };
            Ok(Face { corners, normal, kind: FaceKind::Skin })
        });
        let faces = faces.collect::<Result<Vec<_>, _>>()?;
        let cell = Self { vertices, faces };
        cell.check_convex()?;
        match cell.volume_m3() {
            volume if volume > 0.0 => Ok(cell),
            volume => {
                let found = format!("a volume of {volume:e} m3");
                Err(GeometryError::Value { operation: "build cell", found, expected: "a volume greater than 0" })
            }
        }
    }

    /// Returns the cell with each coordinate multiplied by a factor of its own: a sphere becomes an ellipsoid.
    ///
    /// # Errors
    /// A [`GeometryError`] if a factor is not finite and positive, or nothing is left of a face.
    pub fn stretched(&self, factors: &Vector3<f64>) -> Result<Self, GeometryError> {
        let vertices = self.vertices.iter().map(|vertex| Point3::from(vertex.coords.component_mul(factors)));
        Self::from_faces(vertices.collect(), self.faces.iter().map(|face| face.corners.clone()).collect())
    }

    /// Checks that no vertex lies outside of a face, and that those of a face lie in its plane.
    fn check_convex(&self) -> Result<(), GeometryError> {
        for (index, face) in self.faces.iter().enumerate() {
            let at = self.vertices[face.corners[0]];
            let height = |vertex: usize| face.normal.dot(&(self.vertices[vertex] - at));
            let refusal = |vertex, distance_m, place: &str| GeometryError::NotConvex {
                vertex,
                distance_m,
                where_is: format!("{place} face {index}"),
            };
            if let Some(&vertex) = face.corners.iter().find(|&&vertex| height(vertex).abs() > OUT_OF_PLANE_M) {
                return Err(refusal(vertex, height(vertex).abs(), "off the plane of its"));
            }
            if let Some(vertex) = (0..self.vertices.len()).find(|&vertex| height(vertex) > OUT_OF_PLANE_M) {
                return Err(refusal(vertex, height(vertex), "outside of"));
            }
        }
        Ok(())
    }

    /// Returns the vertices, m, in the food's frame.
    #[must_use]
    pub fn vertices(&self) -> &[Point3<f64>] {
        &self.vertices
    }

    /// Iterates over the faces: corner points (m, counterclockwise as seen from outside), outward normal, and kind.
    pub fn faces(&self) -> impl Iterator<Item = (Vec<Point3<f64>>, Unit<Vector3<f64>>, FaceKind)> + '_ {
        self.faces.iter().map(|face| (self.corner_points(face), face.normal, face.kind))
    }

    /// The corner points of a face.
    pub(super) fn corner_points(&self, face: &Face) -> Vec<Point3<f64>> {
        face.corners.iter().map(|&corner| self.vertices[corner]).collect()
    }

    /// Does the straight line between two points (m, food's frame) meet the cell?
    #[must_use]
    pub fn meets(&self, from: &Point3<f64>, to: &Point3<f64>) -> bool {
        // the part of the line, as shares of it, that lies behind all faces
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for face in &self.faces {
            let at = self.vertices[face.corners[0]];
            let (start, end) = (face.normal.dot(&(from - at)), face.normal.dot(&(to - at)));
            match (start > 0.0, end > 0.0) {
                (true, true) => return false,
                (true, false) => first = first.max(start / (start - end)),
                (false, true) => last = last.min(start / (start - end)),
                (false, false) => {}
            }
        }
        first <= last
    }

    /// Returns how thick the cell is at its thinnest, measured along the normals of its faces, m.
    #[must_use]
    pub fn thickness_m(&self) -> f64 {
        let depth = |face: &Face| {
            let at = self.vertices[face.corners[0]];
            self.vertices.iter().map(|vertex| face.normal.dot(&(at - vertex))).fold(0.0, f64::max)
        };
        self.faces.iter().map(depth).fold(f64::INFINITY, f64::min)
    }
}

/// The normal of a polygon in space by Newell's sums; none if it has no area.
fn newell_normal(vertices: &[Point3<f64>], corners: &[usize]) -> Option<Unit<Vector3<f64>>> {
    let origin = vertices[corners[0]];
    let arms = corners.iter().map(|&corner| vertices[corner] - origin).collect::<Vec<_>>();
    let doubled: Vector3<f64> = arms.windows(2).map(|pair| pair[0].cross(&pair[1])).sum();
    Unit::try_new(doubled, 2.0 * SMALLEST_FACE_M2)
}

#[cfg(test)]
#[path = "cell_tests.rs"]
mod tests;
