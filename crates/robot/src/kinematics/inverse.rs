//! Inverse kinematics by damped least squares within the joint limits.
//!
//! Each step solves Δq = Jᵀ (J Jᵀ + λ)⁻¹ e with a damping λ that fades with the error, is clamped in length, and locks
//! joints that would leave their limits (active set). A fading pull in the null space draws redundant arms to a preferred
//! posture. If an attempt stalls, the next starts from a pseudo-random posture of a fixed sequence, so that the same
//! question always has the same answer.

use nalgebra::{DVector, Isometry3, Matrix6xX, Vector6};

use crate::error::RobotError;
use crate::kinematics::pseudo_inverse::{PseudoInverse, keep_task_rows};
use crate::kinematics::task_rows::{TaskError, TaskRows};
use crate::manipulator::{FrameId, Manipulator, check_finite, check_length};
use crate::workspace::Workspace;

/// Damping for each squared unit of the error.
const DAMPING_PER_SQUARED_ERROR: f64 = 0.02;
/// Damping that remains near the target; small against squared singular values of a well-posed arm (about 1e-3).
const LEAST_DAMPING: f64 = 1e-8;
/// Pull to the preferred posture, as a part of the way for each step, at full strength.
const POSTURE_GAIN: f64 = 0.1;
/// Error below which the pull to the preferred posture fades in proportion.
const POSTURE_FADE_ERROR: f64 = 0.1;
/// Steps without a better error after which an attempt is given up.
const STALLED_STEPS: usize = 12;
/// A step counts as better only if it lowers the error by this part.
const LEAST_IMPROVEMENT: f64 = 1e-6;
/// Start of the sequence of restart postures (any odd number).
const RESTART_SEED: u64 = 0x9E37_79B9_7F4A_7C15;

/// Settings of [`InverseKinematics`].
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
    /// Posture (n entries; rad or m) that a redundant arm is drawn to while it approaches the target.
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

/// A solver for one frame and one choice of task rows, with its scratch memory.
#[derive(Debug, Clone)]
pub struct InverseKinematics {
    workspace: Workspace,
    frame: FrameId,
    rows: TaskRows,
    options: InverseKinematicsOptions,
    jacobian: Matrix6xX<f64>,
    locked: Vec<bool>,
    q: DVector<f64>,
    step: DVector<f64>,
    pull: DVector<f64>,
    correction: DVector<f64>,
    closest: Closest,
}

/// The best posture met so far.
#[derive(Debug, Clone)]
struct Closest {
    q: DVector<f64>,
    displacement: Vector6<f64>,
    limiting_joint: Option<usize>,
}

impl InverseKinematics {
    /// Prepares a solver that leads `frame` in the coordinates `rows`.
    ///
    /// # Errors
    /// [`RobotError::WrongLength`] if the preferred posture has another length than the arm has joints.
    pub fn new(
        manipulator: &Manipulator,
        frame: FrameId,
        rows: TaskRows,
        options: InverseKinematicsOptions,
    ) -> Result<Self, RobotError> {
        let n = manipulator.joint_count();
        if let Some(posture) = &options.preferred_posture {
            check_length("inverse kinematics: the preferred posture", posture.len(), n)?;
        }
        let zeros = DVector::zeros(n);
        Ok(Self {
            workspace: manipulator.workspace(),
            frame,
            rows,
            options,
            jacobian: Matrix6xX::zeros(n),
            locked: vec![false; n],
            q: zeros.clone(),
            step: zeros.clone(),
            pull: zeros.clone(),
            correction: zeros.clone(),
            closest: Closest { q: zeros, displacement: Vector6::repeat(f64::INFINITY), limiting_joint: None },
        })
    }

    /// Finds joint positions that bring the frame to `base_from_target`, starting from `start` (n entries; rad or m), which
    /// is first brought within the limits. A start near the answer makes it quick and keeps its branch.
    ///
    /// # Errors
    /// [`RobotError::Unreachable`] with the closest posture; [`RobotError::WrongLength`]; [`RobotError::InvalidArgument`]
    /// if the target or the start is not finite.
    pub fn solve(
        &mut self,
        base_from_target: &Isometry3<f64>,
        start: &DVector<f64>,
    ) -> Result<InverseKinematicsSolution, RobotError> {
        check_length("inverse kinematics: the start", start.len(), self.q.len())?;
        check_finite("a coordinate of the start", start.iter())?;
        check_finite("a coordinate of the target", base_from_target.to_homogeneous().iter())?;
        self.closest.displacement.fill(f64::INFINITY);
        self.closest.q.copy_from(start);
        let mut iterations = 0;
        let mut random = RESTART_SEED;
        for attempt in 0..=self.options.restarts {
            for (index, joint) in self.workspace.model.joints.iter().enumerate() {
                let limits = &joint.limits;
                self.q[index] = match attempt {
                    0 => limits.clamp(start[index]),
                    _ => random_position(limits.lower, limits.upper, start[index], &mut random),
                };
            }
            iterations += self.attempt(base_from_target);
            let error = TaskError::of(&self.closest.displacement);
            if self.accepts(&error) {
                return Ok(InverseKinematicsSolution { q: self.closest.q.clone(), error, iterations });
            }
        }
        Err(self.unreachable())
    }

    fn accepts(&self, error: &TaskError) -> bool {
        error.position_error_m <= self.options.position_tolerance_m
            && error.angle_error_rad <= self.options.angle_tolerance_rad
    }

    fn unreachable(&self) -> RobotError {
        let error = TaskError::of(&self.closest.displacement);
        let joints = &self.workspace.model.joints;
        RobotError::Unreachable {
            position_error_m: error.position_error_m,
            angle_error_rad: error.angle_error_rad,
            limiting_joint: self.closest.limiting_joint.map(|joint| joints[joint].name.clone()),
            q_closest: self.closest.q.clone(),
        }
    }

    /// Descends from `self.q` until the target is met or the error stalls; returns the steps taken.
    fn attempt(&mut self, target: &Isometry3<f64>) -> usize {
        let mut least = f64::INFINITY;
        let mut stalled = 0;
        for iteration in 0..self.options.steps {
            self.workspace.dq.fill(0.0);
            self.workspace.place(&self.q);
            let displacement = self.rows.displacement(&self.workspace.base_from_frame(self.frame), target);
            let error = displacement.norm();
            stalled = if error < least * (1.0 - LEAST_IMPROVEMENT) { 0 } else { stalled + 1 };
            least = least.min(error);
            let limiting_joint = self.find_step(&displacement);
            if error < self.closest.displacement.norm() {
                self.closest.q.copy_from(&self.q);
                self.closest.displacement = displacement;
                self.closest.limiting_joint = limiting_joint;
            }
            if self.accepts(&TaskError::of(&displacement)) || stalled >= STALLED_STEPS {
                return iteration + 1;
            }
            let length = self.step.norm();
            let scale = if length > self.options.longest_step { self.options.longest_step / length } else { 1.0 };
            for (index, joint) in self.workspace.model.joints.iter().enumerate() {
                self.q[index] = joint.limits.clamp(self.q[index] + scale * self.step[index]);
            }
        }
        self.options.steps
    }

    /// Writes the next step to `self.step`; returns the joint whose limit takes the most from it.
    fn find_step(&mut self, displacement: &Vector6<f64>) -> Option<usize> {
        self.workspace.jacobian_into(self.frame, &mut self.jacobian);
        keep_task_rows(&mut self.jacobian, self.rows);
        self.locked.fill(false);
        self.step.fill(0.0);
        let damping = LEAST_DAMPING.max(DAMPING_PER_SQUARED_ERROR * displacement.norm_squared());
        let mut limiting: Option<(usize, f64)> = None;
        // each pass locks at least one joint, so n + 1 passes are enough
        for _ in 0..=self.q.len() {
            let inverse = PseudoInverse::new(&self.jacobian, self.rows, &self.locked, damping)?;
            inverse.solve_into(&self.jacobian, &self.locked, displacement, &mut self.step);
            self.add_posture_pull(&inverse, displacement.norm());
            let mut found = false;
            for (index, joint) in self.workspace.model.joints.iter().enumerate() {
                let wish = self.step[index];
                let held = joint.limits.clamp(self.q[index] + wish.signum() * f64::EPSILON * 4.0) == self.q[index];
                if !self.locked[index] && wish != 0.0 && held {
                    self.locked[index] = true;
                    found = true;
                    if limiting.is_none_or(|(_, most)| wish.abs() > most) {
                        limiting = Some((index, wish.abs()));
                    }
                }
            }
            if !found {
                break;
            }
        }
        limiting.map(|(joint, _)| joint)
    }

    /// Adds (1 − J⁺ J) z, where z draws toward the preferred posture and fades with the error.
    fn add_posture_pull(&mut self, inverse: &PseudoInverse, error: f64) {
        let Some(posture) = &self.options.preferred_posture else { return };
        let gain = POSTURE_GAIN * (error / POSTURE_FADE_ERROR).min(1.0);
        for index in 0..self.q.len() {
            self.pull[index] = if self.locked[index] { 0.0 } else { gain * (posture[index] - self.q[index]) };
        }
        let mut task = Vector6::zeros();
        task.gemv(1.0, &self.jacobian, &self.pull, 0.0);
        inverse.solve_into(&self.jacobian, &self.locked, &task, &mut self.correction);
        self.step += &self.pull;
        self.step -= &self.correction;
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
