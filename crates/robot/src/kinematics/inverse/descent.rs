//! The steps of inverse kinematics: the descent to a target, the glide along the null space at it, and the refinement of the
//! closest posture to a target that cannot be met.

use nalgebra::{DVector, Isometry3, Vector6};

use crate::kinematics::inverse::InverseKinematics;
use crate::kinematics::pseudo_inverse::{PseudoInverse, keep_task_rows};

/// Damping for each squared unit of the error.
const DAMPING_PER_SQUARED_ERROR: f64 = 0.02;
/// Damping that remains near the target; small against squared singular values of a well-posed arm (about 1e-3).
const LEAST_DAMPING: f64 = 1e-8;
/// Pull to the preferred posture on the way to the target, as a part of the way for each step.
const APPROACH_PULL: f64 = 0.1;
/// Error below which the pull on the way fades in proportion.
const PULL_FADE_ERROR: f64 = 0.1;
/// First pull to the preferred posture at the target.
const GLIDE_PULL: f64 = 0.5;
/// Largest pull at the target; above one where the null space bends toward the preferred posture.
const LARGEST_GLIDE_PULL: f64 = 3.0;
/// Steps allowed for the glide, which takes about twenty.
const GLIDE_STEPS: usize = 100;
/// Distance to the preferred posture along the null space (rad or m) at which the glide has arrived.
const GLIDE_ARRIVED: f64 = 1e-4;
/// Steps allowed to meet the target again after the glide, which takes two or three.
const RETURN_STEPS: usize = 10;
/// Steps allowed to refine the closest posture to a target that was not met.
const REFINING_STEPS: usize = 200;
/// Step of that refinement (rad or m) below which the posture is the closest.
const REFINED: f64 = 1e-10;
/// Steps without a better error after which an attempt is given up.
const STALLED_STEPS: usize = 12;
/// A step counts as better only if it lowers the error by this part.
const LEAST_IMPROVEMENT: f64 = 1e-6;
impl InverseKinematics {
    /// Descends from `self.q` until the target is met or the error stalls; returns the steps taken.
    pub(super) fn attempt(&mut self, target: &Isometry3<f64>) -> usize {
        let mut least = f64::INFINITY;
        let mut stalled = 0;
        for iteration in 0..self.options.steps {
            let displacement = self.look(target);
            let error = displacement.norm();
            stalled = if error < least * (1.0 - LEAST_IMPROVEMENT) { 0 } else { stalled + 1 };
            least = least.min(error);
            if error < self.closest.displacement.norm() {
                self.closest.q.copy_from(&self.q);
                self.closest.displacement = displacement;
            }
            if self.accepts(&displacement) || stalled >= STALLED_STEPS {
                return iteration + 1;
            }
            self.find_step(
                &displacement,
                damping_at(&displacement),
                APPROACH_PULL * (error / PULL_FADE_ERROR).min(1.0),
            );
            self.take_step();
        }
        self.options.steps
    }

    /// From a posture that meets the target, glides along the null space to the one nearest to the preferred posture.
    /// Keeps the former one if the target is lost or nothing is gained. Returns the steps taken.
    pub(super) fn glide(&mut self, target: &Isometry3<f64>) -> usize {
        if self.options.preferred_posture.is_none() || self.rows.indices().len() >= self.q.len() {
            return 0;
        }
        self.q.copy_from(&self.closest.q);
        self.former_pull.fill(0.0);
        let mut gain = GLIDE_PULL;
        let mut former_error = f64::INFINITY;
        let mut iterations = 0;
        for _ in 0..GLIDE_STEPS {
            let displacement = self.look(target);
            self.find_step(&displacement, damping_at(&displacement), gain);
            iterations += 1;
            // the target counts here already, as joints held at limits by the pull would come off them on the way back;
            // unless it cannot be met, near singular postures
            let settled = self.accepts(&displacement) || displacement.norm() > 0.9 * former_error;
            if settled && self.pull.norm() < GLIDE_ARRIVED * gain {
                break;
            }
            former_error = displacement.norm();
            if self.pull.dot(&self.former_pull) < 0.0 {
                // gone too far: the null space bends more than the distance does
                gain *= 0.5;
                self.step.axpy(-0.5, &self.pull, 1.0);
            } else {
                gain = (1.2 * gain).min(LARGEST_GLIDE_PULL);
            }
            self.former_pull.copy_from(&self.pull);
            self.take_step();
        }
        for _ in 0..RETURN_STEPS {
            let displacement = self.look(target);
            iterations += 1;
            if self.accepts(&displacement) {
                if self.distance_to_preferred(&self.q) < self.distance_to_preferred(&self.closest.q) {
                    self.closest.q.copy_from(&self.q);
                    self.closest.displacement = displacement;
                }
                break;
            }
            self.find_step(&displacement, damping_at(&displacement), 0.0);
            self.take_step();
        }
        iterations
    }

    /// Brings the closest posture to the least distance from a target that it does not meet, where plain damped least squares
    /// overshoot: the damping grows until a step helps (Levenberg and Marquardt). Returns the steps taken.
    pub(super) fn refine(&mut self, target: &Isometry3<f64>) -> usize {
        let mut damping = self.closest.displacement.norm().max(LEAST_DAMPING);
        for iteration in 0..REFINING_STEPS {
            self.q.copy_from(&self.closest.q);
            let displacement = self.look(target);
            if self.accepts(&displacement) {
                return iteration;
            }
            self.find_step(&displacement, damping, 0.0);
            self.take_step();
            let moved = self.q.metric_distance(&self.closest.q);
            self.workspace.place(&self.q);
            let reached = self.rows.displacement(&self.workspace.base_from_frame(self.frame), target);
            if reached.norm() < displacement.norm() {
                self.closest.q.copy_from(&self.q);
                self.closest.displacement = reached;
                damping = (0.3 * damping).max(LEAST_DAMPING);
            } else {
                damping *= 4.0;
            }
            if moved < REFINED {
                return iteration + 1;
            }
        }
        REFINING_STEPS
    }

    fn distance_to_preferred(&self, q: &DVector<f64>) -> f64 {
        self.options.preferred_posture.as_ref().map_or(0.0, |posture| posture.metric_distance(q))
    }

    /// Places the arm at `self.q` and evaluates the Jacobian; returns what is left to the target.
    pub(super) fn look(&mut self, target: &Isometry3<f64>) -> Vector6<f64> {
        self.workspace.place(&self.q);
        self.workspace.jacobian_into(self.frame, &mut self.jacobian);
        keep_task_rows(&mut self.jacobian, self.rows);
        self.rows.displacement(&self.workspace.base_from_frame(self.frame), target)
    }

    /// Writes the next step to `self.step`, and to `self.pull` the part of it that draws to the preferred posture.
    fn find_step(&mut self, displacement: &Vector6<f64>, damping: f64, gain: f64) {
        self.locked.fill(false);
        self.step.fill(0.0);
        // each pass locks at least one joint, so n + 1 passes are enough
        for _ in 0..=self.q.len() {
            let Some(inverse) = PseudoInverse::new(&self.jacobian, self.rows, &self.locked, damping) else { break };
            inverse.solve_into(&self.jacobian, &self.locked, displacement, &mut self.step);
            self.add_pull(&inverse, gain);
            let mut found = false;
            for (index, joint) in self.workspace.model.joints.iter().enumerate() {
                let wish = self.step[index];
                let held = joint.limits.clamp(self.q[index] + wish.signum() * f64::EPSILON * 4.0) == self.q[index];
                if !self.locked[index] && wish != 0.0 && held {
                    self.locked[index] = true;
                    found = true;
                }
            }
            if !found {
                break;
            }
        }
    }

    /// Moves `self.q` by the step, clamped in length and to the limits.
    fn take_step(&mut self) {
        let length = self.step.norm();
        let scale = if length > self.options.longest_step { self.options.longest_step / length } else { 1.0 };
        for (index, joint) in self.workspace.model.joints.iter().enumerate() {
            self.q[index] = joint.limits.clamp(self.q[index] + scale * self.step[index]);
        }
    }

    /// Adds (1 − J⁺ J) z to the step, where z draws toward the preferred posture by a part `gain` of the way.
    fn add_pull(&mut self, inverse: &PseudoInverse, gain: f64) {
        let Some(posture) = &self.options.preferred_posture else { return };
        if gain == 0.0 {
            return;
        }
        for index in 0..self.q.len() {
            self.pull[index] = if self.locked[index] { 0.0 } else { gain * (posture[index] - self.q[index]) };
        }
        inverse.keep_null_part(&self.jacobian, &self.locked, &mut self.pull, &mut self.correction);
        self.step += &self.pull;
    }
}

/// Damping for a step that leaves `displacement` to go.
fn damping_at(displacement: &Vector6<f64>) -> f64 {
    LEAST_DAMPING.max(DAMPING_PER_SQUARED_ERROR * displacement.norm_squared())
}
