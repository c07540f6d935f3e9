//! Distance and depth between two convex outlines, exact and with its direction, without an engine's tolerances.
//!
//! An engine searches for the depth of an overlap and may give up where two polygons just touch. Outlines of a plan touch
//! all the time, and have few corners: every pair of corner and edge is looked at instead.

use nalgebra::{Point2, Vector2};

use super::Outline;

/// A convex outline as a polygon (or one point) and a radius round it.
#[derive(Debug, Clone)]
pub(crate) struct Convex {
    pub(crate) corners: Vec<Point2<f64>>,
    pub(crate) radius_m: f64,
}

impl Convex {
    /// The corners in the outline's own frame.
    pub(crate) fn new(outline: &Outline) -> Self {
        match outline {
            Outline::Disc { radius_m } => Self { corners: vec![Point2::origin()], radius_m: *radius_m },
            Outline::Box { .. } | Outline::Polygon { .. } => {
                Self { corners: outline.drawing(0).into_iter().map(Point2::from).collect(), radius_m: 0.0 }
            }
        }
    }

    /// The same outline with its corners moved by `place`.
    pub(crate) fn moved(&self, place: impl Fn(&Point2<f64>) -> Point2<f64>) -> Self {
        Self { corners: self.corners.iter().map(place).collect(), radius_m: self.radius_m }
    }

    /// Edges from corner to corner, counterclockwise; none of a point.
    fn edges(&self) -> impl Iterator<Item = (Point2<f64>, Point2<f64>)> + '_ {
        let next = self.corners.iter().cycle().skip(1);
        let some = if self.corners.len() > 1 { self.corners.len() } else { 0 };
        self.corners.iter().copied().zip(next.copied()).take(some)
    }
}

/// Distance between two outlines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gap {
    /// Distance, m; in overlap minus its depth.
    pub(crate) distance_m: f64,
    /// Direction in which the second outline leaves the first, unit vector in the frame of the first.
    pub(crate) outward: Vector2<f64>,
}

/// Gap between two outlines, the corners of the second `placed` in the frame of the first.
pub(crate) fn gap(first: &Convex, second: &Convex, placed: impl Fn(&Point2<f64>) -> Point2<f64>) -> Gap {
    let radii_m = first.radius_m + second.radius_m;
    let core = match overlap(first, second, &placed) {
        Some(core) if core.distance_m < 0.0 => core,
        _ => apart(first, second, &placed),
    };
    Gap { distance_m: core.distance_m - radii_m, ..core }
}

/// Greatest distance over all edges' outward normals: exact, as a negative depth, where the cores overlap (separating
/// axes); nothing for two points.
fn overlap(first: &Convex, second: &Convex, placed: &impl Fn(&Point2<f64>) -> Point2<f64>) -> Option<Gap> {
    let mut best: Option<Gap> = None;
    let mut keep = |distance_m: f64, outward: Vector2<f64>| {
        if best.is_none_or(|best| distance_m > best.distance_m) {
            best = Some(Gap { distance_m, outward });
        }
    };
    for (a, b) in first.edges() {
        let normal = right_of(&(b - a));
        let distance = |corner| (placed(corner) - a).dot(&normal);
        keep(second.corners.iter().map(distance).fold(f64::INFINITY, f64::min), normal);
    }
    for (a, b) in second.edges() {
        let (a, b) = (placed(&a), placed(&b));
        let normal = right_of(&(b - a));
        let distance = |corner: &Point2<f64>| (corner - a).dot(&normal);
        keep(first.corners.iter().map(distance).fold(f64::INFINITY, f64::min), -normal);
    }
    best
}

/// Distance of two cores that do not overlap: of a corner of one from a corner or an edge of the other.
fn apart(first: &Convex, second: &Convex, placed: &impl Fn(&Point2<f64>) -> Point2<f64>) -> Gap {
    let mut nearest = (f64::INFINITY, Vector2::zeros());
    let mut keep = |way: Vector2<f64>| {
        if way.norm_squared() < nearest.0 {
            nearest = (way.norm_squared(), way);
        }
    };
    for corner in second.corners.iter().map(placed) {
        first.corners.iter().for_each(|other| keep(corner - other));
        first.edges().for_each(|(a, b)| keep(corner - foot(&corner, &a, &b)));
    }
    for (a, b) in second.edges() {
        let (a, b) = (placed(&a), placed(&b));
        first.corners.iter().for_each(|corner| keep(foot(corner, &a, &b) - corner));
    }
    let distance_m = nearest.0.sqrt();
    // two cores that just touch have no direction between them; the separating axis has one
    let outward =
        nearest.1.try_normalize(SMALLEST_WAY_M).or_else(|| overlap(first, second, placed).map(|gap| gap.outward));
    Gap { distance_m, outward: outward.unwrap_or_else(Vector2::x) }
}

/// Distance below which its direction is lost in rounding, m.
const SMALLEST_WAY_M: f64 = 1e-12;

fn right_of(edge: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(edge.y, -edge.x) / edge.norm()
}

fn foot(point: &Point2<f64>, a: &Point2<f64>, b: &Point2<f64>) -> Point2<f64> {
    let edge = b - a;
    a + edge * ((point - a).dot(&edge) / edge.norm_squared()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::Isometry2;
    use proptest::prelude::*;

    use super::*;
    use crate::outline::separation_m;

    /// Accuracy of the engine's distances and depths for lengths of order one, m.
    const ENGINE_M: f64 = 1e-6;

    fn polygon() -> Outline {
        Outline::Polygon { vertices_m: vec![[-0.5, -0.4], [0.8, -0.2], [-0.1, 0.7]] }
    }

    /// What the physics engine finds, if it does.
    fn engine_m(first: &Outline, second: &Outline, pose: &Isometry2<f64>) -> Option<f64> {
        let (first, second) = (first.shape()?, second.shape()?);
        let there = parry2d::math::Vector::new(pose.translation.x, pose.translation.y);
        let there = parry2d::math::Pose::new(there, pose.rotation.angle());
        let here = parry2d::math::Pose::identity();
        let contact = parry2d::query::contact(&here, first.as_ref(), &there, second.as_ref(), f64::MAX);
        Some(contact.ok()??.dist)
    }

    proptest! {
        #[test]
        fn separations_are_those_of_the_physics_engine_where_it_has_one(
            x in -2.0f64..2.0, y in -2.0f64..2.0, angle_rad in -3.0f64..3.0, kinds in (0usize..3, 0usize..3),
        ) {
            let outlines = [Outline::Disc { radius_m: 0.4 }, Outline::Box { width_m: 1.5, height_m: 0.5 }, polygon()];
            let (first, second) = (&outlines[kinds.0], &outlines[kinds.1]);
            let pose = Isometry2::new(Vector2::new(x, y), angle_rad);
            let found = separation_m(first, &Isometry2::identity(), second, &pose).unwrap();
            let back = separation_m(second, &pose, first, &Isometry2::identity()).unwrap();
            prop_assert!((found - back).abs() < 1e-12, "{found} {back}");
            if let Some(expected) = engine_m(first, second, &pose) {
                prop_assert!((found - expected).abs() < ENGINE_M, "{found} {expected}");
            }
        }
    }

    #[test]
    fn polygons_that_just_touch_are_nothing_apart() {
        let side = Outline::Box { width_m: 0.040, height_m: 0.012 };
        let square =
            Outline::Polygon { vertices_m: vec![[-0.012, -0.012], [0.012, -0.012], [0.012, 0.012], [-0.012, 0.012]] };
        for (turn_rad, x) in [(0.0, 0.0), (0.0, 0.032), (0.7, 0.01), (-2.1, -0.02)] {
            let turn = Isometry2::rotation(turn_rad);
            let there = turn * Isometry2::translation(x, 0.018);
            let found = separation_m(&side, &turn, &square, &there).unwrap();
            assert_relative_eq!(found, 0.0, epsilon = 1e-15);
        }
    }
}
