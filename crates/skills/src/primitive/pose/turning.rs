//! What orientation is tied to: the turn from start to goal the way round that was shown, and the residual about it.

use std::f64::consts::TAU;

use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::rotation::nearest_branch;
use super::trajectory::PoseTrajectory;
use crate::time_law::{minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative};

/// Way round that demonstrations show, in the frame of the poses.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShownTurn {
    /// Whole turns: 2π times their number along their axis, rad.
    pub whole_rad: Vector3<f64>,
    /// What the demonstrations turned besides, rad: at most half a turn.
    pub rest_rad: Vector3<f64>,
}

impl ShownTurn {
    /// Divides the mean turn of demonstrations into whole turns and the rest.
    pub(super) fn of(demonstrations: &[PoseTrajectory]) -> Self {
        let sum: Vector3<f64> = demonstrations.iter().map(PoseTrajectory::turn_rad).sum();
        let turn = sum / demonstrations.len().max(1) as f64;
        let turns = (turn.norm() / TAU).round();
        let whole_rad = if turns > 0.0 { turn.normalize() * (TAU * turns) } else { Vector3::zeros() };
        Self { whole_rad, rest_rad: turn - whole_rad }
    }

    /// Plans the turn from one orientation to another.
    pub(super) fn turning(&self, start: UnitQuaternion<f64>, goal: UnitQuaternion<f64>) -> Turning {
        let rest = nearest_branch(&(goal * start.inverse()), &self.rest_rad);
        Turning { start, whole: self.whole_rad, rest }
    }
}

/// Turn q_b = e^{mj·v}·e^{mj·w}·q0 from rest at q0 to rest at the goal: w whole turns, v what leads to the goal besides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turning {
    start: UnitQuaternion<f64>,
    whole: Vector3<f64>,
    rest: Vector3<f64>,
}

impl Turning {
    pub(super) fn rotation(&self, progress: f64) -> UnitQuaternion<f64> {
        let along = minimum_jerk(progress);
        UnitQuaternion::from_scaled_axis(self.rest * along)
            * UnitQuaternion::from_scaled_axis(self.whole * along)
            * self.start
    }

    /// Angular velocity and acceleration by progress, in the frame of the poses.
    pub(super) fn angular_motion(&self, progress: f64) -> (Vector3<f64>, Vector3<f64>) {
        let (first, second) = (minimum_jerk_first_derivative(progress), minimum_jerk_second_derivative(progress));
        let turned = UnitQuaternion::from_scaled_axis(self.rest * minimum_jerk(progress)) * self.whole;
        let both = self.rest + turned;
        (both * first, both * second + self.rest.cross(&turned) * (first * first))
    }

    /// Residual rotation vectors ρ of a demonstration, q = e^ρ·q_b, continuous from the first sample on.
    pub(super) fn residuals(&self, shown: &PoseTrajectory) -> Vec<Vector3<f64>> {
        let (from_s, duration_s) = (shown.times_s()[0], shown.duration_s());
        let mut last = Vector3::zeros();
        let mut residuals = Vec::with_capacity(shown.poses().len());
        for (time_s, pose) in shown.times_s().iter().zip(shown.poses()) {
            let beside = pose.rotation * self.rotation((time_s - from_s) / duration_s).inverse();
            last = nearest_branch(&beside, &last);
            residuals.push(last);
        }
        residuals
    }
}
