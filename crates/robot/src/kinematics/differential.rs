//! Joint references along a path of a frame: q from the pose, q̇ and q̈ from its velocity and acceleration.
//!
//! Without redundancy q̇ = J⁻¹ v and q̈ = J⁻¹ (a − J̇ q̇). A redundant arm takes either the shortest motion, q̇ = J⁺ v, whose
//! derivative is q̈ = J⁺ (a − J̇ q̇) + (1 − J⁺ J) J̇ᵀ (J Jᵀ)⁻¹ v, or the policy of a [`Redundancy`].

use nalgebra::{DVector, Isometry3, Matrix6xX, Vector6};

use crate::dynamics::composite::fit_vector;
use crate::error::RobotError;
use crate::kinematics::inverse::unreachable::UnreachableReason;
use crate::kinematics::pseudo_inverse::{PseudoInverse, keep_task_rows, masked, task_part};
use crate::kinematics::redundancy::Redundancy;
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

/// What following lost at one sample. Nothing, up to rounding, unless the posture is nearly singular and damped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowReport {
    /// What is left to the wanted pose.
    pub pose_error: TaskError,
    /// What is left to the wanted velocity (m/s, rows 0–2; rad/s, rows 3–5); zero in rows outside the task.
    pub velocity_loss: Vector6<f64>,
    /// Damping of J Jᵀ; zero in a regular posture.
    pub damping: f64,
}

/// Turns the wanted motion of one frame into joint references, sample after sample, without allocation.
#[derive(Debug, Clone)]
pub struct DifferentialKinematics {
    workspace: Workspace,
    frame: FrameId,
    rows: TaskRows,
    redundancy: Option<Redundancy>,
    jacobian: Matrix6xX<f64>,
    jacobian_rate: Matrix6xX<f64>,
    /// No joint is ever locked here; the list only serves the shared solver.
    unlocked: Vec<bool>,
    step: DVector<f64>,
    null_part: DVector<f64>,
    former: JointReference,
}

/// The arm at a sample: its factored Jacobian and what is left to the pose.
struct Met {
    inverse: PseudoInverse,
    error: TaskError,
    damping: f64,
}

impl DifferentialKinematics {
    /// Prepares a follower that leads `frame` in the coordinates `rows`; redundant arms take the shortest joint motion from
    /// each sample to the next, which depends on the path and may drift toward limits ([`Self::with_redundancy`] does not).
    ///
    /// # Errors
    /// [`RobotError::TooFewJoints`] if the task has more rows than the arm has joints, [`RobotError::FrameBehindMimic`].
    pub fn new(manipulator: &Manipulator, frame: FrameId, rows: TaskRows) -> Result<Self, RobotError> {
        manipulator.check_independent(frame)?;
        let n = manipulator.joint_count();
        if n < rows.indices().len() {
            let frame = manipulator.frame_name(frame).to_owned();
            return Err(RobotError::TooFewJoints { frame, rows: rows.indices().len(), joints: n });
        }
        Ok(Self {
            workspace: manipulator.workspace(),
            frame,
            rows,
            redundancy: None,
            jacobian: Matrix6xX::zeros(n),
            jacobian_rate: Matrix6xX::zeros(n),
            unlocked: vec![false; n],
            step: DVector::zeros(n),
            null_part: DVector::zeros(n),
            former: JointReference::at_rest(DVector::zeros(n)),
        })
    }

    /// Prepares a follower whose null-space motion obeys `redundancy`, and which slows down near singular postures instead
    /// of refusing them. Samples must be `redundancy.time_step_s` apart; the first reference is at rest.
    ///
    /// # Errors
    /// Those of [`Self::new`], and [`RobotError::InvalidArgument`] or [`RobotError::WrongLength`] for the policy.
    pub fn with_redundancy(
        manipulator: &Manipulator,
        frame: FrameId,
        rows: TaskRows,
        redundancy: Redundancy,
    ) -> Result<Self, RobotError> {
        redundancy.check(manipulator)?;
        Ok(Self { redundancy: Some(redundancy), ..Self::new(manipulator, frame, rows)? })
    }

    /// Replaces `reference` by the joint motion that gives the frame the wanted motion. The former `reference.q` (n
    /// entries; rad or m) is the start, so keep the reference from sample to sample; the first start comes from
    /// [`crate::InverseKinematics`]. A redundancy policy also goes on from the former velocities and accelerations.
    /// Allocation-free unless it fails. After an error `reference` is not to be used.
    ///
    /// # Errors
    /// [`RobotError::Unreachable`] if the pose is not met, [`RobotError::OutsideLimits`] if a joint leaves its range,
    /// [`RobotError::Singular`] if the Jacobian loses rank and no policy damps it, [`RobotError::InvalidArgument`] if a
    /// wanted number is not finite, [`RobotError::WrongLength`].
    pub fn follow(&mut self, wanted: &FrameMotion, reference: &mut JointReference) -> Result<FollowReport, RobotError> {
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
        match self.redundancy.take() {
            None => self.follow_shortest(wanted, reference),
            Some(policy) => {
                let followed = self.follow_policy(&policy, wanted, reference);
                self.redundancy = Some(policy);
                followed
            }
        }
    }

    fn follow_shortest(
        &mut self,
        wanted: &FrameMotion,
        reference: &mut JointReference,
    ) -> Result<FollowReport, RobotError> {
        let redundant = self.step.len() > self.rows.indices().len();
        self.former.q.copy_from(&reference.q);
        let mut met = self.meet_pose(&wanted.base_from_frame, &mut reference.q)?;
        if redundant {
            // half of the way's part in the null space of its end: the way is then shortest at its middle, not its start
            self.null_part.copy_from(&reference.q);
            self.null_part -= &self.former.q;
            met.inverse.keep_null_part(&self.jacobian, &self.unlocked, &mut self.null_part, &mut self.step);
            reference.q.axpy(-0.5, &self.null_part, 1.0);
            met = self.meet_pose(&wanted.base_from_frame, &mut reference.q)?;
        }
        self.check_limits(&reference.q)?;
        let velocity = masked(&wanted.velocity, self.rows);
        met.inverse.solve_into(&self.jacobian, &self.unlocked, &velocity, &mut reference.dq);
        self.workspace.set_state(&reference.q, &reference.dq)?;
        let remaining = wanted.acceleration - self.workspace.jacobian_rate_times_velocity(self.frame);
        met.inverse.solve_into(&self.jacobian, &self.unlocked, &masked(&remaining, self.rows), &mut reference.ddq);
        if redundant {
            self.workspace.jacobian_rate_into(self.frame, &mut self.jacobian_rate);
            keep_task_rows(&mut self.jacobian_rate, self.rows);
            self.null_part.gemv_tr(1.0, &self.jacobian_rate, &met.inverse.weights(&velocity), 0.0);
            met.inverse.keep_null_part(&self.jacobian, &self.unlocked, &mut self.null_part, &mut self.step);
            reference.ddq += &self.null_part;
        }
        Ok(self.report(&met, &velocity, &reference.dq))
    }

    /// Integrates the null-space motion by the trapezoidal rule; the frame's own motion is met at each sample anew.
    fn follow_policy(
        &mut self,
        policy: &Redundancy,
        wanted: &FrameMotion,
        reference: &mut JointReference,
    ) -> Result<FollowReport, RobotError> {
        let step_s = policy.time_step_s;
        check_finite(
            "a coordinate of the former reference",
            reference.q.iter().chain(reference.dq.iter()).chain(reference.ddq.iter()),
        )?;
        self.former.q.copy_from(&reference.q);
        self.former.dq.copy_from(&reference.dq);
        self.former.ddq.copy_from(&reference.ddq);
        reference.q.axpy(step_s, &self.former.dq, 1.0);
        reference.q.axpy(0.5 * step_s * step_s, &self.former.ddq, 1.0);
        let met = self.approach_pose(policy, &wanted.base_from_frame, &mut reference.q)?;
        self.check_limits(&reference.q)?;
        let velocity = masked(&wanted.velocity, self.rows);
        // the acceleration depends on the velocity: a guess, and its correction
        for _ in 0..2 {
            reference.dq.copy_from(&self.former.dq);
            reference.dq.axpy(0.5 * step_s, &self.former.ddq, 1.0);
            reference.dq.axpy(0.5 * step_s, &reference.ddq, 1.0);
            self.complete(&met.inverse, &velocity, &mut reference.dq);
            self.workspace.set_state(&reference.q, &reference.dq)?;
            policy.acceleration_into(&self.workspace, &reference.q, &mut reference.ddq);
            let remaining = wanted.acceleration - self.workspace.jacobian_rate_times_velocity(self.frame);
            self.complete(&met.inverse, &masked(&remaining, self.rows), &mut reference.ddq);
        }
        Ok(self.report(&met, &velocity, &reference.dq))
    }

    /// Adds J⁺ (`task` − J x) to `x`, so that J x is the task's.
    fn complete(&mut self, inverse: &PseudoInverse, task: &Vector6<f64>, x: &mut DVector<f64>) {
        let missing = task - task_part(&self.jacobian, x);
        inverse.solve_into(&self.jacobian, &self.unlocked, &missing, &mut self.step);
        *x += &self.step;
    }

    fn report(&self, met: &Met, velocity: &Vector6<f64>, dq: &DVector<f64>) -> FollowReport {
        let velocity_loss = velocity - task_part(&self.jacobian, dq);
        FollowReport { pose_error: met.error, velocity_loss, damping: met.damping }
    }

    /// Newton's method from `q` to the pose.
    fn meet_pose(&mut self, target: &Isometry3<f64>, q: &mut DVector<f64>) -> Result<Met, RobotError> {
        let mut error = TaskError { position_error_m: f64::INFINITY, angle_error_rad: f64::INFINITY };
        for _ in 0..NEWTON_STEPS {
            let displacement = self.look(target, q);
            error = TaskError::of(&displacement);
            let inverse = self.factor_jacobian()?;
            if is_met(&error) {
                return Ok(Met { inverse, error, damping: 0.0 });
            }
            self.take_step(&inverse, &displacement, q);
        }
        Err(lost(&error, UnreachableReason::NoCloserMotion, q))
    }

    /// Newton's method from `q` to the pose, or, in a nearly singular posture, one damped step toward it, as the joints
    /// would else move faster than their velocities say.
    fn approach_pose(
        &mut self,
        policy: &Redundancy,
        target: &Isometry3<f64>,
        q: &mut DVector<f64>,
    ) -> Result<Met, RobotError> {
        let mut displacement = self.look(target, q);
        for _ in 0..NEWTON_STEPS {
            let met = self.factor_damped(policy, &displacement)?;
            if is_met(&met.error) {
                return Ok(met);
            }
            self.take_step(&met.inverse, &displacement, q);
            displacement = self.look(target, q);
            if met.damping > 0.0 {
                return self.accept_lag(policy, &displacement, q);
            }
        }
        let error = TaskError::of(&displacement);
        Err(lost(&error, UnreachableReason::NoCloserMotion, q))
    }

    fn accept_lag(
        &self,
        policy: &Redundancy,
        displacement: &Vector6<f64>,
        q: &DVector<f64>,
    ) -> Result<Met, RobotError> {
        let met = self.factor_damped(policy, displacement)?;
        let kept = met.error.position_error_m <= policy.position_tolerance_m
            && met.error.angle_error_rad <= policy.angle_tolerance_rad;
        if kept {
            return Ok(met);
        }
        let pivot = met.inverse.smallest_pivot.max(0.0).sqrt();
        Err(lost(&met.error, UnreachableReason::NearlySingular { pivot }, q))
    }

    /// Factors the Jacobian with the damping that the policy asks for.
    fn factor_damped(&self, policy: &Redundancy, displacement: &Vector6<f64>) -> Result<Met, RobotError> {
        let error = TaskError::of(displacement);
        let exact = PseudoInverse::new(&self.jacobian, self.rows, &self.unlocked, 0.0);
        let damping = policy.damping(exact.as_ref().map_or(0.0, |inverse| inverse.smallest_pivot));
        let chosen =
            if damping > 0.0 { PseudoInverse::new(&self.jacobian, self.rows, &self.unlocked, damping) } else { exact };
        chosen.map(|inverse| Met { inverse, error, damping }).ok_or_else(|| self.singular(0.0))
    }

    /// Places the arm at `q` and evaluates the Jacobian; returns what is left to the target.
    fn look(&mut self, target: &Isometry3<f64>, q: &DVector<f64>) -> Vector6<f64> {
        self.workspace.place(q);
        self.workspace.jacobian_into(self.frame, &mut self.jacobian);
        keep_task_rows(&mut self.jacobian, self.rows);
        self.rows.displacement(&self.workspace.base_from_frame(self.frame), target)
    }

    fn take_step(&mut self, inverse: &PseudoInverse, displacement: &Vector6<f64>, q: &mut DVector<f64>) {
        inverse.solve_into(&self.jacobian, &self.unlocked, displacement, &mut self.step);
        let length = self.step.norm();
        let scale = if length > LONGEST_STEP { LONGEST_STEP / length } else { 1.0 };
        q.axpy(scale, &self.step, 1.0);
    }

    fn factor_jacobian(&self) -> Result<PseudoInverse, RobotError> {
        let inverse = PseudoInverse::new(&self.jacobian, self.rows, &self.unlocked, 0.0);
        let pivot = inverse.as_ref().map_or(0.0, |inverse| inverse.smallest_pivot);
        match inverse {
            Some(inverse) if pivot > LEAST_PIVOT => Ok(inverse),
            _ => Err(self.singular(pivot)),
        }
    }

    fn singular(&self, pivot: f64) -> RobotError {
        RobotError::Singular { frame: self.workspace.model.frame_name(self.frame).to_owned(), pivot }
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

fn is_met(error: &TaskError) -> bool {
    error.position_error_m <= TOLERANCE && error.angle_error_rad <= TOLERANCE
}

fn lost(error: &TaskError, reason: UnreachableReason, q: &DVector<f64>) -> RobotError {
    RobotError::Unreachable {
        position_error_m: error.position_error_m,
        angle_error_rad: error.angle_error_rad,
        reason,
        q_closest: q.clone(),
    }
}
