//! Distances from an outline and between outlines.

use nalgebra::{Isometry2, Point2, Vector2};

use super::{Convex, Outline, edges, gap};

impl Outline {
    /// Distance of the centroid from the nearest side, m: the radius of the largest disc about it inside the outline.
    #[must_use]
    pub fn inscribed_radius_m(&self) -> f64 {
        -self.signed_distance_m(&self.centroid())
    }

    /// Largest distance of a point of the outline from its origin, m.
    #[must_use]
    pub fn radius_m(&self) -> f64 {
        match self {
            Self::Disc { radius_m } => *radius_m,
            Self::Box { width_m, height_m } => 0.5 * width_m.hypot(*height_m),
            Self::Polygon { vertices_m } => vertices_m.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max),
        }
    }

    /// Distance from the origin of the line that touches the outline from the direction `angle_rad`, m.
    #[must_use]
    pub fn support_m(&self, angle_rad: f64) -> f64 {
        let direction = Vector2::new(angle_rad.cos(), angle_rad.sin());
        match self {
            Self::Disc { radius_m } => *radius_m,
            Self::Box { width_m, height_m } => 0.5 * (width_m * direction.x.abs() + height_m * direction.y.abs()),
            Self::Polygon { vertices_m } => {
                let reach = |vertex: &[f64; 2]| Vector2::from(*vertex).dot(&direction);
                vertices_m.iter().map(reach).fold(f64::NEG_INFINITY, f64::max)
            }
        }
    }

    /// Ends of the side whose outward normal is nearest to `direction` (unit vector, the outline's frame), m, if it is so
    /// to within `within_rad`: something flat that touches from there lies against it. A disc has none.
    #[must_use]
    pub fn side_towards(&self, direction: &Vector2<f64>, within_rad: f64) -> Option<[Point2<f64>; 2]> {
        if matches!(self, Self::Disc { .. }) {
            return None;
        }
        let corners = self.drawing(0);
        let off = |(a, b): &(Point2<f64>, Point2<f64>)| {
            let outward = Vector2::new((b - a).y, (a - b).x);
            outward.perp(direction).atan2(outward.dot(direction)).abs()
        };
        let nearest = edges(&corners).min_by(|first, second| off(first).total_cmp(&off(second)))?;
        (off(&nearest) <= within_rad).then_some([nearest.0, nearest.1])
    }

    /// Signed distance of a point (in the outline's frame, m): negative inside.
    #[must_use]
    pub fn signed_distance_m(&self, point: &Point2<f64>) -> f64 {
        match self {
            Self::Disc { radius_m } => point.coords.norm() - radius_m,
            Self::Box { width_m, height_m } => {
                let q = Vector2::new(point.x.abs() - width_m / 2.0, point.y.abs() - height_m / 2.0);
                q.sup(&Vector2::zeros()).norm() + q.max().min(0.0)
            }
            Self::Polygon { vertices_m } => polygon_distance(vertices_m, point),
        }
    }
}

/// Distance between two outlines at their poses, m: in overlap minus its depth; `None` if one is not a valid outline.
#[must_use]
pub fn separation_m(first: &Outline, pose1: &Isometry2<f64>, second: &Outline, pose2: &Isometry2<f64>) -> Option<f64> {
    first.validate().and(second.validate()).ok()?;
    let first_from_second = pose1.inv_mul(pose2);
    let found = gap(&Convex::new(first), &Convex::new(second), |corner| first_from_second * corner);
    Some(found.distance_m)
}

fn polygon_distance(vertices: &[[f64; 2]], point: &Point2<f64>) -> f64 {
    let mut inside = vertices.len() >= 3;
    let mut distance = f64::INFINITY;
    for (a, b) in edges(vertices) {
        let edge = b - a;
        let along = ((point - a).dot(&edge) / edge.norm_squared()).clamp(0.0, 1.0);
        distance = distance.min((point - (a + edge * along)).norm());
        inside &= edge.perp(&(point - a)) >= 0.0;
    }
    if inside { -distance } else { distance }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_inscribed_radius_is_the_distance_to_the_nearest_side() {
        let triangle = Outline::Polygon { vertices_m: vec![[5.0, 5.0], [8.0, 5.0], [5.0, 9.0]] };
        // the centroid of a triangle lies at a third of each height; the smallest is 12/5
        assert_relative_eq!(triangle.inscribed_radius_m(), 0.8, epsilon = 1e-12);
        assert_relative_eq!(Outline::Box { width_m: 3.0, height_m: 1.0 }.inscribed_radius_m(), 0.5);
        assert_relative_eq!(Outline::Disc { radius_m: 0.012 }.inscribed_radius_m(), 0.012);
    }

    #[test]
    fn the_side_of_a_box_is_found_from_its_direction() {
        let flat = Outline::Box { width_m: 4.0, height_m: 2.0 };
        let [a, b] = flat.side_towards(&Vector2::new(0.005, 1.0).normalize(), 0.01).unwrap();
        assert_eq!((a, b), (Point2::new(2.0, 1.0), Point2::new(-2.0, 1.0)));
        assert_eq!(flat.side_towards(&Vector2::new(0.02, 1.0).normalize(), 0.01), None);
        assert_eq!(Outline::Disc { radius_m: 1.0 }.side_towards(&Vector2::x(), 0.01), None);
    }

    #[test]
    fn separation_is_a_distance_apart_and_a_depth_in_overlap() {
        let (disc, square) = (Outline::Disc { radius_m: 1.0 }, Outline::Box { width_m: 2.0, height_m: 2.0 });
        for (x, expected) in [(5.0, 3.0), (2.0, 0.0), (1.5, -0.5)] {
            let apart = separation_m(&disc, &Isometry2::translation(x, 0.0), &square, &Isometry2::identity());
            assert_relative_eq!(apart.unwrap(), expected, epsilon = 1e-9);
        }
    }

    #[test]
    fn an_invalid_outline_has_no_separation() {
        let disc = Outline::Disc { radius_m: 1.0 };
        for vertices_m in [vec![], vec![[0.0, 0.0]], vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], vec![[f64::NAN; 2]; 3]] {
            let nothing = Outline::Polygon { vertices_m };
            assert_eq!(separation_m(&nothing, &Isometry2::identity(), &disc, &Isometry2::identity()), None);
        }
    }
}
