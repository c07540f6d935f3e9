//! State of a tool in space, and the difference between two states that should be one.

use nalgebra::{Isometry3, Vector3, Vector6};
use serde::Serialize;

/// Pose `world_from_tool` with its motion: three linear coordinates of the tool's origin, then three angular ones, both
/// along the axes of the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpatialMotion {
    /// Pose of the tool, `world_from_tool`, m.
    pub pose: Isometry3<f64>,
    /// Velocity of the tool's origin, m/s, and angular velocity, rad/s.
    pub velocity: Vector6<f64>,
    /// Acceleration of the tool's origin, m/s², and angular acceleration, rad/s².
    pub acceleration: Vector6<f64>,
}

impl SpatialMotion {
    /// At rest at a pose, `world_from_tool`.
    #[must_use]
    pub fn at_rest(pose: Isometry3<f64>) -> Self {
        Self { pose, velocity: Vector6::zeros(), acceleration: Vector6::zeros() }
    }

    /// Puts linear and angular parts together: m/s and rad/s, m/s² and rad/s².
    #[must_use]
    pub fn new(pose: Isometry3<f64>, velocity: [Vector3<f64>; 2], acceleration: [Vector3<f64>; 2]) -> Self {
        Self { pose, velocity: six(velocity), acceleration: six(acceleration) }
    }

    /// Velocity of the tool's origin, m/s.
    #[must_use]
    pub fn linear_velocity(&self) -> Vector3<f64> {
        self.velocity.fixed_rows::<3>(0).into()
    }

    /// Angular velocity, rad/s.
    #[must_use]
    pub fn angular_velocity(&self) -> Vector3<f64> {
        self.velocity.fixed_rows::<3>(3).into()
    }

    /// Acceleration of the tool's origin, m/s².
    #[must_use]
    pub fn linear_acceleration(&self) -> Vector3<f64> {
        self.acceleration.fixed_rows::<3>(0).into()
    }

    /// Angular acceleration, rad/s².
    #[must_use]
    pub fn angular_acceleration(&self) -> Vector3<f64> {
        self.acceleration.fixed_rows::<3>(3).into()
    }

    /// The motion of a frame that the tool carries, `tool_from_other`.
    #[must_use]
    pub fn carrying(&self, tool_from_other: &Isometry3<f64>) -> Self {
        let arm = self.pose.rotation * tool_from_other.translation.vector;
        let (turn, change) = (self.angular_velocity(), self.angular_acceleration());
        Self::new(
            self.pose * tool_from_other,
            [self.linear_velocity() + turn.cross(&arm), turn],
            [self.linear_acceleration() + change.cross(&arm) + turn.cross(&turn.cross(&arm)), change],
        )
    }

    /// The same motion in another frame, `other_from_world`.
    #[must_use]
    pub fn seen_from(&self, other_from_world: &Isometry3<f64>) -> Self {
        let turned = |vector: Vector3<f64>| other_from_world.rotation * vector;
        Self::new(
            other_from_world * self.pose,
            [turned(self.linear_velocity()), turned(self.angular_velocity())],
            [turned(self.linear_acceleration()), turned(self.angular_acceleration())],
        )
    }

    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        let pose = self.pose.translation.vector.iter().chain(self.pose.rotation.coords.iter());
        pose.chain(self.velocity.iter()).chain(self.acceleration.iter()).copied()
    }
}

fn six([linear, angular]: [Vector3<f64>; 2]) -> Vector6<f64> {
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}

/// Difference between two motions that should be one: of pose (C0), velocities (C1) and accelerations (C2).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct SpatialJump {
    /// Distance, m.
    pub position_m: f64,
    /// Angle, rad.
    pub angle_rad: f64,
    /// Difference of the velocities, m/s.
    pub velocity_m_per_s: f64,
    /// Difference of the angular velocities, rad/s.
    pub angular_velocity_rad_per_s: f64,
    /// Difference of the accelerations, m/s².
    pub acceleration_m_per_s2: f64,
    /// Difference of the angular accelerations, rad/s².
    pub angular_acceleration_rad_per_s2: f64,
}

impl SpatialJump {
    /// Compares two motions, world frame.
    #[must_use]
    pub fn between(end: &SpatialMotion, start: &SpatialMotion) -> Self {
        Self {
            position_m: (start.pose.translation.vector - end.pose.translation.vector).norm(),
            angle_rad: start.pose.rotation.angle_to(&end.pose.rotation),
            velocity_m_per_s: (start.linear_velocity() - end.linear_velocity()).norm(),
            angular_velocity_rad_per_s: (start.angular_velocity() - end.angular_velocity()).norm(),
            acceleration_m_per_s2: (start.linear_acceleration() - end.linear_acceleration()).norm(),
            angular_acceleration_rad_per_s2: (start.angular_acceleration() - end.angular_acceleration()).norm(),
        }
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use nalgebra::UnitQuaternion;

    use super::*;

    #[test]
    fn a_carried_point_moves_on_a_circle() {
        // 2 rad/s about z, a point 0.1 m along x: 0.2 m/s along y and 0.4 m/s² inward
        let pose = Isometry3::from_parts(Vector3::new(1.0, 0.0, 0.0).into(), UnitQuaternion::identity());
        let turning =
            SpatialMotion::new(pose, [Vector3::zeros(), Vector3::z() * 2.0], [Vector3::zeros(), Vector3::zeros()]);
        let point = turning.carrying(&Isometry3::translation(0.1, 0.0, 0.0));
        assert_abs_diff_eq!(point.linear_velocity(), Vector3::y() * 0.2, epsilon = 1e-15);
        assert_abs_diff_eq!(point.linear_acceleration(), Vector3::x() * -0.4, epsilon = 1e-15);
    }
}
