//! Which cells of a solid hold together.

use nalgebra::{Point2, Point3, Unit, Vector3};

use super::cell::{ConvexCell, Face, FaceKind};
use super::polygon;

/// A smaller area than this holds nothing together, m²: a micrometer by a micrometer.
const SMALLEST_BOND_M2: f64 = 1e-12;

/// Two cells that share part of a seam.
pub(super) struct Bond {
    /// Indices of the cells; the smaller one first.
    pub(super) cells: (usize, usize),
    /// Frame of the face that they share.
    pub(super) frame: FaceFrame,
    /// What they share of it.
    pub(super) shared: Vec<Point2<f64>>,
}

/// A face's own frame: its normal is the z axis.
pub(super) struct FaceFrame {
    origin: Point3<f64>,
    x: Vector3<f64>,
    y: Vector3<f64>,
}

impl FaceFrame {
    pub(super) fn new(origin: Point3<f64>, normal: &Unit<Vector3<f64>>) -> Self {
        // the axis least along the normal is the farthest from being parallel to it
        let mut axis = Vector3::zeros();
        axis[normal.iamin()] = 1.0;
        let x = normal.cross(&axis).normalize();
        Self { origin, x, y: normal.cross(&x) }
    }

    pub(super) fn flat(&self, point: &Point3<f64>) -> Point2<f64> {
        let arm = point - self.origin;
        Point2::new(self.x.dot(&arm), self.y.dot(&arm))
    }

    pub(super) fn in_space(&self, point: &Point2<f64>) -> Point3<f64> {
        self.origin + self.x * point.x + self.y * point.y
    }

    /// A face in this frame, counterclockwise as seen from the side that the frame's normal points to.
    pub(super) fn outline(&self, cell: &ConvexCell, face: &Face) -> Vec<Point2<f64>> {
        let mut outline =
            face.corners.iter().map(|&corner| self.flat(&cell.vertices[corner])).collect::<Vec<Point2<f64>>>();
        if polygon::area(&outline) < 0.0 {
            outline.reverse();
        }
        outline
    }
}

/// One face of a seam.
#[derive(Clone, Copy)]
pub(super) struct SeamFace<'a> {
    pub(super) seam: u32,
    pub(super) cell: usize,
    pub(super) face: &'a Face,
}

/// All faces of seams, those of a seam together.
pub(super) fn seam_faces(cells: &[ConvexCell]) -> Vec<SeamFace<'_>> {
    let of_cell = |(cell, shape): (usize, &'_ ConvexCell)| -> Vec<(usize, usize, u32)> {
        let numbered = shape.faces.iter().enumerate();
        numbered.filter_map(|(face, Face { kind, .. })| seam_of(*kind).map(|seam| (cell, face, seam))).collect()
    };
    let mut found = cells.iter().enumerate().flat_map(of_cell).collect::<Vec<_>>();
    found.sort_by_key(|&(cell, face, seam)| (seam, cell, face));
    found.into_iter().map(|(cell, face, seam)| SeamFace { seam, cell, face: &cells[cell].faces[face] }).collect()
}

fn seam_of(kind: FaceKind) -> Option<u32> {
    match kind {
        FaceKind::Seam(seam) => Some(seam),
        FaceKind::Skin | FaceKind::Cut => None,
    }
}

/// All bonds between cells, in the order of seams.
pub(super) fn bonds(cells: &[ConvexCell]) -> Vec<Bond> {
    let faces = seam_faces(cells);
    let mut bonds = Vec::new();
    for seam in faces.chunk_by(|one, other| one.seam == other.seam) {
        for (index, one) in seam.iter().enumerate() {
            bonds.extend(seam[index + 1..].iter().filter_map(|other| bond(cells, one, other)));
        }
    }
    bonds
}

/// The bond of two faces, if they lie against each other.
fn bond(cells: &[ConvexCell], one: &SeamFace<'_>, other: &SeamFace<'_>) -> Option<Bond> {
    if one.cell == other.cell || one.face.normal.dot(&other.face.normal) > 0.0 {
        return None;
    }
    let (first, second) = (&cells[one.cell], &cells[other.cell]);
    let frame = FaceFrame::new(first.vertices[one.face.corners[0]], &one.face.normal);
    let outline = frame.outline(first, one.face);
    let shared = match coincide(first, one.face, second, other.face) {
        true => outline,
        false => polygon::overlap(&outline, &frame.outline(second, other.face)),
    };
    let cells = (one.cell.min(other.cell), one.cell.max(other.cell));
    (polygon::area(&shared) >= SMALLEST_BOND_M2).then_some(Bond { cells, frame, shared })
}

/// Have two faces the same corners, bit by bit, run through in opposite directions?
pub(super) fn coincide(first: &ConvexCell, one: &Face, second: &ConvexCell, other: &Face) -> bool {
    let count = one.corners.len();
    if other.corners.len() != count {
        return false;
    }
    let corner = |step: usize| first.vertices[one.corners[step % count]];
    let against = |step: usize| second.vertices[other.corners[step % count]];
    let Some(start) = (0..count).find(|&start| against(start) == corner(0)) else { return false };
    (0..count).all(|step| corner(step) == against(start + count - step))
}

/// Groups cells that hold together: the number of each cell's group, groups numbered by their first cell.
pub(super) fn groups(count: usize, bonds: impl Iterator<Item = (usize, usize)>) -> Vec<usize> {
    let mut group = (0..count).collect::<Vec<_>>();
    for (one, other) in bonds {
        let (low, high) = (group[one].min(group[other]), group[one].max(group[other]));
        group.iter_mut().filter(|group| **group == high).for_each(|group| *group = low);
    }
    group
}
