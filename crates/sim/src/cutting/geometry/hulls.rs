//! Colliders of a solid: one convex polyhedron per cell.

use nalgebra::Point3;
use rapier3d::math::Vector;
use rapier3d::prelude::SharedShape;

use super::{ConvexCell, Solid};

/// Thinner cells have mass but no collider, m. The engine takes features below 0.2 mm for degenerate.
pub const THINNEST_COLLIDER_M: f64 = 3e-4;

/// Share of its volume that a piece may lack to its hull and still count as convex.
pub const HOLLOW_SHARE: f64 = 0.01;

/// Corners closer than this to one that is kept are left out of a collider, m.
const SAME_CORNER_M: f64 = 1e-5;

impl Solid {
    /// Returns a collider for each cell that is thick enough for the engine, in the food's frame.
    #[must_use]
    pub fn hulls(&self) -> Vec<SharedShape> {
        self.cells.iter().filter_map(hull).collect()
    }

    /// Returns the colliders of a piece: one hull of it all if it is convex but for [`HOLLOW_SHARE`] of its volume, as most
    /// slices are, else one for each cell.
    #[must_use]
    pub fn colliders(&self) -> Vec<SharedShape> {
        let corners: Vec<_> = self.cells.iter().flat_map(|cell| cell.vertices().iter().copied()).collect();
        let whole = if self.is_crumb() { None } else { hull_of(&corners) };
        match whole.filter(|hull| hull.mass_properties(1.0).mass() < (1.0 + HOLLOW_SHARE) * self.volume_m3()) {
            Some(hull) => vec![hull],
            None => self.hulls(),
        }
    }

    /// Is the piece a crumb, too thin to collide? It is counted with its mass, but nothing can rest on it.
    #[must_use]
    pub fn is_crumb(&self) -> bool {
        self.cells.iter().all(|cell| cell.thickness_m() < THINNEST_COLLIDER_M)
    }
}

/// The collider of one cell; none if it is too thin.
fn hull(cell: &ConvexCell) -> Option<SharedShape> {
    if cell.thickness_m() < THINNEST_COLLIDER_M {
        return None;
    }
    hull_of(cell.vertices())
}

/// The convex hull of points, but for those that hardly differ.
fn hull_of(points: &[Point3<f64>]) -> Option<SharedShape> {
    let mut corners: Vec<Point3<f64>> = Vec::with_capacity(points.len());
    for vertex in points {
        if corners.iter().all(|corner| (corner - vertex).norm_squared() > SAME_CORNER_M * SAME_CORNER_M) {
            corners.push(*vertex);
        }
    }
    SharedShape::convex_hull(
        &corners.iter().map(|corner| Vector::new(corner.x, corner.y, corner.z)).collect::<Vec<_>>(),
    )
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Vector3};

    use super::super::Plane;
    use super::*;

    fn block() -> Solid {
        Solid::from_cells(vec![ConvexCell::from_box(&Vector3::new(0.02, 0.02, 0.015)).unwrap()]).unwrap()
    }

    #[test]
    fn a_collider_has_the_mass_of_its_cell() {
        let solid = block();
        let [hull] = &solid.hulls()[..] else { panic!("one cell, one collider") };
        let mass = hull.mass_properties(1000.0).mass();
        // the engine sums the same tetrahedra in another order
        assert!((mass - solid.mass_properties(1000.0).mass_kg).abs() < 1e-12, "{mass}");
    }

    #[test]
    fn a_convex_piece_has_one_collider_and_a_bent_one_that_of_each_cell() {
        let halves = block().split(&Plane::of_frame(&Isometry3::identity()));
        let quarters = halves[0].split(&Plane::of_frame(&Isometry3::new(Vector3::zeros(), Vector3::y())));
        assert!(quarters.iter().all(|quarter| quarter.colliders().len() == 1));
        // three equal boxes in the form of an L
        let boxed = |x: f64, z: f64| {
            let base = [[x, 0.0], [x + 0.01, 0.0], [x + 0.01, 0.01], [x, 0.01]].map(nalgebra::Point2::from);
            ConvexCell::prism(&base, z, z + 0.01).unwrap()
        };
        let bent = Solid::from_cells(vec![boxed(0.0, 0.0), boxed(0.01, 0.0), boxed(0.0, 0.01)]).unwrap();
        assert_eq!(bent.colliders().len(), 3);
    }

    #[test]
    fn a_slice_thinner_than_the_engine_bears_is_a_crumb() {
        let thin = block().split(&Plane::of_frame(&Isometry3::translation(0.0, 0.0, -0.015 + 2e-4)));
        assert!(thin[0].is_crumb() && thin[0].hulls().is_empty());
        assert!(!thin[1].is_crumb() && thin[1].hulls().len() == 1);
    }
}
