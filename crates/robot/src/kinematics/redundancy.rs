//! How an arm with more joints than the task has rows moves in the null space of the task.

use nalgebra::DVector;

use crate::error::RobotError;
use crate::manipulator::{Manipulator, check_finite, check_length};
use crate::workspace::Workspace;

/// Largest product of a rate and the time step; the explicit integration of the null-space motion is stable well beyond.
const LARGEST_RATE_STEP: f64 = 0.5;

/// A policy that resolves redundancy along a path, continuous up to the joint accelerations.
///
/// The null-space part of the joint acceleration is that of y = k² (q₀ − q) − 2 k q̇: a critically damped spring of rate k to
/// a preferred posture q₀. A joint that comes within a margin of a limit is driven back by a second spring. The frame's own
/// motion is not touched: q̈ = J⁺ (a − J̇ q̇) + (1 − J⁺ J) y.
///
/// Near a singular posture J⁺ is damped (Y. Nakamura and H. Hanafusa, "Inverse kinematic solutions with singularity
/// robustness for robot manipulator control", ASME J. Dynamic Systems, Measurement, and Control 108, 1986), so that the
/// joints stay slow and the frame lags behind; [`crate::FollowReport`] says how far, and following is refused beyond the
/// tolerances.
#[derive(Debug, Clone, PartialEq)]
pub struct Redundancy {
    /// Time from one followed sample to the next (s).
    pub time_step_s: f64,
    /// Posture that the null-space motion is drawn to (n entries; rad or m).
    pub preferred_posture: DVector<f64>,
    /// Rate k of the spring to the preferred posture (1/s).
    pub posture_rate_per_s: f64,
    /// Distance from a joint limit within which the joint is driven back (rad or m).
    pub limit_margin: f64,
    /// Rate of the spring that drives joints from their limits (1/s).
    pub limit_rate_per_s: f64,
    /// Pivot of the Jacobian (m/rad or one) below which the posture counts as nearly singular and is damped.
    pub damped_below: f64,
    /// Largest accepted lag of the frame in damped postures (m); elsewhere the pose is met to rounding.
    pub position_tolerance_m: f64,
    /// Largest accepted angular lag of the frame in damped postures (rad).
    pub angle_tolerance_rad: f64,
}

impl Redundancy {
    /// The policy with default gains: 2 1/s to the preferred posture (n entries; rad or m), 10 1/s within 0.2 rad (or m) of
    /// limits, damping below pivots of 0.01, lags of up to 0.1 mm and 1 mrad.
    pub fn toward(preferred_posture: DVector<f64>, time_step_s: f64) -> Self {
        Self {
            time_step_s,
            preferred_posture,
            posture_rate_per_s: 2.0,
            limit_margin: 0.2,
            limit_rate_per_s: 10.0,
            damped_below: 0.01,
            position_tolerance_m: 1e-4,
            angle_tolerance_rad: 1e-3,
        }
    }

    /// Checks the numbers for an arm.
    pub(crate) fn check(&self, manipulator: &Manipulator) -> Result<(), RobotError> {
        check_length("follow path: the preferred posture", self.preferred_posture.len(), manipulator.joint_count())?;
        check_finite("a coordinate of the preferred posture", self.preferred_posture.iter())?;
        let refuse = |quantity, found, expected| Err(RobotError::InvalidArgument { quantity, found, expected });
        let positive = [
            ("follow path: the time step (s)", self.time_step_s),
            ("follow path: the position tolerance (m)", self.position_tolerance_m),
            ("follow path: the angle tolerance (rad)", self.angle_tolerance_rad),
            ("follow path: the pivot below which postures are damped", self.damped_below),
        ];
        if let Some(&(quantity, found)) = positive.iter().find(|(_, found)| !(found.is_finite() && *found > 0.0)) {
            return refuse(quantity, found, "above zero, finite");
        }
        if !(self.limit_margin.is_finite() && self.limit_margin >= 0.0) {
            return refuse("follow path: the margin of joint limits (rad or m)", self.limit_margin, "zero or more");
        }
        let rates = [
            ("follow path: the posture rate times the time step", self.posture_rate_per_s),
            ("follow path: the limit rate times the time step", self.limit_rate_per_s),
        ];
        let product = |rate: f64| rate * self.time_step_s;
        match rates.into_iter().find(|(_, rate)| !(*rate >= 0.0 && product(*rate) <= LARGEST_RATE_STEP)) {
            Some((quantity, rate)) => refuse(quantity, product(rate), "zero to 0.5"),
            None => Ok(()),
        }
    }

    /// Writes the wanted acceleration y (n entries) of joints at `q` in the workspace's velocities.
    pub(crate) fn acceleration_into(&self, workspace: &Workspace, q: &DVector<f64>, out: &mut DVector<f64>) {
        let rate = self.posture_rate_per_s;
        for (index, joint) in workspace.model.joints.iter().enumerate() {
            let below = joint.limits.lower.map_or(0.0, |lower| (lower + self.limit_margin - q[index]).max(0.0));
            let above = joint.limits.upper.map_or(0.0, |upper| (q[index] - upper + self.limit_margin).max(0.0));
            // the damping of the limit's spring sets in with its depth, so that the acceleration has no jump
            let depth = if self.limit_margin > 0.0 { (below.max(above) / self.limit_margin).min(1.0) } else { 0.0 };
            let damping = 2.0 * (rate + self.limit_rate_per_s * depth);
            out[index] = rate * rate * (self.preferred_posture[index] - q[index])
                + self.limit_rate_per_s * self.limit_rate_per_s * (below - above)
                - damping * workspace.dq[index];
        }
    }

    /// Damping of J Jᵀ at its smallest squared pivot: none above the threshold, continuously more below.
    pub(crate) fn damping(&self, squared_pivot: f64) -> f64 {
        let threshold = self.damped_below * self.damped_below;
        threshold * (1.0 - squared_pivot / threshold).max(0.0)
    }
}
