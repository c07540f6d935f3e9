//! The border between nalgebra, which the project speaks, and the engine's own vectors and poses.

use nalgebra::{Isometry3, Matrix3, Point3, Quaternion, UnitQuaternion, Vector3};
use rapier3d::math::{Matrix, Pose, Rotation, Vector};

pub(crate) fn pose(isometry: &Isometry3<f64>) -> Pose {
    let q = isometry.rotation.quaternion();
    Pose::from_parts(vector(&isometry.translation.vector), Rotation::from_xyzw(q.i, q.j, q.k, q.w))
}

pub(crate) fn isometry(pose: &Pose) -> Isometry3<f64> {
    let q = pose.rotation;
    let rotation = UnitQuaternion::new_unchecked(Quaternion::new(q.w, q.x, q.y, q.z));
    Isometry3::from_parts(to_vector(pose.translation).into(), rotation)
}

pub(crate) fn vector(v: &Vector3<f64>) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

pub(crate) fn point(p: &Point3<f64>) -> Vector {
    Vector::new(p.x, p.y, p.z)
}

pub(crate) fn to_vector(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

pub(crate) fn matrix(m: &Matrix3<f64>) -> Matrix {
    let column = |index: usize| Vector::new(m[(0, index)], m[(1, index)], m[(2, index)]);
    Matrix::from_cols(column(0), column(1), column(2))
}
