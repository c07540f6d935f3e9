//! The border between nalgebra, which the project speaks, and the engine's own vectors and poses.

use nalgebra::{Isometry2, Point2, UnitComplex, Vector2};
use rapier2d::math::{Pose, Rotation, Vector};

pub(crate) fn pose(isometry: &Isometry2<f64>) -> Pose {
    let rotation = Rotation { re: isometry.rotation.re, im: isometry.rotation.im };
    Pose { rotation, translation: vector(&isometry.translation.vector) }
}

pub(crate) fn isometry(pose: &Pose) -> Isometry2<f64> {
    let rotation = UnitComplex::new_unchecked(nalgebra::Complex::new(pose.rotation.re, pose.rotation.im));
    Isometry2::from_parts(to_vector(pose.translation).into(), rotation)
}

pub(crate) fn vector(v: &Vector2<f64>) -> Vector {
    Vector::new(v.x, v.y)
}

pub(crate) fn to_vector(v: Vector) -> Vector2<f64> {
    Vector2::new(v.x, v.y)
}

pub(crate) fn to_point(v: Vector) -> Point2<f64> {
    Point2::new(v.x, v.y)
}
