//! Plane outlines of tools, objects and obstacles.
//!
//! An outline is described once and used twice: for distances when a plan is made and as a collider when it is simulated.

mod area;
mod convex;
mod distance;
mod spread;

use nalgebra::{Isometry2, Point2, Vector2};
use parry2d::shape::SharedShape;
use serde::{Deserialize, Serialize};

pub(crate) use convex::{Convex, Gap, gap};
pub use distance::separation_m;

use crate::field::{FieldError, finite, positive};

/// A convex outline in the frame of the thing that it bounds, meters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Outline {
    /// A disc about the origin.
    Disc {
        /// Radius, m.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius_m: f64,
    },
    /// A rectangle about the origin, its sides along the axes.
    Box {
        /// Extent along x, m.
        #[schemars(extend("exclusiveMinimum" = 0))]
        width_m: f64,
        /// Extent along y, m.
        #[schemars(extend("exclusiveMinimum" = 0))]
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
        self.validate().ok()?;
        match self {
            Self::Disc { radius_m } => Some(SharedShape::ball(*radius_m)),
            Self::Box { width_m, height_m } => Some(SharedShape::cuboid(width_m / 2.0, height_m / 2.0)),
            Self::Polygon { vertices_m } => SharedShape::convex_hull(
                &vertices_m.iter().map(|&[x, y]| parry2d::math::Vector::new(x, y)).collect::<Vec<_>>(),
            ),
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
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

    /// Returns the outline moved by `pose`, which leads from the larger frame to one larger still.
    #[must_use]
    pub fn transformed(&self, pose: &Isometry2<f64>) -> Self {
        let position_m = (pose * Point2::from(self.position_m)).into();
        Self { shape: self.shape.clone(), position_m, angle_rad: self.angle_rad + pose.rotation.angle() }
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
