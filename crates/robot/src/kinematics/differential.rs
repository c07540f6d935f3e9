//! Joint references along a path of a frame: q from the pose, q̇ = J⁺ v, q̈ = J⁺ (a − J̇ q̇).

use nalgebra::{DVector, Isometry3, Matrix6xX, Vector6};

use crate::dynamics::composite::fit_vector;
use crate::error::RobotError;
use crate::kinematics::pseudo_inverse::{PseudoInverse, keep_task_rows, masked};
use crate::kinematics::task_rows::{TaskError, TaskRows};
use crate::manipulator::{FrameId, Manipulator, check_finite, check_length};
use crate::state::JointReference;
use crate::workspace::Workspace;

/// Newton steps allowed for one sample; neighboring samples of a smooth path need two or three.
const NEWTON_STEPS: usize = 40;
/// Distance (m) and angle (rad) at which a sample is met: far below any simulated contact, far above rounding.
const TOLERANCE: f64 = 1e-11;
/// Longest Newton step (norm; rad or m); longer ones leave the range in which the linear model holds.
const LONGEST_STEP: f64 = 0.3;
/// Squared pivot of J Jᵀ below which a posture counts as singular (a pivot of 1e-5 m/rad).
const LEAST_PIVOT: f64 = 1e-10;

/// Wanted motion of a frame at one instant, in base axes.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameMotion {
    /// Pose of the frame in the base.
    pub base_from_frame: Isometry3<f64>,
    /// Velocity of the origin (m/s, rows 0–2) and angular velocity (rad/s, rows 3–5).
    pub velocity: Vector6<f64>,
    /// Acceleration of the origin (m/s², rows 0–2) and angular acceleration (rad/s², rows 3–5).
    pub acceleration: Vector6<f64>,
}

/// Turns the wanted motion of one frame into joint references, sample after sample, without allocation.
#[derive(Debug, Clone)]
pub struct DifferentialKinematics {
    workspace: Workspace,
    frame: FrameId,
    rows: TaskRows,
    jacobian: Matrix6xX<f64>,
    /// No joint is ever locked here; the list only serves the shared solver.
    unlocked: Vec<bool>,
    step: DVector<f64>,
}

impl DifferentialKinematics {
    /// Prepares a follower that leads `frame` in the coordinates `rows`; redundant arms take the shortest joint motion.
    ///
    /// # Errors
    /// [`RobotError::TooFewJoints`] if the task has more rows than the arm has joints.
    pub fn new(manipulator: &Manipulator, frame: FrameId, rows: TaskRows) -> Result<Self, RobotError> {
        let n = manipulator.joint_count();
        if n < rows.indices().len() {
            let frame = manipulator.frame_name(frame).to_owned();
            return Err(RobotError::TooFewJoints { frame, rows: rows.indices().len(), joints: n });
        }
        Ok(Self {
            workspace: manipulator.workspace(),
            frame,
            rows,
            jacobian: Matrix6xX::zeros(n),
            unlocked: vec![false; n],
            step: DVector::zeros(n),
        })
    }

    /// Replaces `reference` by the joint motion that gives the frame the wanted motion. The former `reference.q` (n
    /// entries; rad or m) is the start, so keep the reference from sample to sample; the first start comes from
    /// [`crate::InverseKinematics`]. Allocation-free unless it fails. After an error `reference` is not to be used.
    ///
    /// # Errors
    /// [`RobotError::Unreachable`] if the pose is not met, [`RobotError::OutsideLimits`] if a joint leaves its range,
    /// [`RobotError::Singular`] if the Jacobian loses rank, [`RobotError::InvalidArgument`] if a wanted number is not finite,
    /// [`RobotError::WrongLength`].
    pub fn follow(&mut self, wanted: &FrameMotion, reference: &mut JointReference) -> Result<(), RobotError> {
        check_length("follow path: the reference", reference.q.len(), self.step.len())?;
        let pose = &wanted.base_from_frame;
        check_finite(
            "a coordinate of the wanted pose",
            pose.translation.vector.iter().chain(pose.rotation.coords.iter()),
        )?;
        check_finite(
            "a component of the wanted velocity or acceleration",
            wanted.velocity.iter().chain(&wanted.acceleration),
        )?;
        fit_vector(&mut reference.dq, self.step.len());
        fit_vector(&mut reference.ddq, self.step.len());
        let inverse = self.meet_pose(&wanted.base_from_frame, &mut reference.q)?;
        self.check_limits(&reference.q)?;
        let velocity = masked(&wanted.velocity, self.rows);
        inverse.solve_into(&self.jacobian, &self.unlocked, &velocity, &mut reference.dq);
        self.workspace.set_state(&reference.q, &reference.dq)?;
        let remaining = wanted.acceleration - self.workspace.jacobian_rate_times_velocity(self.frame);
        inverse.solve_into(&self.jacobian, &self.unlocked, &masked(&remaining, self.rows), &mut reference.ddq);
        Ok(())
    }

    /// Newton's method from `q` to the pose; returns the factored Jacobian there.
    fn meet_pose(&mut self, target: &Isometry3<f64>, q: &mut DVector<f64>) -> Result<PseudoInverse, RobotError> {
        let mut error = TaskError { position_error_m: f64::INFINITY, angle_error_rad: f64::INFINITY };
        for _ in 0..NEWTON_STEPS {
            self.workspace.set_positions(q)?;
            let displacement = self.rows.displacement(&self.workspace.base_from_frame(self.frame), target);
            error = TaskError::of(&displacement);
            self.workspace.jacobian_into(self.frame, &mut self.jacobian);
            keep_task_rows(&mut self.jacobian, self.rows);
            let inverse = self.factor_jacobian()?;
            if error.position_error_m <= TOLERANCE && error.angle_error_rad <= TOLERANCE {
                return Ok(inverse);
            }
            inverse.solve_into(&self.jacobian, &self.unlocked, &displacement, &mut self.step);
            let length = self.step.norm();
            let scale = if length > LONGEST_STEP { LONGEST_STEP / length } else { 1.0 };
            q.axpy(scale, &self.step, 1.0);
        }
        Err(RobotError::Unreachable {
            position_error_m: error.position_error_m,
            angle_error_rad: error.angle_error_rad,
            limiting_joint: None,
            q_closest: q.clone(),
        })
    }

    fn factor_jacobian(&self) -> Result<PseudoInverse, RobotError> {
        let inverse = PseudoInverse::new(&self.jacobian, self.rows, &self.unlocked, 0.0);
        let pivot = inverse.as_ref().map_or(0.0, |inverse| inverse.smallest_pivot);
        match inverse {
            Some(inverse) if pivot > LEAST_PIVOT => Ok(inverse),
            _ => {
                let frame = self.workspace.model.frame_name(self.frame).to_owned();
                Err(RobotError::Singular { frame, pivot })
            }
        }
    }

    fn check_limits(&self, q: &DVector<f64>) -> Result<(), RobotError> {
        for (joint, &found) in self.workspace.model.joints.iter().zip(q.iter()) {
            let lower = joint.limits.lower.unwrap_or(f64::NEG_INFINITY);
            let upper = joint.limits.upper.unwrap_or(f64::INFINITY);
            if found < lower || found > upper {
                return Err(RobotError::OutsideLimits { joint: joint.name.clone(), found, lower, upper });
            }
        }
        Ok(())
    }
}
