//! Where the center of an object may be: a rectangle, less what is nearer to an obstacle than a clearance.

use nalgebra::{Point2, distance};

use crate::field::{FieldError, finite, not_negative};
use crate::outline::{Outline, PlacedOutline};

/// The free places of an object's center, world frame; straight ways between them are checked exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeSpace {
    min_m: [f64; 2],
    max_m: [f64; 2],
    clearance_m: f64,
    barriers: Vec<Barrier>,
}

/// An obstacle in the world frame.
#[derive(Clone, Debug, PartialEq)]
enum Barrier {
    Disc { center: Point2<f64>, radius_m: f64 },
    // convex, vertices counterclockwise
    Polygon(Vec<Point2<f64>>),
}

impl FreeSpace {
    /// The rectangle from `min_m` to `max_m` for the center (already less the object's radius if the map is meant to hold
    /// all of it), in which the center keeps `clearance_m` from `obstacles`, all m in the world frame.
    ///
    /// # Errors
    /// A [`FieldError`] naming the argument that is no number, empty, negative or no outline.
    pub fn new(
        min_m: [f64; 2],
        max_m: [f64; 2],
        clearance_m: f64,
        obstacles: &[PlacedOutline],
    ) -> Result<Self, FieldError> {
        finite("min_m", &min_m)?;
        finite("max_m", &max_m)?;
        not_negative("clearance_m", clearance_m)?;
        if min_m.iter().zip(&max_m).any(|(min, max)| min >= max) {
            return Err(FieldError::new(
                "max_m",
                format!("{max_m:?}"),
                format!("more than min_m, {min_m:?}, on each axis"),
            ));
        }
        for (index, obstacle) in obstacles.iter().enumerate() {
            obstacle.validate().map_err(|error| error.within(format!("obstacles.{index}")))?;
        }
        Ok(Self { min_m, max_m, clearance_m, barriers: obstacles.iter().map(Barrier::new).collect() })
    }

    /// Corners of least and of greatest coordinates of the rectangle, m.
    #[must_use]
    pub fn bounds_m(&self) -> ([f64; 2], [f64; 2]) {
        (self.min_m, self.max_m)
    }

    /// Whether the center may be at a place, world frame.
    #[must_use]
    pub fn is_free(&self, place: &Point2<f64>) -> bool {
        self.is_way_free(place, place)
    }

    /// Whether the center may go straight from one place to another, world frame.
    ///
    /// Exact up to rounding: the rectangle is convex, and the distance of the whole segment from each obstacle is computed.
    #[must_use]
    pub fn is_way_free(&self, from: &Point2<f64>, to: &Point2<f64>) -> bool {
        let inside =
            |place: &Point2<f64>| (0..2).all(|axis| (self.min_m[axis]..=self.max_m[axis]).contains(&place[axis]));
        inside(from) && inside(to) && self.barriers.iter().all(|barrier| barrier.is_cleared(from, to, self.clearance_m))
    }
}

impl Barrier {
    fn new(obstacle: &PlacedOutline) -> Self {
        let pose = obstacle.pose();
        match &obstacle.shape {
            Outline::Disc { radius_m } => Self::Disc { center: pose.translation.vector.into(), radius_m: *radius_m },
            other => Self::Polygon(other.drawing(0).into_iter().map(|vertex| pose * Point2::from(vertex)).collect()),
        }
    }

    fn is_cleared(&self, from: &Point2<f64>, to: &Point2<f64>, clearance_m: f64) -> bool {
        match self {
            Self::Disc { center, radius_m } => distance_from_segment(center, from, to) >= radius_m + clearance_m,
            Self::Polygon(vertices) => {
                !enters(vertices, from, to) && distance_from_outside(vertices, from, to) >= clearance_m
            }
        }
    }
}

fn edges(vertices: &[Point2<f64>]) -> impl Iterator<Item = (&Point2<f64>, &Point2<f64>)> {
    vertices.iter().zip(vertices.iter().cycle().skip(1))
}

fn distance_from_segment(point: &Point2<f64>, from: &Point2<f64>, to: &Point2<f64>) -> f64 {
    let way = to - from;
    let length2 = way.norm_squared();
    let share = if length2 > 0.0 { ((point - from).dot(&way) / length2).clamp(0.0, 1.0) } else { 0.0 };
    distance(point, &(from + way * share))
}

/// Whether a segment enters a convex polygon: what the half-planes of all its sides leave of the segment (Cyrus and Beck).
fn enters(vertices: &[Point2<f64>], from: &Point2<f64>, to: &Point2<f64>) -> bool {
    let way = to - from;
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (a, b) in edges(vertices) {
        let side = b - a;
        // depth beyond this side along the way is depth + rate·share, positive inside
        let (depth, rate) = (side.perp(&(from - a)), side.perp(&way));
        if rate > 0.0 {
            first = first.max(-depth / rate);
        } else if rate < 0.0 {
            last = last.min(-depth / rate);
        } else if depth <= 0.0 {
            return false;
        }
    }
    // a segment that is a point has no rate: it is inside if it got here
    first < last
}

/// Distance of a segment from a convex polygon that it does not enter: one of its ends or a vertex is nearest.
fn distance_from_outside(vertices: &[Point2<f64>], from: &Point2<f64>, to: &Point2<f64>) -> f64 {
    let near = |(a, b)| {
        distance_from_segment(from, a, b).min(distance_from_segment(to, a, b)).min(distance_from_segment(a, from, to))
    };
    edges(vertices).map(near).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Looks along a segment lie this far apart: a distance changes no faster than the place.
    const LOOK_M: f64 = 1e-4;

    fn shapes() -> [Outline; 3] {
        [
            Outline::Disc { radius_m: 0.02 },
            Outline::Box { width_m: 0.03, height_m: 0.04 },
            Outline::Polygon { vertices_m: vec![[-0.02, -0.01], [0.03, 0.0], [0.0, 0.02]] },
        ]
    }

    fn space(shape: Outline, angle_rad: f64, clearance_m: f64) -> FreeSpace {
        let obstacle = PlacedOutline { shape, position_m: [0.01, 0.1], angle_rad };
        FreeSpace::new([-0.09, 0.0], [0.09, 0.18], clearance_m, &[obstacle]).unwrap()
    }

    #[test]
    fn a_way_past_a_box_is_free_down_to_its_clearance() {
        let space = space(shapes()[1].clone(), 0.0, 0.027);
        // the lower side lies at 80 mm
        for (y, free) in [(0.053 - 1e-9, true), (0.053 + 1e-9, false), (0.1, false), (-1e-9, false)] {
            assert_eq!(space.is_way_free(&Point2::new(-0.05, y), &Point2::new(0.06, y)), free, "{y}");
        }
        // a corner is rounded: beyond it on the diagonal by 27 mm
        let corner = Point2::new(0.025, 0.08);
        let beyond = |gap: f64| corner + nalgebra::Vector2::new(gap, -gap) / std::f64::consts::SQRT_2;
        assert!(space.is_free(&beyond(0.027 + 1e-9)) && !space.is_free(&beyond(0.027 - 1e-9)));
    }

    #[test]
    fn a_way_into_or_through_an_obstacle_is_barred_without_any_clearance() {
        for shape in shapes() {
            let space = space(shape, 0.0, 0.0);
            let (inside, outside) = (Point2::new(0.012, 0.1), Point2::new(-0.08, 0.1));
            assert!(!space.is_free(&inside) && space.is_free(&outside));
            for (from, to) in [(inside, outside), (outside, Point2::new(0.08, 0.1)), (inside, inside)] {
                assert!(!space.is_way_free(&from, &to) && !space.is_way_free(&to, &from));
            }
        }
        // along a side is touching, not entering
        let space = space(shapes()[1].clone(), 0.0, 0.0);
        assert!(space.is_way_free(&Point2::new(-0.05, 0.08 - 1e-12), &Point2::new(0.05, 0.08 - 1e-12)));
    }

    #[test]
    fn spaces_that_are_none_are_refused_by_name() {
        let field = |min_m, max_m, clearance_m, obstacles: &[PlacedOutline]| {
            FreeSpace::new(min_m, max_m, clearance_m, obstacles).unwrap_err().field
        };
        assert_eq!(field([f64::NAN, 0.0], [1.0; 2], 0.0, &[]), "min_m");
        assert_eq!(field([0.0; 2], [1.0, f64::INFINITY], 0.0, &[]), "max_m");
        assert_eq!(field([0.0; 2], [1.0, 0.0], 0.0, &[]), "max_m");
        assert_eq!(field([0.0; 2], [1.0; 2], -0.1, &[]), "clearance_m");
        let bad = PlacedOutline { shape: Outline::Disc { radius_m: 0.0 }, position_m: [0.0; 2], angle_rad: 0.0 };
        assert_eq!(field([0.0; 2], [1.0; 2], 0.0, &[bad]), "obstacles.0.shape.disc.radius_m");
    }

    proptest! {
        #[test]
        fn the_exact_check_agrees_with_many_looks(
            from in (-0.09f64..0.09, 0.0f64..0.18), to in (-0.09f64..0.09, 0.0f64..0.18),
            kind in 0usize..3, angle in -3.0f64..3.0, clearance_m in 0.0f64..0.04,
        ) {
            let (from, to) = (Point2::new(from.0, from.1), Point2::new(to.0, to.1));
            let obstacle = PlacedOutline { shape: shapes()[kind].clone(), position_m: [0.01, 0.1], angle_rad: angle };
            let looks = ((to - from).norm() / LOOK_M).ceil().max(1.0) as usize;
            let least = (0..=looks)
                .map(|look| obstacle.signed_distance_m(&(from + (to - from) * (look as f64 / looks as f64))))
                .fold(f64::INFINITY, f64::min);
            let space = space(shapes()[kind].clone(), angle, clearance_m);
            if space.is_way_free(&from, &to) {
                prop_assert!(least >= clearance_m - 1e-12);
            } else {
                prop_assert!(least < clearance_m + LOOK_M);
            }
        }
    }
}
