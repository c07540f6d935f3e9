//! Volume, mass, center of mass and inertia of polyhedra, by the divergence theorem.

use nalgebra::{Matrix3, Point3, Vector3};

use super::ConvexCell;

/// Mass, center of mass and inertia of a body of uniform density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Center of mass in the food's frame, m.
    pub center: Point3<f64>,
    /// Inertia about the center of mass, in the food's axes, kg m².
    pub inertia_kg_m2: Matrix3<f64>,
}

/// Integrals of 1, x and x xᵀ over a body, where x is measured from a point of choice. One near the body keeps rounding small.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    volume: f64,
    first: Vector3<f64>,
    second: Matrix3<f64>,
}

impl Moments {
    /// Sums the tetrahedra between one vertex of the cell and the triangles of its faces, then measures from `point`.
    pub(super) fn of(cell: &ConvexCell, point: &Point3<f64>) -> Self {
        let Some(&apex) = cell.vertices.first() else { return Self::default() };
        let mut about_apex = Self::default();
        for face in &cell.faces {
            let arm = |corner: usize| cell.vertices[corner] - apex;
            let first = arm(face.corners[0]);
            for pair in face.corners[1..].windows(2) {
                about_apex.add_tetrahedron(&first, &arm(pair[0]), &arm(pair[1]));
            }
        }
        about_apex.moved(&(apex - point))
    }

    /// Adds a tetrahedron with one corner in the origin.
    fn add_tetrahedron(&mut self, a: &Vector3<f64>, b: &Vector3<f64>, c: &Vector3<f64>) {
        let volume = a.dot(&b.cross(c)) / 6.0;
        let sum = a + b + c;
        self.volume += volume;
        self.first += sum * (volume / 4.0);
        let products = a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose();
        self.second += products * (volume / 20.0);
    }

    /// The moments of the body when it is moved by `by`.
    fn moved(&self, by: &Vector3<f64>) -> Self {
        let mixed = self.first * by.transpose();
        let second = self.second + mixed + mixed.transpose() + by * by.transpose() * self.volume;
        Self { volume: self.volume, first: self.first + by * self.volume, second }
    }

    /// The moments of two bodies together.
    pub(super) fn plus(self, other: Self) -> Self {
        Self { volume: self.volume + other.volume, first: self.first + other.first, second: self.second + other.second }
    }

    pub(super) fn volume_m3(&self) -> f64 {
        self.volume
    }

    /// Mass properties at a density, kg/m³, of moments measured from `point`.
    pub(super) fn with_density(&self, density_kg_per_m3: f64, point: &Point3<f64>) -> MassProperties {
        // the center of a body without volume is nowhere; any place is as good for no mass
        let center = if self.volume == 0.0 { Vector3::zeros() } else { self.first / self.volume };
        let about_center = self.moved(&-center).second * density_kg_per_m3;
        MassProperties {
            mass_kg: self.volume * density_kg_per_m3,
            center: point + center,
            inertia_kg_m2: Matrix3::identity() * about_center.trace() - about_center,
        }
    }
}

impl ConvexCell {
    /// Returns the volume, m³.
    #[must_use]
    pub fn volume_m3(&self) -> f64 {
        Moments::of(self, &self.anchor()).volume
    }

    /// Returns mass, center of mass and inertia at a density, kg/m³.
    #[must_use]
    pub fn mass_properties(&self, density_kg_per_m3: f64) -> MassProperties {
        let anchor = self.anchor();
        Moments::of(self, &anchor).with_density(density_kg_per_m3, &anchor)
    }

    /// A point of the cell to measure from.
    pub(super) fn anchor(&self) -> Point3<f64> {
        self.vertices.first().copied().unwrap_or_default()
    }
}
