//! Cuts that are not plane: the way of a blade that steers or turns, in strips.

use nalgebra::{Isometry3, Point2, Point3, Unit, Vector3};

use super::{GeometryError, Plane, Side, Solid};

/// A cut made of strips, one behind the other: each strip has a plane of its own, parallel borders part the strips.
#[derive(Clone, Debug, PartialEq)]
pub struct CutSurface {
    planes: Vec<Plane>,
    borders: Vec<Plane>,
}

/// A piece that a cut leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The side of the cut on which it lies.
    pub side: Side,
    /// The piece, in the frame of the food that was cut.
    pub solid: Solid,
}

/// Borders of strips may be this far from parallel: the sine of the angle between their normals.
const PARALLEL: f64 = 1e-9;

impl CutSurface {
    /// Makes a cut of planes, one per strip, and of the borders between strips, in the food's frame.
    ///
    /// The borders are parallel; their normals point to the next strip. The first and the last strip have no end.
    ///
    /// # Errors
    /// A [`GeometryError`] if there is not one plane more than borders, if borders are not parallel and in order, or if a
    /// number is not finite.
    pub fn new(planes: Vec<Plane>, borders: Vec<Plane>) -> Result<Self, GeometryError> {
        if planes.len() != borders.len() + 1 {
            let found = format!("{} planes and {} borders", planes.len(), borders.len());
            return Err(refusal(found, "one plane more than borders"));
        }
        if let Some(plane) = planes.iter().chain(&borders).find(|plane| !plane.is_finite()) {
            return Err(refusal(format!("{plane:?}"), "finite points and normals"));
        }
        for (strip, pair) in borders.windows(2).enumerate() {
            let (behind, ahead) = (&pair[0], &pair[1]);
            if behind.normal.cross(&ahead.normal).norm() > PARALLEL || behind.normal.dot(&ahead.normal) < 0.0 {
                let found = format!("borders {strip} and {} with normals that differ", strip + 1);
                return Err(refusal(found, "parallel borders whose normals point to the next strip"));
            }
            if behind.signed_distance(&ahead.point) <= 0.0 {
                let found = format!("border {} at or behind border {strip}", strip + 1);
                return Err(refusal(found, "borders in the order of their normals"));
            }
        }
        Ok(Self { planes, borders })
    }

    /// Makes the cut of a straight edge that stays parallel to x while it goes along `profile`: points (y, z) in the
    /// section's frame, m, y in the direction of the cut and z across the blade.
    ///
    /// Neighboring strips meet on their border, so the cut has no steps.
    ///
    /// # Errors
    /// A [`GeometryError`] if there are fewer than two points, y does not increase, or a number is not finite.
    pub fn from_profile(food_from_section: &Isometry3<f64>, profile: &[Point2<f64>]) -> Result<Self, GeometryError> {
        if profile.len() < 2 {
            return Err(refusal(format!("a profile of {} points", profile.len()), "at least 2 points"));
        }
        if let Some(pair) = profile.windows(2).find(|pair| pair[1].x <= pair[0].x) {
            let found = format!("a profile that goes from {} to {} m along the cut", pair[0].x, pair[1].x);
            return Err(refusal(found, "points that go forward; drop those where the blade stands or returns"));
        }
        let place = |at: &Point2<f64>, normal: Vector3<f64>| Plane {
            point: food_from_section * Point3::new(0.0, at.x, at.y),
            normal: Unit::new_normalize(food_from_section.rotation * normal),
        };
        let along = |pair: &[Point2<f64>]| pair[1] - pair[0];
        let planes = profile.windows(2).map(|pair| place(&pair[0], Vector3::new(0.0, -along(pair).y, along(pair).x)));
        let borders = profile[1..profile.len() - 1].iter().map(|at| place(at, Vector3::y()));
        Self::new(planes.collect(), borders.collect())
    }

    /// Returns the planes of the strips, in order.
    #[must_use]
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// Returns the borders between the strips, in order.
    #[must_use]
    pub fn borders(&self) -> &[Plane] {
        &self.borders
    }
}

fn refusal(found: String, expected: &'static str) -> GeometryError {
    GeometryError::Value { operation: "build cut surface", found, expected }
}
