//! Contact surfaces: the parts of a tool's outline that may push, and in which direction.

use nalgebra::{Isometry2, Point2, Unit, Vector2};
use serde::{Deserialize, Serialize};

use crate::field::{FieldError, finite, not_negative, positive, within};

/// A part of a tool's outline that may push.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactSurface {
    /// Name, as plans and reports call it.
    pub name: String,
    /// Where it lies, in the tool frame.
    pub shape: SurfaceShape,
    /// Coefficient of friction between this surface and the object; the tool's if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub friction: Option<f64>,
    /// Largest angle between the way of a push and the normal, rad; that of the friction cone, atan μ, if absent. Zero is
    /// the paper's rule that pushes are perpendicular to the surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = STEEPEST_PUSH_RAD))]
    pub allowed_angle_rad: Option<f64>,
}

/// Where a contact surface lies, in the tool frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SurfaceShape {
    /// A straight face; its outward normal points to the right of the way from `start_m` to `end_m`.
    Face {
        /// One end, m.
        start_m: [f64; 2],
        /// The other end, m.
        end_m: [f64; 2],
    },
    /// A round head (or, with a negative radius, a hollow): the usable part of a circular arc.
    Arc {
        /// Center of the circle, m.
        center_m: [f64; 2],
        /// Radius, m; positive bulges outward.
        radius_m: f64,
        /// Direction of the outward normal at the middle of the arc, rad.
        direction_rad: f64,
        /// Largest angle to either side that may be used, rad.
        #[schemars(range(max = std::f64::consts::PI), extend("exclusiveMinimum" = 0))]
        half_angle_rad: f64,
    },
}

/// A place on a contact surface, in the tool frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The point, m.
    pub point: Point2<f64>,
    /// Outward normal: the direction in which it pushes.
    pub normal: Unit<Vector2<f64>>,
}

impl ContactSurface {
    /// A surface with the friction of its tool.
    #[must_use]
    pub fn new(name: impl Into<String>, shape: SurfaceShape) -> Self {
        Self { name: name.into(), shape, friction: None, allowed_angle_rad: None }
    }

    /// Returns the coefficient of friction with the object, given that of the tool.
    #[must_use]
    pub fn friction_or(&self, tool_friction: f64) -> f64 {
        self.friction.unwrap_or(tool_friction)
    }

    /// Returns the largest angle between the way of a push and the normal, rad, given the friction of the tool.
    #[must_use]
    pub fn allowed_angle_rad(&self, tool_friction: f64) -> f64 {
        self.allowed_angle_rad.unwrap_or_else(|| self.friction_or(tool_friction).atan())
    }

    /// Returns the surface moved with its tool by `pose`.
    #[must_use]
    pub fn transformed(&self, pose: &Isometry2<f64>) -> Self {
        Self { shape: self.shape.transformed(pose), ..self.clone() }
    }

    /// Usable length along the surface, m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        match &self.shape {
            SurfaceShape::Face { start_m, end_m } => (Point2::from(*end_m) - Point2::from(*start_m)).norm(),
            SurfaceShape::Arc { radius_m, half_angle_rad, .. } => 2.0 * radius_m.abs() * half_angle_rad,
        }
    }

    /// The contact at arc length `place_m` from the middle, positive to the left of the normal; not limited to the usable part.
    #[must_use]
    pub fn contact_at(&self, place_m: f64) -> Contact {
        match &self.shape {
            SurfaceShape::Face { start_m, end_m } => {
                let (start, end) = (Point2::from(*start_m), Point2::from(*end_m));
                let tangent = Unit::new_normalize(end - start);
                let point = nalgebra::center(&start, &end) + tangent.into_inner() * place_m;
                Contact { point, normal: Unit::new_unchecked(Vector2::new(tangent.y, -tangent.x)) }
            }
            SurfaceShape::Arc { center_m, radius_m, direction_rad, .. } => {
                // to the left is counterclockwise about the center of a bulge, clockwise about that of a hollow
                let angle = direction_rad + place_m / radius_m;
                let normal = Unit::new_unchecked(Vector2::new(angle.cos(), angle.sin()));
                Contact { point: Point2::from(*center_m) + normal.into_inner() * *radius_m, normal }
            }
        }
    }

    /// The contact in the middle of the usable part.
    #[must_use]
    pub fn middle(&self) -> Contact {
        self.contact_at(0.0)
    }

    /// The usable contact nearest to a point in the tool frame.
    #[must_use]
    pub fn nearest(&self, point: &Point2<f64>) -> Contact {
        let half = self.length_m() / 2.0;
        self.contact_at(self.place_m(point).max(-half).min(half))
    }

    /// Arc length from the middle of the contact on whose normal line the point lies, m, positive to the left of the normal.
    #[must_use]
    pub fn place_m(&self, point: &Point2<f64>) -> f64 {
        match &self.shape {
            SurfaceShape::Face { start_m, end_m } => {
                let (start, end) = (Point2::from(*start_m), Point2::from(*end_m));
                (point - nalgebra::center(&start, &end)).dot(&(end - start).normalize())
            }
            SurfaceShape::Arc { center_m, radius_m, direction_rad, .. } => {
                let middle = Vector2::new(direction_rad.cos(), direction_rad.sin());
                let to_point = (point - Point2::from(*center_m)) * radius_m.signum();
                middle.perp(&to_point).atan2(middle.dot(&to_point)) * radius_m
            }
        }
    }

    /// Signed radius of curvature, m: positive for a bulge, infinite for a face.
    #[must_use]
    pub fn curvature_radius_m(&self) -> f64 {
        match &self.shape {
            SurfaceShape::Face { .. } => f64::INFINITY,
            SurfaceShape::Arc { radius_m, .. } => *radius_m,
        }
    }

    /// Checks that the surface has a length, finite numbers, and an angle at which it can still push.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.friction.map_or(Ok(()), |friction| not_negative("friction", friction))?;
        // at a right angle to the normal nothing is pushed
        self.allowed_angle_rad.map_or(Ok(()), |angle| within("allowed_angle_rad", angle, 0.0, STEEPEST_PUSH_RAD))?;
        match &self.shape {
            SurfaceShape::Face { start_m, end_m } => {
                finite("shape.face.start_m", start_m)?;
                finite("shape.face.end_m", end_m)?;
                positive("shape.face.end_m", self.length_m()).map_err(|mut error| {
                    error.expected = "an end that differs from the start".into();
                    error
                })
            }
            SurfaceShape::Arc { center_m, radius_m, direction_rad, half_angle_rad } => {
                finite("shape.arc.center_m", center_m)?;
                finite("shape.arc.direction_rad", &[*direction_rad])?;
                if !radius_m.is_finite() || *radius_m == 0.0 {
                    return Err(FieldError::new("shape.arc.radius_m", radius_m, "a finite number other than 0"));
                }
                positive("shape.arc.half_angle_rad", *half_angle_rad)?;
                within("shape.arc.half_angle_rad", *half_angle_rad, 0.0, std::f64::consts::PI)
            }
        }
    }
}

impl SurfaceShape {
    /// Returns the shape moved by `pose`.
    fn transformed(&self, pose: &Isometry2<f64>) -> Self {
        let moved = |point: &[f64; 2]| (pose * Point2::from(*point)).into();
        match self {
            Self::Face { start_m, end_m } => Self::Face { start_m: moved(start_m), end_m: moved(end_m) },
            Self::Arc { center_m, radius_m, direction_rad, half_angle_rad } => Self::Arc {
                center_m: moved(center_m),
                radius_m: *radius_m,
                direction_rad: direction_rad + pose.rotation.angle(),
                half_angle_rad: *half_angle_rad,
            },
        }
    }
}

/// Largest angle to the normal that a surface may allow, rad.
const STEEPEST_PUSH_RAD: f64 = 1.5;

#[cfg(test)]
#[path = "surface_tests.rs"]
mod tests;
