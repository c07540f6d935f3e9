//! Contact surfaces: the parts of a tool's outline that may push, and in which direction.

use nalgebra::{Point2, Unit, Vector2};
use serde::{Deserialize, Serialize};

use crate::field::{FieldError, finite, positive, within};

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
                positive("shape.arc.half_angle_rad", *half_angle_rad)?;
                within("shape.arc.half_angle_rad", *half_angle_rad, 0.0, std::f64::consts::PI)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A few roundings of lengths of some centimeters.
    const ROUNDING_M: f64 = 1e-15;

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
        assert_relative_eq!(side().middle().normal.into_inner(), Vector2::new(-1.0, 0.0), epsilon = ROUNDING_M);
        assert_relative_eq!(side().middle().point, Point2::new(-0.006, 0.019), epsilon = ROUNDING_M);
        assert_relative_eq!(side().length_m(), 0.010, epsilon = ROUNDING_M);
    }

    #[test]
    fn the_tip_of_a_round_head_lies_one_radius_before_its_center() {
        assert_relative_eq!(head().middle().point, Point2::new(0.0, 0.030), epsilon = ROUNDING_M);
        assert_relative_eq!(head().length_m(), 0.00096, epsilon = ROUNDING_M);
    }

    /// A hollow of 30 mm radius that opens along +y; its deepest point is the origin.
    fn hollow() -> ContactSurface {
        let direction_rad = std::f64::consts::FRAC_PI_2;
        let shape = SurfaceShape::Arc { center_m: [0.0, 0.03], radius_m: -0.03, direction_rad, half_angle_rad: 0.5 };
        ContactSurface { name: "hollow".into(), shape }
    }

    #[test]
    fn the_normal_of_a_hollow_points_from_its_bottom_to_its_center() {
        assert_relative_eq!(hollow().middle().point, Point2::origin(), epsilon = ROUNDING_M);
        assert_relative_eq!(hollow().middle().normal.into_inner(), Vector2::y(), epsilon = ROUNDING_M);
        for place in [-0.01, 0.004, 0.015] {
            let contact = hollow().contact_at(place);
            let center = contact.point + contact.normal.into_inner() * 0.03;
            assert_relative_eq!(center, Point2::new(0.0, 0.03), epsilon = ROUNDING_M);
        }
        assert_relative_eq!(hollow().length_m(), 0.03, epsilon = ROUNDING_M);
        assert_eq!(hollow().curvature_radius_m(), -0.03);
    }

    #[test]
    fn places_grow_to_the_left_of_the_normal_on_every_shape() {
        for surface in [side(), head(), hollow()] {
            let (middle, beside) = (surface.middle(), surface.contact_at(1e-4));
            let left = Vector2::new(-middle.normal.y, middle.normal.x);
            assert_relative_eq!((beside.point - middle.point).dot(&left), 1e-4, max_relative = 1e-3);
        }
    }

    #[test]
    fn place_and_contact_are_inverse() {
        for surface in [side(), head(), hollow()] {
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
        assert_relative_eq!(far.point, Point2::new(-0.006, 0.024), epsilon = ROUNDING_M);
        // half a radian to the right of the bottom, seen from the center
        let right = Point2::new(0.03 * 0.5_f64.sin(), 0.03 - 0.03 * 0.5_f64.cos());
        for point in [Point2::new(0.029, 0.029), Point2::new(1.0, 0.0), Point2::new(0.01, 0.06)] {
            assert_relative_eq!(hollow().nearest(&point).point, right, epsilon = ROUNDING_M);
        }
    }

    #[test]
    fn no_usable_contact_of_an_arc_is_nearer_than_the_nearest() {
        for surface in [head(), hollow()] {
            let half = surface.length_m() / 2.0;
            for point in [[0.0, 0.05], [0.003, 0.031], [-0.02, 0.01], [0.004, 0.029], [0.01, 0.055]] {
                let point = Point2::from(point);
                let found = (surface.nearest(&point).point - point).norm();
                let all = (-50..=50).map(|k| surface.contact_at(half * f64::from(k) / 50.0));
                let least = all.map(|contact| (contact.point - point).norm()).fold(f64::INFINITY, f64::min);
                assert!(found <= least + ROUNDING_M, "{}: {found} {least}", surface.name);
            }
        }
    }

    #[test]
    fn surfaces_that_are_none_are_refused_by_field() {
        let field = |shape| ContactSurface { name: "none".into(), shape }.validate().unwrap_err().field;
        let face = |start_m, end_m| field(SurfaceShape::Face { start_m, end_m });
        assert_eq!(face([0.0, f64::NAN], [1.0, 0.0]), "shape.face.start_m");
        assert_eq!(face([0.0, 0.0], [f64::INFINITY, 0.0]), "shape.face.end_m");
        assert_eq!(face([1.0, 2.0], [1.0, 2.0]), "shape.face.end_m");
        let arc = |center_m, radius_m, direction_rad, half_angle_rad| {
            field(SurfaceShape::Arc { center_m, radius_m, direction_rad, half_angle_rad })
        };
        assert_eq!(arc([f64::NAN, 0.0], 1.0, 0.0, 0.1), "shape.arc.center_m");
        assert_eq!(arc([0.0, 0.0], 0.0, 0.0, 0.1), "shape.arc.radius_m");
        assert_eq!(arc([0.0, 0.0], f64::INFINITY, 0.0, 0.1), "shape.arc.radius_m");
        assert_eq!(arc([0.0, 0.0], 1.0, f64::NAN, 0.1), "shape.arc.direction_rad");
        for half_angle_rad in [-0.1, 0.0, 3.2, f64::NAN] {
            assert_eq!(arc([0.0, 0.0], 1.0, 0.0, half_angle_rad), "shape.arc.half_angle_rad");
        }
        assert_eq!((side().validate(), head().validate(), hollow().validate()), (Ok(()), Ok(()), Ok(())));
    }
}
