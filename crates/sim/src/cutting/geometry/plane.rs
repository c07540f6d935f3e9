//! Planes, and the two sides they have.

use nalgebra::{Isometry3, Point3, Unit, Vector3};

/// A plane in the frame of the solid that it cuts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point on the plane, m.
    pub point: Point3<f64>,
    /// Its normal; it points to the positive side.
    pub normal: Unit<Vector3<f64>>,
}

/// A side of a plane, or of a cut that steers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// Where the normal comes from.
    Negative,
    /// Where the normal points to.
    Positive,
}

impl Plane {
    /// Returns the x-y plane of a frame; its normal is the frame's z axis.
    #[must_use]
    pub fn of_frame(food_from_section: &Isometry3<f64>) -> Self {
        let normal = Unit::new_unchecked(food_from_section.rotation * Vector3::z());
        Self { point: Point3::from(food_from_section.translation.vector), normal }
    }

    /// Returns the distance of `point` from the plane, positive on the side of the normal, m.
    #[must_use]
    pub fn signed_distance(&self, point: &Point3<f64>) -> f64 {
        self.normal.dot(&(point - self.point))
    }

    /// Is every number finite? A plane that is not cuts nothing.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.point.iter().chain(self.normal.iter()).all(|value| value.is_finite())
    }
}
