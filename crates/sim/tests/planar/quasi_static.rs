//! An independent quasi-static integrator of planar pushing: no masses, no engine, only the limit surface and one contact.
//!
//! Ellipsoidal limit surface, maximum dissipation, one frictional point contact (Lynch, Maekawa and Tanie 1992).

use nalgebra::{Matrix2, Matrix2x3, Matrix3, Rotation2, Vector2, Vector3};

/// Twist (vx, vy, w) of an object whose point `arm` (from its center, world axes) a pusher moves with `velocity`.
///
/// `normal` points into the object; `length` is the limit surface's moment-to-force ratio; `friction` that of the contact.
/// The second value tells whether the contact sticks.
pub fn pushed_twist(
    arm: Vector2<f64>,
    normal: Vector2<f64>,
    velocity: Vector2<f64>,
    friction: f64,
    length: f64,
) -> (Vector3<f64>, bool) {
    let jacobian = Matrix2x3::new(1.0, 0.0, -arm.y, 0.0, 1.0, arm.x);
    let mobility = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 1.0 / (length * length)));
    let contact_mobility: Matrix2<f64> = jacobian * mobility * jacobian.transpose();
    let sticking = contact_mobility.try_inverse().expect("positive definite") * velocity;
    let tangent = Vector2::new(-normal.y, normal.x);
    let (pressing, rubbing) = (sticking.dot(&normal), sticking.dot(&tangent));
    let sticks = pressing > 0.0 && rubbing.abs() <= friction * pressing;
    let force = if sticks {
        sticking
    } else {
        let edge = normal + tangent * (friction * rubbing.signum());
        edge * (velocity.dot(&normal) / (contact_mobility * edge).dot(&normal))
    };
    (mobility * jacobian.transpose() * force, sticks)
}

/// Pose (x, y, angle) of a disc of radius `radius` after a flat face with unit normal +y has moved by `displacement`.
///
/// The disc starts at the origin, touching the face.
pub fn disc_on_face(radius: f64, length: f64, friction: f64, displacement: Vector2<f64>, steps: usize) -> Vector3<f64> {
    let velocity = displacement / steps as f64;
    let arm = Vector2::new(0.0, -radius);
    (0..steps).map(|_| pushed_twist(arm, Vector2::y(), velocity, friction, length).0).sum()
}

/// Angle between the push direction and the line of centers after a round head has moved straight by `travel`.
pub fn disc_on_head(radius: f64, head: f64, length: f64, friction: f64, angle: f64, travel: f64, steps: usize) -> f64 {
    let mut head_center = Vector2::zeros();
    let mut center = Rotation2::new(angle) * Vector2::new(0.0, radius + head);
    let velocity = Vector2::new(0.0, travel / steps as f64);
    for _ in 0..steps {
        let normal = (center - head_center).normalize();
        let (twist, _) = pushed_twist(-normal * radius, normal, velocity, friction, length);
        center += twist.xy();
        head_center += velocity;
        // the line of centers keeps its length: remove the drift of the explicit step
        center = head_center + (center - head_center).normalize() * (radius + head);
    }
    let line = center - head_center;
    (-line.x).atan2(line.y)
}
