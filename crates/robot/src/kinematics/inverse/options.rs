//! What inverse kinematics is asked for, and what it answers.

use nalgebra::DVector;

use crate::error::RobotError;
use crate::kinematics::task_rows::TaskError;
use crate::manipulator::{check_finite, check_length};

/// Settings of [`InverseKinematics`](super::InverseKinematics).
#[derive(Debug, Clone, PartialEq)]
pub struct InverseKinematicsOptions {
    /// Largest accepted distance to the target (m).
    pub position_tolerance_m: f64,
    /// Largest accepted angle to the target (rad).
    pub angle_tolerance_rad: f64,
    /// Steps allowed for each attempt.
    pub steps: usize,
    /// Attempts from other postures after the first has failed.
    pub restarts: usize,
    /// Longest change of the joint vector in one step (Euclidean norm; rad or m).
    pub longest_step: f64,
    /// Posture (n entries; rad or m) that a redundant arm is drawn to without leaving the target: the answer is the posture
    /// nearest to it (Euclidean norm) among those that the arm can glide to while the frame stays. `None` takes what the
    /// search meets first.
    pub preferred_posture: Option<DVector<f64>>,
}

impl Default for InverseKinematicsOptions {
    fn default() -> Self {
        Self {
            position_tolerance_m: 1e-9,
            angle_tolerance_rad: 1e-9,
            steps: 200,
            restarts: 30,
            longest_step: 0.6,
            preferred_posture: None,
        }
    }
}

/// A posture that reaches the target.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseKinematicsSolution {
    /// Joint positions within the limits (n entries; rad or m).
    pub q: DVector<f64>,
    /// What is left to the target.
    pub error: TaskError,
    /// Steps taken, over all attempts.
    pub iterations: usize,
}

impl InverseKinematicsOptions {
    /// Checks the numbers for an arm of `n` joints.
    pub(crate) fn check(&self, n: usize) -> Result<(), RobotError> {
        let positive = [
            ("inverse kinematics: the position tolerance (m)", self.position_tolerance_m),
            ("inverse kinematics: the angle tolerance (rad)", self.angle_tolerance_rad),
            ("inverse kinematics: the longest step (rad or m)", self.longest_step),
        ];
        if let Some(&(quantity, found)) = positive.iter().find(|(_, found)| !(found.is_finite() && *found > 0.0)) {
            return Err(RobotError::InvalidArgument { quantity, found, expected: "above zero, finite" });
        }
        let Some(posture) = &self.preferred_posture else { return Ok(()) };
        check_length("inverse kinematics: the preferred posture", posture.len(), n)?;
        check_finite("a coordinate of the preferred posture", posture.iter())
    }
}

/// How [`crate::InverseKinematics::solve_in_place`] met its target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InverseKinematicsReport {
    /// What is left to the target.
    pub error: TaskError,
    /// Steps taken, over all attempts.
    pub iterations: usize,
}
