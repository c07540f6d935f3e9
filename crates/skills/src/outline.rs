//! Plane outlines of tools, objects and obstacles.
//!
//! An outline is described once and used twice: for distances when a plan is made and as a collider when it is simulated.

use nalgebra::{Isometry2, Point2, Vector2};
use parry2d::shape::SharedShape;
use serde::{Deserialize, Serialize};

use crate::field::{FieldError, finite, positive};

/// A convex outline in the frame of the thing that it bounds, meters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Outline {
    /// A disc about the origin.
    Disc {
        /// Radius, m.
        radius_m: f64,
    },
    /// A rectangle about the origin, its sides along the axes.
    Box {
        /// Extent along x, m.
        width_m: f64,
        /// Extent along y, m.
        height_m: f64,
    },
    /// A convex polygon, its vertices counterclockwise.
    Polygon {
        /// Vertices, m.
        vertices_m: Vec<[f64; 2]>,
    },
}

impl Outline {
    /// Checks sizes, finiteness, convexity and orientation.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::Disc { radius_m } => positive("disc.radius_m", *radius_m),
            Self::Box { width_m, height_m } => {
                positive("box.width_m", *width_m)?;
                positive("box.height_m", *height_m)
            }
            Self::Polygon { vertices_m } => {
                finite("polygon.vertices_m", vertices_m.as_flattened())?;
                if is_convex_counterclockwise(vertices_m) {
                    Ok(())
                } else {
                    Err(FieldError::new(
                        "polygon.vertices_m",
                        format!("{} vertices that do not turn left at every corner", vertices_m.len()),
                        "at least 3 vertices of a convex polygon, counterclockwise",
                    ))
                }
            }
        }
    }

    /// The same outline as a shape that distances and contacts can be asked of; `None` if it is not a valid outline.
    #[must_use]
    pub fn shape(&self) -> Option<SharedShape> {
        match self {
            Self::Disc { radius_m } => Some(SharedShape::ball(*radius_m)),
            Self::Box { width_m, height_m } => Some(SharedShape::cuboid(width_m / 2.0, height_m / 2.0)),
            Self::Polygon { vertices_m } => SharedShape::convex_hull(
                &vertices_m.iter().map(|&[x, y]| parry2d::math::Vector::new(x, y)).collect::<Vec<_>>(),
            ),
        }
    }

    /// Area, m².
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        match self {
            Self::Disc { radius_m } => std::f64::consts::PI * radius_m * radius_m,
            Self::Box { width_m, height_m } => width_m * height_m,
            Self::Polygon { vertices_m } => edges(vertices_m).map(|(a, b)| 0.5 * a.coords.perp(&b.coords)).sum(),
        }
    }

    /// Polar second moment of area about the centroid divided by the area, m²: moment of inertia per unit of mass.
    #[must_use]
    pub fn inertia_per_mass_m2(&self) -> f64 {
        match self {
            Self::Disc { radius_m } => 0.5 * radius_m * radius_m,
            Self::Box { width_m, height_m } => (width_m * width_m + height_m * height_m) / 12.0,
            Self::Polygon { vertices_m } => {
                let about_origin: f64 = edges(vertices_m)
                    .map(|(a, b)| {
                        let (a, b) = (a.coords, b.coords);
                        a.perp(&b) * (a.dot(&a) + a.dot(&b) + b.dot(&b)) / 12.0
                    })
                    .sum();
                about_origin / self.area_m2() - self.centroid().coords.norm_squared()
            }
        }
    }

    /// Centroid in the outline's own frame, m.
    #[must_use]
    pub fn centroid(&self) -> Point2<f64> {
        match self {
            Self::Disc { .. } | Self::Box { .. } => Point2::origin(),
            Self::Polygon { vertices_m } => {
                let sum: Vector2<f64> =
                    edges(vertices_m).map(|(a, b)| (a.coords + b.coords) * a.coords.perp(&b.coords) / 6.0).sum();
                Point2::from(sum / self.area_m2())
            }
        }
    }

    /// Mean distance of the area's points from the centroid, m: the lever of friction against spinning in place.
    #[must_use]
    pub fn mean_radius_m(&self) -> f64 {
        match self {
            Self::Disc { radius_m } => 2.0 / 3.0 * radius_m,
            Self::Box { .. } | Self::Polygon { .. } => {
                let center = self.centroid();
                let corners = self.drawing(0);
                edges(&corners).map(|(a, b)| radius_integral(&(a - center), &(b - center))).sum::<f64>()
                    / self.area_m2()
            }
        }
    }

    /// At least `count` points spread evenly over the area, relative to the centroid, their mean at the centroid, m.
    #[must_use]
    pub fn spread_points(&self, count: usize) -> Vec<Vector2<f64>> {
        if let Self::Disc { radius_m } = self {
            // sunflower arrangement (Vogel 1979): equal areas along a golden-angle spiral
            let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
            let at = |k: usize| {
                let (sin, cos) = (golden * k as f64).sin_cos();
                Vector2::new(cos, sin) * (radius_m * ((k as f64 + 0.5) / count as f64).sqrt())
            };
            return centered((0..count).map(at).collect());
        }
        let corners = self.drawing(0);
        let bound = |axis: usize, pick: fn(f64, f64) -> f64, from: f64| {
            corners.iter().map(|corner| corner[axis]).fold(from, pick)
        };
        let low = Point2::new(bound(0, f64::min, f64::INFINITY), bound(1, f64::min, f64::INFINITY));
        let high = Point2::new(bound(0, f64::max, f64::NEG_INFINITY), bound(1, f64::max, f64::NEG_INFINITY));
        let size = high - low;
        // square cells over the bounding box, ever smaller until enough of their centers lie inside
        let mut wanted = count;
        loop {
            let columns = (wanted as f64 * size.x / size.y).sqrt().ceil().max(1.0) as usize;
            let rows = wanted.div_ceil(columns);
            let at = |k: usize| {
                let share = Vector2::new((k % columns) as f64 + 0.5, (k / columns) as f64 + 0.5);
                low + size.component_mul(&share.component_div(&Vector2::new(columns as f64, rows as f64)))
            };
            let inside: Vec<_> =
                (0..columns * rows).map(at).filter(|point| self.signed_distance_m(point) < 0.0).collect();
            if inside.len() >= count {
                return centered(inside.into_iter().map(|point| point.coords).collect());
            }
            wanted += count;
        }
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

    /// Corner points for drawing (`arc_points` of them for a disc), counterclockwise, in the outline's frame, m.
    #[must_use]
    pub fn drawing(&self, arc_points: usize) -> Vec<[f64; 2]> {
        match self {
            Self::Disc { radius_m } => (0..arc_points.max(3))
                .map(|index| {
                    let (sin, cos) = (std::f64::consts::TAU * index as f64 / arc_points.max(3) as f64).sin_cos();
                    [radius_m * cos, radius_m * sin]
                })
                .collect(),
            Self::Box { width_m, height_m } => {
                let (x, y) = (width_m / 2.0, height_m / 2.0);
                vec![[-x, -y], [x, -y], [x, y], [-x, y]]
            }
            Self::Polygon { vertices_m } => vertices_m.clone(),
        }
    }
}

/// An outline at a fixed pose in a larger frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlacedOutline {
    /// The outline in its own frame.
    pub shape: Outline,
    /// Position of its origin in the larger frame, m.
    #[serde(default)]
    pub position_m: [f64; 2],
    /// Rotation of its frame in the larger frame, rad.
    #[serde(default)]
    pub angle_rad: f64,
}

impl PlacedOutline {
    /// Pose of the outline's frame in the larger frame.
    #[must_use]
    pub fn pose(&self) -> Isometry2<f64> {
        Isometry2::new(Vector2::from(self.position_m), self.angle_rad)
    }

    /// Signed distance of a point (in the larger frame, m): negative inside.
    #[must_use]
    pub fn signed_distance_m(&self, point: &Point2<f64>) -> f64 {
        self.shape.signed_distance_m(&self.pose().inverse_transform_point(point))
    }

    /// Checks the outline and its pose.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.shape.validate().map_err(|error| error.within("shape"))?;
        finite("position_m", &self.position_m)?;
        finite("angle_rad", &[self.angle_rad])
    }
}

fn centered(mut points: Vec<Vector2<f64>>) -> Vec<Vector2<f64>> {
    let mean = points.iter().sum::<Vector2<f64>>() / points.len() as f64;
    points.iter_mut().for_each(|point| *point -= mean);
    points
}

/// Integral of the distance from the origin over the triangle (origin, a, b), signed by its orientation, m³.
fn radius_integral(a: &Vector2<f64>, b: &Vector2<f64>) -> f64 {
    let edge = b - a;
    let height = a.perp(b) / edge.norm();
    let height_abs = height.abs();
    if height_abs <= 0.0 {
        return 0.0;
    }
    // in polar form: h³/3 times the integral of sec³ between the ends' angles from the foot of the height
    let primitive = |along: f64| {
        let tan = along / height_abs;
        let sec = (1.0 + tan * tan).sqrt();
        0.5 * (sec * tan + (tan + sec).ln())
    };
    let (from, to) = (a.dot(&edge) / edge.norm(), b.dot(&edge) / edge.norm());
    height * height_abs * height_abs / 3.0 * (primitive(to) - primitive(from))
}

/// Distance between two outlines at their poses, m: negative when they overlap; `None` if one is not a valid outline.
#[must_use]
pub fn separation_m(first: &Outline, pose1: &Isometry2<f64>, second: &Outline, pose2: &Isometry2<f64>) -> Option<f64> {
    let (shape1, shape2) = (first.shape()?, second.shape()?);
    let to_pose = |pose: &Isometry2<f64>| {
        parry2d::math::Pose::new(
            parry2d::math::Vector::new(pose.translation.x, pose.translation.y),
            pose.rotation.angle(),
        )
    };
    // farther apart than this, a distance is exact; nearer or overlapping, the depth is asked for
    let contact = parry2d::query::contact(&to_pose(pose1), shape1.as_ref(), &to_pose(pose2), shape2.as_ref(), f64::MAX)
        .ok()??;
    Some(contact.dist)
}

fn edges(vertices: &[[f64; 2]]) -> impl Iterator<Item = (Point2<f64>, Point2<f64>)> + '_ {
    let next = vertices.iter().cycle().skip(1);
    vertices.iter().zip(next).map(|(&a, &b)| (Point2::from(a), Point2::from(b)))
}

fn is_convex_counterclockwise(vertices: &[[f64; 2]]) -> bool {
    let turns = edges(vertices).zip(edges(vertices).skip(1).chain(edges(vertices).take(1)));
    let all_left = turns.map(|((a, b), (_, c))| (b - a).perp(&(c - b))).all(|turn| turn > 0.0);
    // a star turns left everywhere too, but goes round more than once
    let angle: f64 = edges(vertices)
        .zip(edges(vertices).skip(1).chain(edges(vertices).take(1)))
        .map(|((a, b), (_, c))| (b - a).angle(&(c - b)))
        .sum();
    vertices.len() >= 3 && all_left && (angle - std::f64::consts::TAU).abs() < 1e-6
}

fn polygon_distance(vertices: &[[f64; 2]], point: &Point2<f64>) -> f64 {
    let mut inside = true;
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

    fn square() -> Outline {
        Outline::Polygon { vertices_m: vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] }
    }

    #[test]
    fn a_square_polygon_equals_the_box() {
        let same = Outline::Box { width_m: 2.0, height_m: 2.0 };
        assert_relative_eq!(square().area_m2(), same.area_m2());
        assert_relative_eq!(square().inertia_per_mass_m2(), same.inertia_per_mass_m2(), epsilon = 1e-15);
        assert_relative_eq!(square().radius_m(), same.radius_m());
        for point in [[0.2, 0.3], [3.0, 0.0], [2.0, 2.0], [-1.5, 0.5]] {
            assert_relative_eq!(
                square().signed_distance_m(&point.into()),
                same.signed_distance_m(&point.into()),
                epsilon = 1e-15
            );
        }
    }

    #[test]
    fn a_shifted_polygon_keeps_its_inertia_about_the_centroid() {
        let shifted = Outline::Polygon { vertices_m: vec![[4.0, 6.0], [6.0, 6.0], [6.0, 8.0], [4.0, 8.0]] };
        assert_relative_eq!(shifted.centroid(), Point2::new(5.0, 7.0), epsilon = 1e-12);
        assert_relative_eq!(shifted.inertia_per_mass_m2(), 8.0 / 12.0, epsilon = 1e-12);
    }

    #[test]
    fn mean_radius_matches_closed_forms() {
        // square of side a: 0.3826 a; thin bar of length w: w/4
        assert_relative_eq!(
            Outline::Box { width_m: 0.04, height_m: 0.04 }.mean_radius_m(),
            0.382_597_858 * 0.04,
            epsilon = 1e-9
        );
        assert_relative_eq!(Outline::Box { width_m: 1.0, height_m: 1e-6 }.mean_radius_m(), 0.25, epsilon = 1e-6);
        let many =
            (0..720).map(|k| (std::f64::consts::TAU * f64::from(k) / 720.0).sin_cos()).map(|(s, c)| [c, s]).collect();
        assert_relative_eq!(Outline::Polygon { vertices_m: many }.mean_radius_m(), 2.0 / 3.0, epsilon = 1e-4);
    }

    #[test]
    fn spread_points_lie_inside_and_average_to_the_centroid() {
        for outline in [Outline::Disc { radius_m: 0.012 }, square(), Outline::Box { width_m: 3.0, height_m: 0.5 }] {
            let points = outline.spread_points(64);
            assert!(points.len() >= 64);
            assert!(points.iter().sum::<Vector2<f64>>().norm() < 1e-12);
            let mean = points.iter().map(|point| point.norm()).sum::<f64>() / points.len() as f64;
            assert_relative_eq!(mean, outline.mean_radius_m(), max_relative = 0.03);
        }
    }

    #[test]
    fn clockwise_star_and_degenerate_polygons_are_refused() {
        let clockwise = Outline::Polygon { vertices_m: vec![[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]] };
        let line = Outline::Polygon { vertices_m: vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]] };
        let star =
            (0..5).map(|k| (std::f64::consts::TAU * 2.0 * f64::from(k) / 5.0).sin_cos()).map(|(s, c)| [c, s]).collect();
        for outline in [clockwise, line, Outline::Polygon { vertices_m: star }] {
            assert_eq!(outline.validate().unwrap_err().field, "polygon.vertices_m");
        }
        assert!(square().validate().is_ok());
    }

    #[test]
    fn negative_and_infinite_sizes_are_refused_by_name() {
        assert_eq!(Outline::Disc { radius_m: -1.0 }.validate().unwrap_err().field, "disc.radius_m");
        assert_eq!(Outline::Box { width_m: 1.0, height_m: f64::NAN }.validate().unwrap_err().field, "box.height_m");
    }
}
