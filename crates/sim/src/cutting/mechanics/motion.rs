//! Where the knife is in the section's frame, and how it moves.

use nalgebra::{Isometry3, Point2, Vector2, Vector3};

/// Pose and velocity of the knife's frame in the section's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeMotion {
    /// Origin of the knife's frame (the heel of the edge) in the section's plane, m.
    pub position: Point2<f64>,
    /// Rotation of the knife in the section's plane, about z, rad: rocking.
    pub angle_rad: f64,
    /// Distance of the knife's origin from the section's plane along z, m.
    pub lateral_m: f64,
    /// Slope of the blade's plane against the section's along y, as a rotation about x, rad: the blade leans.
    pub tilt_rad: f64,
    /// Slope of the blade's plane against the section's along x, as a rotation about y, rad: the blade turns.
    pub yaw_rad: f64,
    /// Velocity of the knife's origin in the section's frame, m/s.
    pub velocity_in_section: Vector3<f64>,
    /// Angular velocity of the knife in the section's frame, rad/s.
    pub angular_velocity_in_section: Vector3<f64>,
}

impl EdgeMotion {
    /// Motion of a knife whose blade lies in the section's plane and keeps its angle.
    #[must_use]
    pub fn translating(position: Point2<f64>, velocity: Vector2<f64>) -> Self {
        Self {
            position,
            angle_rad: 0.0,
            lateral_m: 0.0,
            tilt_rad: 0.0,
            yaw_rad: 0.0,
            velocity_in_section: Vector3::new(velocity.x, velocity.y, 0.0),
            angular_velocity_in_section: Vector3::zeros(),
        }
    }

    /// Motion of a knife at `section_from_knife` with velocities of its origin and its frame, both in the section's frame;
    /// none if the blade stands square to the section's plane or beyond.
    #[must_use]
    pub fn from_pose(
        section_from_knife: &Isometry3<f64>,
        velocity_in_section: Vector3<f64>,
        angular_velocity_in_section: Vector3<f64>,
    ) -> Option<Self> {
        let along = section_from_knife.rotation * Vector3::x();
        let normal = section_from_knife.rotation * Vector3::z();
        // the blade's plane, z = lateral + tilt (y - y0) - yaw (x - x0), exactly for every angle below a right one
        (normal.z > 1e-6).then(|| Self {
            position: Point2::new(section_from_knife.translation.x, section_from_knife.translation.y),
            angle_rad: along.y.atan2(along.x),
            lateral_m: section_from_knife.translation.z,
            tilt_rad: -normal.y / normal.z,
            yaw_rad: normal.x / normal.z,
            velocity_in_section,
            angular_velocity_in_section,
        })
    }

    /// Velocity in the section's plane of the knife's point that is at (x, y).
    pub(super) fn velocity_at(&self, x: f64, y: f64) -> Vector2<f64> {
        let (spin, velocity) = (self.angular_velocity_in_section.z, &self.velocity_in_section);
        Vector2::new(velocity.x - spin * (y - self.position.y), velocity.y + spin * (x - self.position.x))
    }

    /// Distance of the blade's plane from the section's at (x, y), m.
    pub(super) fn deviation_at(&self, x: f64, y: f64) -> f64 {
        self.lateral_m + self.tilt_rad * (y - self.position.y) - self.yaw_rad * (x - self.position.x)
    }

    /// The first number that is not finite, by name.
    pub(super) fn not_finite(&self) -> Option<(&'static str, f64)> {
        let (v, w) = (&self.velocity_in_section, &self.angular_velocity_in_section);
        [
            ("x of the knife (m)", self.position.x),
            ("y of the knife (m)", self.position.y),
            ("angle of the knife (rad)", self.angle_rad),
            ("lateral deviation of the knife (m)", self.lateral_m),
            ("tilt of the knife (rad)", self.tilt_rad),
            ("yaw of the knife (rad)", self.yaw_rad),
            ("speed of the knife (m/s)", v.x + v.y + v.z),
            ("angular speed of the knife (rad/s)", w.x + w.y + w.z),
        ]
        .into_iter()
        .find(|(_, value)| !value.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::{Translation3, UnitQuaternion, Vector3};

    #[test]
    fn a_pose_gives_the_deviation_of_every_point_of_the_blade() {
        let rotation = UnitQuaternion::from_euler_angles(0.1, -0.2, 0.4);
        let pose = Isometry3::from_parts(Translation3::new(0.01, -0.02, 0.003), rotation);
        let motion = EdgeMotion::from_pose(&pose, Vector3::zeros(), Vector3::zeros()).unwrap();
        for (along, down) in [(0.0, 0.0), (0.1, 0.0), (0.05, -0.03)] {
            let point = pose * nalgebra::Point3::new(along, down, 0.0);
            assert_relative_eq!(motion.deviation_at(point.x, point.y), point.z, epsilon = 1e-12);
        }
    }

    #[test]
    fn a_blade_square_to_the_section_has_no_motion_in_it() {
        let flat = Isometry3::rotation(Vector3::x() * std::f64::consts::FRAC_PI_2);
        assert_eq!(EdgeMotion::from_pose(&flat, Vector3::zeros(), Vector3::zeros()), None);
    }
}
