//! Contact surfaces: the parts of a tool's outline that may push, and in which direction.

use nalgebra::{Point2, Unit, Vector2};
use serde::{Deserialize, Serialize};

use crate::field::{FieldError, finite, positive};

/// A part of a tool's outline that may push.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactSurface {
    /// Name, as plans and reports call it.
    pub name: String,
    /// Where it lies, in the tool frame.
    pub shape: SurfaceShape,
}

/// Where a contact surface lies, in the tool frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    /// Usable length along the surface, m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        match &self.shape {
            SurfaceShape::Face { start_m, end_m } => (Point2::from(*end_m) - Point2::from(*start_m)).norm(),
            SurfaceShape::Arc { radius_m, half_angle_rad, .. } => 2.0 * radius_m.abs() * half_angle_rad,
        }
    }

    /// The contact at arc length `place_m` from the middle (positive towards the end), not limited to the usable part.
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
                // arc length grows counterclockwise about the center of a bulge
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
        self.contact_at(self.place_m(point).clamp(-half, half))
    }

    /// Arc length from the middle of the contact on whose normal line the point lies, m.
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

    /// Checks that the surface has a length and finite numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
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
                positive("shape.arc.half_angle_rad", *half_angle_rad)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn side() -> ContactSurface {
        let shape = SurfaceShape::Face { start_m: [-0.006, 0.024], end_m: [-0.006, 0.014] };
        ContactSurface { name: "side".into(), shape }
    }

    fn head() -> ContactSurface {
        let direction_rad = std::f64::consts::FRAC_PI_2;
        let shape = SurfaceShape::Arc { center_m: [0.0, 0.024], radius_m: 0.006, direction_rad, half_angle_rad: 0.08 };
        ContactSurface { name: "head".into(), shape }
    }

    #[test]
    fn the_normal_of_a_face_points_right_of_its_way() {
        assert_relative_eq!(side().middle().normal.into_inner(), Vector2::new(-1.0, 0.0), epsilon = 1e-15);
        assert_relative_eq!(side().middle().point, Point2::new(-0.006, 0.019), epsilon = 1e-15);
        assert_relative_eq!(side().length_m(), 0.010, epsilon = 1e-15);
    }

    #[test]
    fn the_tip_of_a_round_head_lies_one_radius_before_its_center() {
        assert_relative_eq!(head().middle().point, Point2::new(0.0, 0.030), epsilon = 1e-15);
        assert_relative_eq!(head().length_m(), 0.00096, epsilon = 1e-15);
    }

    #[test]
    fn place_and_contact_are_inverse() {
        for surface in [side(), head()] {
            for place in [-0.0004, 0.0, 0.0003] {
                let contact = surface.contact_at(place);
                let out = contact.point + contact.normal.into_inner() * 0.012;
                assert_relative_eq!(surface.place_m(&out), place, epsilon = 1e-12);
            }
        }
    }

    #[test]
    fn the_nearest_contact_stays_on_the_usable_part() {
        let far = side().nearest(&Point2::new(-0.02, 0.5));
        assert_relative_eq!(far.point, Point2::new(-0.006, 0.024), epsilon = 1e-15);
    }
}
