//! The motion of the study.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use nalgebra::{DVector, Isometry3, Point3, Translation3, UnitQuaternion, Vector3, Vector6};
use robot::Manipulator;

use crate::error::SimError;
use crate::spatial::reach::check_reach;
use crate::spatial::reference::{ReferenceSource, SpatialReference};

/// Time of the motion proper, s.
const MOVING_S: f64 = 3.0;
/// Time of motion and hold, s.
pub(super) const DURATION_S: f64 = 4.0;
/// Where the hand starts, in the base's axes, m.
const START_M: [f64; 3] = [0.56, 0.0, 0.47];
/// How far it moves, m.
const WAY_M: [f64; 3] = [0.0, 0.30, 0.10];
/// How far the approach axis points below the horizontal, degrees.
const BELOW_HORIZONTAL_DEG: f64 = 25.0;
/// How far the hand turns about it, degrees.
const TURN_DEG: f64 = 110.0;
/// Franka's ready posture, rad.
const READY_RAD: [f64; 7] = [0.0, -FRAC_PI_4, 0.0, -3.0 * FRAC_PI_4, 0.0, FRAC_PI_2, FRAC_PI_4];

/// A sideways lift with a turn about the approach axis, for an arm whose base stands at the world's origin.
#[derive(Clone, Copy, Debug, Default)]
pub struct StudyMotion;

impl ReferenceSource for StudyMotion {
    fn next(&mut self, time_s: f64, _: &Isometry3<f64>) -> SpatialReference {
        let (share, rate, change) = minimum_jerk(time_s / MOVING_S);
        let (rate, change) = (rate / MOVING_S, change / (MOVING_S * MOVING_S));
        let way = Vector3::from(WAY_M);
        let start = start_rotation();
        let turn = TURN_DEG.to_radians();
        let axis = start * Vector3::z() * turn;
        let rotation = start * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn * share);
        let twist = |factor: f64| {
            let (linear, angular) = (way * factor, axis * factor);
            Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
        };
        let position = Point3::from(START_M) + way * share;
        SpatialReference {
            velocity: twist(rate),
            acceleration: twist(change),
            finished: time_s >= DURATION_S,
            ..SpatialReference::at_rest(Isometry3::from_parts(Translation3::from(position), rotation))
        }
    }
}

/// The hand upright, its approach axis forward and a little down.
fn start_rotation() -> UnitQuaternion<f64> {
    // from the hand pointing straight down, as in the ready posture
    let down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    let tilt = (BELOW_HORIZONTAL_DEG - 90.0).to_radians();
    UnitQuaternion::from_axis_angle(&Vector3::y_axis(), tilt) * down
}

/// Minimum jerk from 0 to 1 with its derivatives, at a share of its time.
fn minimum_jerk(share: f64) -> (f64, f64, f64) {
    let s = share.clamp(0.0, 1.0);
    let value = s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s);
    let rate = 30.0 * s * s * (1.0 - s) * (1.0 - s);
    (value, rate, 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s))
}

/// Posture of `model`, a Panda with a tool frame, at the start of the motion; checks that it can carry out all of it.
///
/// # Errors
/// [`SimError::Unreachable`] for an arm that cannot, [`SimError::Field`] for one that has not seven joints.
pub fn start_of_study(model: &Manipulator) -> Result<DVector<f64>, SimError> {
    check_reach(model, &DVector::from_column_slice(&READY_RAD), DURATION_S, &mut StudyMotion)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocity_and_acceleration_are_the_derivatives_of_the_pose() {
        const STEP_S: f64 = 1e-5;
        let at = |time_s: f64| StudyMotion.next(time_s, &Isometry3::identity());
        for time_s in [0.4, 1.5, 2.7, 3.5] {
            let (before, now, after) = (at(time_s - STEP_S), at(time_s), at(time_s + STEP_S));
            let moved =
                (after.world_from_tool.translation.vector - before.world_from_tool.translation.vector) / (2.0 * STEP_S);
            let turned = (after.world_from_tool.rotation * before.world_from_tool.rotation.inverse()).scaled_axis()
                / (2.0 * STEP_S);
            assert!((moved - now.velocity.fixed_rows::<3>(0)).norm() < 1e-8);
            assert!((turned - now.velocity.fixed_rows::<3>(3)).norm() < 1e-8);
            let sped = (after.velocity - before.velocity) / (2.0 * STEP_S);
            assert!((sped - now.acceleration).norm() < 1e-8);
        }
    }

    #[test]
    fn the_hand_points_forward_and_25_degrees_down() {
        let approach = start_rotation() * Vector3::z();
        assert!((approach.z + 25.0_f64.to_radians().sin()).abs() < 1e-12);
        assert!(approach.x > 0.9 && approach.y.abs() < 1e-12);
    }
}
