//! A convex cell divided by a plane.
//!
//! Each face is divided along one chord, each undivided face goes to one side, and the open boundary that remains is closed
//! by the same cap on both sides, run through in opposite directions. The two parts therefore add up to the cell exactly,
//! whatever rounding does to a vertex or a normal: a degenerate plane can make a part thin, but not lose volume.

use std::cmp::Ordering;

use nalgebra::Point3;

use super::cell::{ConvexCell, Face, FaceKind};
use super::{Plane, topology};

/// A vertex this close to the plane counts as on it, m. It is ten times the rounding of a distance between food-sized
/// coordinates: vertices made by an earlier cut in the same plane lie on it, and what a face that is off its plane by this
/// much does to a volume stays below 1e-12 of it.
const ON_PLANE_M: f64 = 1e-15;

/// The two parts of a cell; none on a side where it has no vertex.
pub(super) type Parts = (Option<ConvexCell>, Option<ConvexCell>);

impl ConvexCell {
    /// Divides the cell by a plane into the parts on its negative and on its positive side.
    ///
    /// The volumes of the parts add up to that of the cell to rounding. A cell that only touches the plane is returned
    /// whole, on its side; so is, on the negative side, a cell that a plane with numbers that are not finite is put to.
    #[must_use]
    pub fn clip(&self, plane: &Plane) -> Parts {
        self.divide(plane, FaceKind::Cut)
    }

    /// Divides the cell; the new faces are of the given kind.
    pub(super) fn divide(&self, plane: &Plane, kind: FaceKind) -> Parts {
        let mut clipper = Clipper::new(self, plane);
        match (clipper.has(Ordering::Less), clipper.has(Ordering::Greater)) {
            (true, true) if plane.is_finite() => {}
            (false, true) => return (None, Some(self.clone())),
            _ => return (Some(self.clone()), None),
        }
        let (mut negative, mut positive) = clipper.faces();
        for walk in clipper.boundary(&negative) {
            // both begin at the same corner, so that a fan of triangles is the same fan on both sides
            let back = walk[..1].iter().chain(walk[1..].iter().rev()).copied().collect();
            negative.push(Face { corners: back, normal: plane.normal, kind });
            positive.push(Face { corners: walk, normal: -plane.normal, kind });
        }
        (Some(compact(&clipper.vertices, negative)), Some(compact(&clipper.vertices, positive)))
    }

    /// Returns the outlines of what the plane cuts out of the cell, counterclockwise as seen from the positive side.
    pub(super) fn outlines_on(&self, plane: &Plane) -> Vec<Vec<Point3<f64>>> {
        let mut clipper = Clipper::new(self, plane);
        let (negative, _) = clipper.faces();
        let walks = clipper.boundary(&negative);
        let points = |walk: Vec<usize>| walk.iter().rev().map(|&corner| clipper.vertices[corner]).collect();
        walks.into_iter().map(points).collect()
    }

    /// How far the cell reaches to the negative and to the positive side of the plane, m; negative if it does not.
    pub(super) fn reach(&self, plane: &Plane) -> (f64, f64) {
        let distances = self.vertices.iter().map(|vertex| plane.signed_distance(vertex));
        let reaches = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        distances.fold(reaches, |(negative, positive), distance| (negative.max(-distance), positive.max(distance)))
    }
}

/// A cell on its way through a plane.
struct Clipper<'a> {
    faces: &'a [Face],
    /// The cell's vertices, then those where its edges pass through the plane.
    vertices: Vec<Point3<f64>>,
    /// Signed distances of the cell's vertices; exactly 0 where they count as on the plane.
    distances: Vec<f64>,
    /// Edges (smaller index first) that pass through the plane, and the vertices where they do.
    crossings: Vec<((usize, usize), usize)>,
}

impl<'a> Clipper<'a> {
    fn new(cell: &'a ConvexCell, plane: &Plane) -> Self {
        let distance = |vertex: &Point3<f64>| match plane.signed_distance(vertex) {
            distance if distance.abs() <= ON_PLANE_M => 0.0,
            distance => distance,
        };
        let distances = cell.vertices.iter().map(distance).collect();
        Self { faces: &cell.faces, vertices: cell.vertices.clone(), distances, crossings: Vec::new() }
    }

    /// Does a vertex lie on the given side of the plane?
    fn has(&self, side: Ordering) -> bool {
        self.distances.iter().any(|distance| distance.partial_cmp(&0.0) == Some(side))
    }

    /// The open boundary of the faces on one side: it runs over vertices on the plane, unless rounding made a detour.
    fn boundary(&self, faces: &[Face]) -> Vec<Vec<usize>> {
        let on_plane = |corner: usize| self.distances.get(corner).is_none_or(|distance| *distance == 0.0);
        let corners = faces.iter().map(|face| face.corners.as_slice()).collect::<Vec<_>>();
        topology::boundary_loops(&corners, on_plane)
    }

    /// The faces, or parts of them, on the negative and on the positive side.
    fn faces(&mut self) -> (Vec<Face>, Vec<Face>) {
        let (mut negative, mut positive) = (Vec::new(), Vec::new());
        for face in self.faces {
            let on_side = |sign: f64| face.corners.iter().any(|&corner| self.distances[corner] * sign > 0.0);
            match (on_side(-1.0), on_side(1.0)) {
                (true, true) => {
                    let (below, above) = self.split_face(&face.corners);
                    negative.push(Face { corners: below, ..face.clone() });
                    positive.push(Face { corners: above, ..face.clone() });
                }
                (false, true) => positive.push(face.clone()),
                _ => negative.push(face.clone()),
            }
        }
        (negative, positive)
    }

    /// Divides a face along the chord between the two places where it passes through the plane.
    ///
    /// Rounding may give a face that nearly lies in the plane more than two such places. The arc from its highest to its
    /// lowest vertex is then left where it is last above the plane, and the arc back likewise, in either direction: the
    /// face of a neighbor, run through the other way, is divided along the same chord.
    fn split_face(&mut self, corners: &[usize]) -> (Vec<usize>, Vec<usize>) {
        let count = corners.len();
        let height = |step: usize| self.distances[corners[step % count]];
        let by_height = |one: &usize, other: &usize| height(*one).total_cmp(&height(*other));
        let top = (0..count).max_by(by_height).unwrap_or(0);
        let bottom = top + 1 + (top + 1..top + count).min_by(by_height).map_or(0, |step| step - top - 1);
        let leaving = (top..bottom).rev().find(|&step| height(step) > 0.0).unwrap_or(top);
        let entering = (bottom + 1..top + count).find(|&step| height(step) > 0.0).unwrap_or(top + count);

        let mut below = (leaving + 1..entering).map(|step| corners[step % count]).collect::<Vec<_>>();
        let mut above = (entering..=leaving + count).map(|step| corners[step % count]).collect::<Vec<_>>();
        let (first, last) = (corners[(leaving + 1) % count], corners[(entering - 1) % count]);
        if self.distances[first] != 0.0 {
            below.insert(0, self.crossing(corners[leaving % count], first));
        }
        if self.distances[last] != 0.0 {
            below.push(self.crossing(last, corners[entering % count]));
        }
        above.extend([below[0], below[below.len() - 1]]);
        (below, above)
    }

    /// The vertex where an edge passes through the plane.
    fn crossing(&mut self, one: usize, other: usize) -> usize {
        let edge = (one.min(other), one.max(other));
        if let Some((_, vertex)) = self.crossings.iter().find(|(crossed, _)| *crossed == edge) {
            return *vertex;
        }
        // the order of the points decides the rounding: a neighbor with other indices gets the same vertex, bit by bit
        let (from, to) = if before(&self.vertices[one], &self.vertices[other]) { (one, other) } else { (other, one) };
        let share = self.distances[from] / (self.distances[from] - self.distances[to]);
        let point = self.vertices[from] + (self.vertices[to] - self.vertices[from]) * share;
        self.vertices.push(point);
        self.crossings.push((edge, self.vertices.len() - 1));
        self.vertices.len() - 1
    }
}

/// Is `one` before `other` in the order of x, then y, then z?
fn before(one: &Point3<f64>, other: &Point3<f64>) -> bool {
    let order = one.iter().zip(other.iter()).map(|(one, other)| one.total_cmp(other));
    order.fold(Ordering::Equal, Ordering::then) == Ordering::Less
}

/// A cell of the faces, with the vertices that they use.
fn compact(vertices: &[Point3<f64>], mut faces: Vec<Face>) -> ConvexCell {
    let mut renamed = vec![None; vertices.len()];
    let mut used = Vec::new();
    for corner in faces.iter_mut().flat_map(|face| &mut face.corners) {
        let name = renamed[*corner].get_or_insert_with(|| {
            used.push(vertices[*corner]);
            used.len() - 1
        });
        *corner = *name;
    }
    ConvexCell { vertices: used, faces }
}

#[cfg(test)]
#[path = "clip_tests.rs"]
mod tests;
