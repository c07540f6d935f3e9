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

impl MassProperties {
    /// Least mass that the free body shows at a point of its frame in any direction, kg: 1/λ_max of the mobility
    /// 1/m − r̂ I⁻¹ r̂ with r̂ v = r × v, as what is pushed beside its center of mass turns too (Khatib, "A unified approach for motion and
    /// force control of robot manipulators", 1987). That of the whole mass if its inertia cannot be inverted.
    #[must_use]
    pub fn shown_at(&self, point: &Point3<f64>) -> f64 {
        self.mobility_at(point).map_or(self.mass_kg, |mobility| 1.0 / mobility.symmetric_eigenvalues().max())
    }

    /// The same in one direction, a vector of length one.
    #[must_use]
    pub fn shown_along(&self, point: &Point3<f64>, direction: &Vector3<f64>) -> f64 {
        self.mobility_at(point).map_or(self.mass_kg, |mobility| 1.0 / direction.dot(&(mobility * direction)))
    }

    /// Acceleration of a point by a force on it, 1/kg; none if the inertia cannot be inverted.
    fn mobility_at(&self, point: &Point3<f64>) -> Option<Matrix3<f64>> {
        let arm = (point - self.center).cross_matrix();
        let inverse = self.inertia_kg_m2.try_inverse()?;
        Some(Matrix3::identity() / self.mass_kg - arm * inverse * arm)
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn body(inertia: [f64; 3]) -> MassProperties {
        let inertia_kg_m2 = Matrix3::from_diagonal(&Vector3::from(inertia));
        MassProperties { mass_kg: 2.0, center: Point3::new(0.5, 0.0, 0.0), inertia_kg_m2 }
    }

    #[test]
    fn a_ball_shows_two_sevenths_of_its_mass_on_its_surface() {
        // 2/5 m r² with r = 0.1
        let ball = body([0.008; 3]);
        for at in [[0.6, 0.0, 0.0], [0.5, -0.1, 0.0], [0.5, 0.06, 0.08]] {
            assert_relative_eq!(ball.shown_at(&Point3::from(at)), 2.0 * 2.0 / 7.0, max_relative = 1e-12);
        }
        assert_relative_eq!(ball.shown_at(&ball.center), 2.0, max_relative = 1e-12);
    }

    #[test]
    fn a_rod_shows_a_quarter_of_its_mass_at_its_end() {
        // m L²/12 with L = 0.6, and hardly any about its axis, along which nothing turns it
        let rod = body([1e-9, 0.06, 0.06]);
        assert_relative_eq!(rod.shown_at(&Point3::new(0.8, 0.0, 0.0)), 0.5, max_relative = 1e-12);
        // along itself it shows its whole mass
        let end = Point3::new(0.8, 0.0, 0.0);
        assert_relative_eq!(rod.shown_along(&end, &Vector3::x()), rod.mass_kg, max_relative = 1e-12);
        assert_relative_eq!(rod.shown_along(&end, &Vector3::y()), 0.5, max_relative = 1e-12);
    }
}
