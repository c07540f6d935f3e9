//! Mass, center of mass and inertia of a vessel, out of the triangles that bound its pieces.

use nalgebra::{Matrix3, Point3, Vector3};

use super::DrawingMesh;

/// How the mass of a vessel is distributed, in the container's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContainerMass {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Center of mass, m.
    pub center_m: Point3<f64>,
    /// Inertia about the center of mass, container axes, kg m².
    pub inertia_kg_m2: Matrix3<f64>,
}

impl ContainerMass {
    /// The distribution of a solid of uniform density between triangles that face outward: sums over the tetrahedra between
    /// each triangle and the origin. Where closed parts overlap, the overlap counts for each.
    ///
    /// Not by the engine's mass properties of compounds: they are kept as principal moments with a rotation, and of a body of
    /// revolution, two of whose moments are equal, the rotation came out for another order of the moments.
    pub(super) fn of(mesh: &DrawingMesh, mass_kg: f64) -> Self {
        let (mut volume, mut moment, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
        let corner = |index: u32| mesh.points.get(index as usize).map_or_else(Vector3::zeros, |point| point.coords);
        for [a, b, c] in mesh.triangles.iter().map(|triangle| triangle.map(corner)) {
            let part = a.dot(&b.cross(&c)) / 6.0;
            let sum = a + b + c;
            volume += part;
            moment += sum * (part / 4.0);
            let squares = a * a.transpose() + b * b.transpose() + c * c.transpose();
            second += (squares + sum * sum.transpose()) * (part / 20.0);
        }
        let center = moment / volume;
        let spread = (second / volume - center * center.transpose()) * mass_kg;
        let inertia_kg_m2 = Matrix3::identity() * spread.trace() - spread;
        Self { mass_kg, center_m: center.into(), inertia_kg_m2 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pouring::{Container, ContainerFile, Profile, Straight};

    #[test]
    fn a_block_has_the_inertia_of_the_textbook() {
        let corner = |index: usize, bit: usize, half: f64| if index & bit == 0 { -half } else { half };
        let place = |i: usize| Point3::new(0.3 + corner(i, 1, 0.1), corner(i, 2, 0.2), corner(i, 4, 0.3));
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        let mesh = DrawingMesh { points: (0..8).map(place).collect(), triangles };
        let mass = ContainerMass::of(&mesh, 3.0);
        assert!((mass.center_m - Point3::new(0.3, 0.0, 0.0)).norm() < 1e-12);
        // m (b² + c²)/12 of edges 0.2, 0.4, 0.6
        let expected = Matrix3::from_diagonal(&Vector3::new(0.13, 0.10, 0.05));
        assert!((mass.inertia_kg_m2 - expected).norm() < 1e-12, "{}", mass.inertia_kg_m2);
    }

    /// The polygon of 32 sides and its overlapping corners differ from tube and disc by about this share.
    const POLYGON: f64 = 0.02;

    #[test]
    fn a_tall_cup_has_the_inertia_of_a_tube_and_a_disc_about_its_own_axes() {
        let (inner, outer, height, wall) = (0.035_f64, 0.038_f64, 0.09_f64, 0.003_f64);
        let file = ContainerFile {
            name: "cup".into(),
            description: String::new(),
            mass_kg: 0.08,
            friction: 0.3,
            restitution: 0.5,
            wall_m: wall,
            facets: 32,
            profile: Profile::Straight(Straight { radius_m: inner, height_m: height }),
            spout: None,
        };
        let found = Container::new(&file).unwrap().mass_properties();
        // the floor is a disc of the outer radius, the tube stands on it
        let (tube, disc) = ((outer * outer - inner * inner) * height, outer * outer * wall);
        let scale = 0.08 / (tube + disc);
        let (tube, disc) = (tube * scale, disc * scale);
        let center = (tube * (wall + 0.5 * height) + disc * 0.5 * wall) / 0.08;
        assert!((found.center_m.z - center).abs() < POLYGON * center, "{} {center}", found.center_m.z);
        let along = tube * (inner * inner + outer * outer) / 2.0 + disc * outer * outer / 2.0;
        let across = tube * ((inner * inner + outer * outer) / 4.0 + height * height / 12.0)
            + tube * (wall + 0.5 * height - center).powi(2)
            + disc * (outer * outer / 4.0 + wall * wall / 12.0)
            + disc * (0.5 * wall - center).powi(2);
        let inertia = found.inertia_kg_m2;
        // not exchanged: about its axis a tall cup turns more easily than across it
        assert!((inertia[(2, 2)] / along - 1.0).abs() < POLYGON, "{inertia} {along}");
        assert!((inertia[(0, 0)] / across - 1.0).abs() < POLYGON, "{inertia} {across}");
        assert!((inertia[(1, 1)] / across - 1.0).abs() < POLYGON, "{inertia} {across}");
    }
}
