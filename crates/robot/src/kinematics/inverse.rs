//! Inverse kinematics by damped least squares within the joint limits.
//!
//! Each step solves Δq = Jᵀ (J Jᵀ + λ)⁻¹ e with a damping λ that fades with the error, is clamped in length, and locks
//! joints that would leave their limits (active set). If an attempt stalls, the next starts from a pseudo-random posture of
//! a fixed sequence, so that the same question always has the same answer. A redundant arm with a preferred posture is
//! pulled to it in the null space, less and less as the error shrinks; once the target is met, it glides to the nearest
//! posture that it can reach without leaving the target.
//!
//! The damping in proportion to the squared error is that of T. Sugihara, "Solvability-unconcerned inverse kinematics by the
//! Levenberg-Marquardt method", IEEE Transactions on Robotics 27(5), 2011.

use nalgebra::{DVector, Isometry3, Matrix6xX, Vector6};

use crate::error::RobotError;
use crate::kinematics::inverse::options::{
    InverseKinematicsOptions, InverseKinematicsReport, InverseKinematicsSolution,
};
use crate::kinematics::inverse::unreachable::{ReachBound, limit_refusal};
use crate::kinematics::task_rows::{TaskError, TaskRows};
use crate::manipulator::{FrameId, Manipulator, check_finite, check_length};
use crate::workspace::Workspace;

mod descent;
pub(crate) mod options;
pub(crate) mod unreachable;

/// Start of the sequence of restart postures (any odd number).
const RESTART_SEED: u64 = 0x9E37_79B9_7F4A_7C15;

/// A solver for one frame and one choice of task rows, with its scratch memory.
#[derive(Debug, Clone)]
pub struct InverseKinematics {
    workspace: Workspace,
    frame: FrameId,
    rows: TaskRows,
    options: InverseKinematicsOptions,
    reach: Option<ReachBound>,
    jacobian: Matrix6xX<f64>,
    locked: Vec<bool>,
    q: DVector<f64>,
    step: DVector<f64>,
    pull: DVector<f64>,
    former_pull: DVector<f64>,
    correction: DVector<f64>,
    closest: Closest,
}

/// The best posture met so far.
#[derive(Debug, Clone)]
struct Closest {
    q: DVector<f64>,
    displacement: Vector6<f64>,
}

impl InverseKinematics {
    /// Prepares a solver that leads `frame` in the coordinates `rows`.
    ///
    /// # Errors
    /// [`RobotError::WrongLength`] if the preferred posture has another length than the arm has joints;
    /// [`RobotError::InvalidArgument`] for a tolerance or a step that is not above zero;
    /// [`RobotError::FrameBehindMimic`] if a joint that mimics another carries the frame.
    pub fn new(
        manipulator: &Manipulator,
        frame: FrameId,
        rows: TaskRows,
        options: InverseKinematicsOptions,
    ) -> Result<Self, RobotError> {
        manipulator.check_independent(frame)?;
        let n = manipulator.joint_count();
        options.check(n)?;
        let zeros = DVector::zeros(n);
        // a joint that others mimic goes no farther than they can
        let mut own = manipulator.clone();
        for joint in 0..n {
            own.joints[joint].limits = manipulator.leader_limits(joint)?;
        }
        Ok(Self {
            workspace: own.workspace(),
            frame,
            rows,
            options,
            reach: ReachBound::new(manipulator, frame),
            jacobian: Matrix6xX::zeros(n),
            locked: vec![false; n],
            q: zeros.clone(),
            step: zeros.clone(),
            pull: zeros.clone(),
            former_pull: zeros.clone(),
            correction: zeros.clone(),
            closest: Closest { q: zeros, displacement: Vector6::repeat(f64::INFINITY) },
        })
    }

    /// Finds joint positions that bring the frame to `base_from_target`, starting from `start` (n entries; rad or m), which
    /// is first brought within the limits. A start near the answer makes it quick and keeps its branch.
    ///
    /// # Errors
    /// [`RobotError::Unreachable`] with the closest posture found and the reason; [`RobotError::WrongLength`];
    /// [`RobotError::InvalidArgument`] if the target or the start is not finite.
    pub fn solve(
        &mut self,
        base_from_target: &Isometry3<f64>,
        start: &DVector<f64>,
    ) -> Result<InverseKinematicsSolution, RobotError> {
        let InverseKinematicsReport { error, iterations } = self.search(base_from_target, start)?;
        Ok(InverseKinematicsSolution { q: self.closest.q.clone(), error, iterations })
    }

    /// The same with `q` (n entries; rad or m) as the start, which the answer replaces. Allocation-free unless it fails;
    /// then `q` keeps the start.
    ///
    /// # Errors
    /// Those of [`Self::solve`].
    pub fn solve_in_place(
        &mut self,
        base_from_target: &Isometry3<f64>,
        q: &mut DVector<f64>,
    ) -> Result<InverseKinematicsReport, RobotError> {
        let report = self.search(base_from_target, q)?;
        q.copy_from(&self.closest.q);
        Ok(report)
    }

    /// Attempt after attempt; leaves the answer in `self.closest`.
    fn search(&mut self, target: &Isometry3<f64>, start: &DVector<f64>) -> Result<InverseKinematicsReport, RobotError> {
        check_length("inverse kinematics: the start", start.len(), self.q.len())?;
        check_finite("a coordinate of the start", start.iter())?;
        let (place, turn) = (&target.translation.vector, &target.rotation.coords);
        check_finite("a coordinate of the target", place.iter().chain(turn.iter()))?;
        self.closest.displacement.fill(f64::INFINITY);
        self.closest.q.copy_from(start);
        let mut iterations = 0;
        let mut random = RESTART_SEED;
        for attempt in 0..=self.options.restarts {
            self.begin(attempt, start, &mut random);
            iterations += self.attempt(target);
            if self.accepts(&self.closest.displacement) {
                iterations += self.glide(target);
                return Ok(InverseKinematicsReport { error: TaskError::of(&self.closest.displacement), iterations });
            }
        }
        iterations += self.refine(target);
        if self.accepts(&self.closest.displacement) {
            return Ok(InverseKinematicsReport { error: TaskError::of(&self.closest.displacement), iterations });
        }
        Err(self.unreachable(target))
    }

    /// Puts `self.q` where an attempt starts: the given posture, then the preferred one if there is one, then random ones.
    fn begin(&mut self, attempt: usize, start: &DVector<f64>, random: &mut u64) {
        let given = match (&self.options.preferred_posture, attempt) {
            (_, 0) => Some(start),
            (Some(posture), 1) => Some(posture),
            _ => None,
        };
        for (index, joint) in self.workspace.model.joints.iter().enumerate() {
            let limits = &joint.limits;
            self.q[index] = match given {
                Some(posture) => limits.clamp(posture[index]),
                None => random_position(limits.lower, limits.upper, start[index], random),
            };
        }
    }

    fn accepts(&self, displacement: &Vector6<f64>) -> bool {
        let error = TaskError::of(displacement);
        error.position_error_m <= self.options.position_tolerance_m
            && error.angle_error_rad <= self.options.angle_tolerance_rad
    }

    fn unreachable(&mut self, target: &Isometry3<f64>) -> RobotError {
        self.q.copy_from(&self.closest.q);
        let displacement = self.look(target);
        let error = TaskError::of(&displacement);
        let too_far = self.reach.as_ref().and_then(|reach| reach.refusal(&self.workspace.model, target));
        let reason =
            too_far.unwrap_or_else(|| limit_refusal(&self.workspace, self.q.as_slice(), &self.jacobian, &displacement));
        RobotError::Unreachable {
            position_error_m: error.position_error_m,
            angle_error_rad: error.angle_error_rad,
            reason,
            q_closest: self.closest.q.clone(),
        }
    }
}

/// A posture for a restart: uniform within the limits, or within π (rad or m) of the start if unlimited.
fn random_position(lower: Option<f64>, upper: Option<f64>, start: f64, random: &mut u64) -> f64 {
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    let uniform = (*random >> 11) as f64 / (1_u64 << 53) as f64;
    let lower_or = lower.unwrap_or(upper.map_or(start, |upper| start.min(upper)) - std::f64::consts::PI);
    let upper_or = upper.unwrap_or(start.max(lower_or) + std::f64::consts::PI);
    lower_or + uniform * (upper_or - lower_or)
}
