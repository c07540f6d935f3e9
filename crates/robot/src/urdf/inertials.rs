//! Inertials of links, merged into bodies and judged.

use nalgebra::{Isometry3, Matrix3, SymmetricEigen, Vector3};
use urdf_rs::Link;

use crate::joint::Body;
use crate::urdf::build::isometry;
use crate::warning::Warning;

/// Relative room for rounding in the triangle inequality of principal moments, as files give about six digits.
const TRIANGLE_TOLERANCE: f64 = 1e-6;
/// Steps allowed for the eigenvalues of a 3 × 3 matrix, which takes about five.
const EIGENVALUE_STEPS: usize = 100;

/// Adds a link's inertial to the body it belongs to. `moves` is false for the base, whose inertia plays no part.
pub(crate) fn add(
    link: &Link,
    body_from_link: &Isometry3<f64>,
    moves: bool,
    body: &mut Body,
    warnings: &mut Vec<Warning>,
) {
    let written = &link.inertial.inertia;
    let tensor = Matrix3::new(
        written.ixx,
        written.ixy,
        written.ixz, //
        written.ixy,
        written.iyy,
        written.iyz, //
        written.ixz,
        written.iyz,
        written.izz,
    );
    let mass_kg = link.inertial.mass.value;
    if let Some(moments) = unphysical_moments(&tensor) {
        warnings.push(Warning::UnphysicalInertia { link: link.name.clone(), moments });
    }
    if moves && mass_kg > 0.0 && tensor.amax() == 0.0 {
        warnings.push(Warning::PointMass { link: link.name.clone(), mass_kg });
    }
    let body_from_inertial = body_from_link * isometry(&link.inertial.origin);
    let axes = body_from_inertial.rotation.to_rotation_matrix().into_inner();
    let rotated = axes * tensor * axes.transpose();
    body.add_part(mass_kg, body_from_inertial.translation.vector, rotated);
}

/// The principal moments (kg m²) of a tensor that belongs to no rigid body; `None` for a physical one.
fn unphysical_moments(tensor: &Matrix3<f64>) -> Option<[f64; 3]> {
    let moments = principal_moments(tensor);
    let least = -TRIANGLE_TOLERANCE * tensor.amax();
    let physical = moments.min() >= least && moments.max() <= moments.sum() - moments.max() - least;
    (!physical).then(|| moments.into())
}

/// The eigenvalues of a symmetric tensor (kg m²); NaN if they are not found.
pub(crate) fn principal_moments(tensor: &Matrix3<f64>) -> Vector3<f64> {
    let scale = tensor.amax();
    if scale == 0.0 {
        return Vector3::zeros();
    }
    // scaled, so that huge numbers do not overflow inside the decomposition
    let decomposition = SymmetricEigen::try_new(tensor / scale, f64::EPSILON, EIGENVALUE_STEPS);
    decomposition.map_or(Vector3::repeat(f64::NAN), |found| found.eigenvalues * scale)
}
