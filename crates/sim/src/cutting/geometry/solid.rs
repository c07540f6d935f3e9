//! Solids: rigid pieces of convex cells that come apart where they are cut.

use nalgebra::{Isometry3, Point2, Point3};

use super::bonds::{self, Bond};
use super::cell::{ConvexCell, FaceKind};
use super::clip::Parts;
use super::cut_surface::Piece;
use super::mass::Moments;
use super::{CutSurface, GeometryError, MassProperties, Plane, Section, Side, polygon};

/// A cell that reaches less than this beyond a plane is not cut by it, m: what would come off, thinner than a hundredth of
/// a plant cell, stays with the cell.
pub const SLIVER_M: f64 = 1e-6;

/// Outlines of less area are not part of a section, m².
const SMALLEST_SECTION_M2: f64 = 1e-14;

/// A rigid piece: convex cells in one frame, the food's, which hold together where they share faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    pub(super) cells: Vec<ConvexCell>,
    /// Number of the next seam.
    seams: u32,
}

impl Solid {
    /// Joins cells into a solid. Two cells hold together where they have a whole face in common, with the same coordinates.
    ///
    /// # Errors
    /// A [`GeometryError`] if there is no cell, or the cells do not all hold together.
    pub fn from_cells(mut cells: Vec<ConvexCell>) -> Result<Self, GeometryError> {
        let refusal = |found: String, expected| GeometryError::Value { operation: "join cells", found, expected };
        if cells.is_empty() {
            return Err(refusal("no cells".into(), "at least one cell"));
        }
        let seams = number_seams(&mut cells);
        let groups = bonds::groups(cells.len(), bonds::bonds(&cells).iter().map(|bond| bond.cells));
        match groups.iter().position(|&group| group != 0) {
            None => Ok(Self { cells, seams }),
            Some(cell) => {
                let found = format!("cell {cell} apart from cell 0");
                Err(refusal(found, "cells that hold together; give neighbors a whole face with the same corners"))
            }
        }
    }

    /// Returns the cells, in the food's frame.
    #[must_use]
    pub fn cells(&self) -> &[ConvexCell] {
        &self.cells
    }

    /// Returns the smallest and the greatest coordinates, m.
    #[must_use]
    pub fn bounds(&self) -> (Point3<f64>, Point3<f64>) {
        let nowhere = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
        let vertices = self.cells.iter().flat_map(ConvexCell::vertices);
        vertices.fold(nowhere, |(low, high), vertex| (low.inf(vertex), high.sup(vertex)))
    }

    /// Does the straight line between two points (m, food's frame) meet the solid?
    #[must_use]
    pub fn meets(&self, from: &Point3<f64>, to: &Point3<f64>) -> bool {
        self.cells.iter().any(|cell| cell.meets(from, to))
    }

    /// Returns the volume, m³.
    #[must_use]
    pub fn volume_m3(&self) -> f64 {
        self.moments(&self.anchor()).volume_m3()
    }

    /// Returns mass, center of mass and inertia at a density, kg/m³.
    #[must_use]
    pub fn mass_properties(&self, density_kg_per_m3: f64) -> MassProperties {
        let anchor = self.anchor();
        self.moments(&anchor).with_density(density_kg_per_m3, &anchor)
    }

    fn moments(&self, point: &Point3<f64>) -> Moments {
        self.cells.iter().map(|cell| Moments::of(cell, point)).fold(Moments::default(), Moments::plus)
    }

    /// A point of the solid to measure from.
    fn anchor(&self) -> Point3<f64> {
        self.cells.first().map(ConvexCell::anchor).unwrap_or_default()
    }

    /// Returns what the x-y plane of the section's frame cuts out of the solid.
    ///
    /// It is exactly what [`Solid::split`] would cut: cells that reach less than [`SLIVER_M`] beyond the plane count for
    /// nothing, and a plane in which two cells meet gives what holds them together.
    #[must_use]
    pub fn section(&self, food_from_section: &Isometry3<f64>) -> Section {
        let plane = Plane::of_frame(food_from_section);
        let section_from_food = food_from_section.inverse();
        let flat = |outline: Vec<Point3<f64>>| -> Vec<Point2<f64>> {
            outline.iter().map(|point| (section_from_food * point).xy()).collect()
        };
        let mut polygons = Vec::new();
        let mut whole = Vec::with_capacity(self.cells.len());
        for cell in &self.cells {
            let side = side_of(cell, &plane);
            if side.is_none() {
                polygons.extend(cell.outlines_on(&plane).into_iter().map(flat));
            }
            whole.push(side);
        }
        let sides = |bond: &Bond| whole[bond.cells.0].zip(whole[bond.cells.1]);
        for bond in self.bonds_across(&whole).filter(|bond| sides(bond).is_some_and(|(one, other)| one != other)) {
            polygons.push(flat(bond.shared.iter().map(|point| bond.frame.in_space(point)).collect()));
        }
        for outline in polygons.iter_mut().filter(|outline| polygon::area(outline) < 0.0) {
            outline.reverse();
        }
        polygons.retain(|outline| polygon::area(outline) >= SMALLEST_SECTION_M2);
        Section { food_from_section: *food_from_section, polygons }
    }

    /// The bonds, if there are uncut cells on both sides of a plane: else none of them can be cut.
    fn bonds_across(&self, whole: &[Option<Side>]) -> impl Iterator<Item = Bond> + use<> {
        let both = [Side::Negative, Side::Positive].iter().all(|side| whole.contains(&Some(*side)));
        if both { bonds::bonds(&self.cells) } else { Vec::new() }.into_iter()
    }

    /// Divides the solid by a plane into the pieces that no longer hold together, in the same frame; those on the negative
    /// side come first. A plane that misses the solid gives the solid back.
    ///
    /// Volume, mass, center of mass and inertia of the pieces add up to those of the solid, to rounding.
    #[must_use]
    pub fn split(&self, plane: &Plane) -> Vec<Solid> {
        let parts = self.cells.iter().flat_map(|cell| sides_of(cell, plane, FaceKind::Cut));
        assemble(parts.collect(), self.seams).into_iter().map(|piece| piece.solid).collect()
    }

    /// Divides the solid by a cut that steers or turns into the pieces that no longer hold together, in the same frame;
    /// those on the negative side come first.
    ///
    /// Every cell is divided at the borders of the strips, every part by the plane of its strip. Parts on different sides
    /// do not hold together, also where the planes of two strips do not meet on their border and leave a step.
    #[must_use]
    pub fn split_along(&self, cut: &CutSurface) -> Vec<Piece> {
        let parts = self.cells.iter().flat_map(|cell| self.strips_of(cell, cut)).collect();
        assemble(parts, self.seams + cut.borders().len() as u32)
    }

    /// A cell divided by the strips of a cut; whole, if it lies on one side of them all.
    fn strips_of(&self, cell: &ConvexCell, cut: &CutSurface) -> Vec<(Side, ConvexCell)> {
        let (mut parts, mut rest) = (Vec::new(), Some(cell.clone()));
        for (seam, (border, plane)) in (self.seams..).zip(cut.borders().iter().zip(cut.planes())) {
            let Some(ahead) = rest.take() else { break };
            let (before, after) = divide(&ahead, border, FaceKind::Seam(seam));
            parts.extend(before.iter().flat_map(|part| sides_of(part, plane, FaceKind::Cut)));
            rest = after;
        }
        if let (Some(part), Some(plane)) = (rest, cut.planes().last()) {
            parts.extend(sides_of(&part, plane, FaceKind::Cut));
        }
        match parts.first() {
            Some(&(side, _)) if parts.iter().all(|(other, _)| *other == side) => vec![(side, cell.clone())],
            _ => parts,
        }
    }
}

/// The side of a plane on which a cell lies but for a sliver; none if the plane cuts it.
fn side_of(cell: &ConvexCell, plane: &Plane) -> Option<Side> {
    let (negative, positive) = cell.reach(plane);
    match negative.min(positive) {
        sliver if sliver > SLIVER_M => None,
        _ if positive > negative => Some(Side::Positive),
        _ => Some(Side::Negative),
    }
}

/// Divides a cell by a plane, but for slivers.
fn divide(cell: &ConvexCell, plane: &Plane, kind: FaceKind) -> Parts {
    match side_of(cell, plane) {
        None => cell.divide(plane, kind),
        Some(Side::Negative) => (Some(cell.clone()), None),
        Some(Side::Positive) => (None, Some(cell.clone())),
    }
}

/// The parts of a cell on the sides of a plane, each with its side.
fn sides_of(cell: &ConvexCell, plane: &Plane, kind: FaceKind) -> Vec<(Side, ConvexCell)> {
    let (negative, positive) = divide(cell, plane, kind);
    let negative = negative.map(|part| (Side::Negative, part));
    negative.into_iter().chain(positive.map(|part| (Side::Positive, part))).collect()
}

/// Joins cells into the pieces that hold together on the same side.
fn assemble(mut parts: Vec<(Side, ConvexCell)>, seams: u32) -> Vec<Piece> {
    parts.sort_by_key(|(side, _)| *side);
    let (sides, cells): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
    let bonds = bonds::bonds(&cells);
    let same_side = bonds.iter().map(|bond| bond.cells).filter(|&(one, other)| sides[one] == sides[other]);
    let groups = bonds::groups(cells.len(), same_side);
    let mut pieces: Vec<(usize, Piece)> = Vec::new();
    for ((cell, side), group) in cells.into_iter().zip(sides).zip(groups) {
        match pieces.iter_mut().find(|(named, _)| *named == group) {
            Some((_, piece)) => piece.solid.cells.push(cell),
            None => pieces.push((group, Piece { side, solid: Solid { cells: vec![cell], seams } })),
        }
    }
    pieces.into_iter().map(|(_, piece)| piece).collect()
}

/// Numbers the faces that two cells have in common, and returns how many there are.
fn number_seams(cells: &mut [ConvexCell]) -> u32 {
    let mut shared = Vec::new();
    for (index, one) in cells.iter().enumerate() {
        for (gap, other) in cells[index + 1..].iter().enumerate() {
            let faces =
                one.faces.iter().enumerate().flat_map(|face| other.faces.iter().enumerate().map(move |b| (face, b)));
            let common = faces.filter(|((_, a), (_, b))| bonds::coincide(one, a, other, b));
            shared.extend(common.map(|((a, _), (b, _))| [(index, a), (index + 1 + gap, b)]));
        }
    }
    for (seam, faces) in (0..).zip(&shared) {
        faces.iter().for_each(|&(cell, face)| cells[cell].faces[face].kind = FaceKind::Seam(seam));
    }
    shared.len() as u32
}

#[cfg(test)]
#[path = "solid_tests.rs"]
mod tests;
