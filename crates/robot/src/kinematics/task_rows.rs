//! Which coordinates of a pose a task asks for, and how far a pose is from its target in them.

use nalgebra::{Isometry3, Vector6};

/// The coordinates of a frame that a task fixes, all in base axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TaskRows {
    /// Position and orientation: six rows.
    Pose,
    /// Position alone: three rows.
    Position,
    /// x, y and the rotation about z, for an arm that moves in the base plane: three rows.
    PlanarPose,
}

/// How far a frame is from its target, in the coordinates of the task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskError {
    /// Distance in the positional rows (m).
    pub position_error_m: f64,
    /// Angle in the rotational rows (rad).
    pub angle_error_rad: f64,
}

impl TaskRows {
    /// Returns the rows of a 6-row velocity or Jacobian (linear first) that belong to the task.
    pub fn indices(self) -> &'static [usize] {
        match self {
            Self::Pose => &[0, 1, 2, 3, 4, 5],
            Self::Position => &[0, 1, 2],
            Self::PlanarPose => &[0, 1, 5],
        }
    }

    /// The displacement from a pose to its target, linear first (m, rad) in base axes; zero in rows outside the task.
    pub(crate) fn displacement(
        self,
        base_from_frame: &Isometry3<f64>,
        base_from_target: &Isometry3<f64>,
    ) -> Vector6<f64> {
        let linear = base_from_target.translation.vector - base_from_frame.translation.vector;
        let turn = base_from_target.rotation * base_from_frame.rotation.inverse();
        match self {
            Self::Position => Vector6::new(linear.x, linear.y, linear.z, 0.0, 0.0, 0.0),
            Self::PlanarPose => {
                let yaw = wrapped(2.0 * turn.k.atan2(turn.w));
                Vector6::new(linear.x, linear.y, 0.0, 0.0, 0.0, yaw)
            }
            Self::Pose => {
                let angular = turn.scaled_axis();
                Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
            }
        }
    }
}

impl TaskError {
    pub(crate) fn of(displacement: &Vector6<f64>) -> Self {
        Self {
            position_error_m: displacement.fixed_rows::<3>(0).norm(),
            angle_error_rad: displacement.fixed_rows::<3>(3).norm(),
        }
    }
}

/// The same angle within (−π, π].
fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if angle > PI {
        angle - TAU
    } else if angle <= -PI {
        angle + TAU
    } else {
        angle
    }
}
