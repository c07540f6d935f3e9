//! From the world's axes to the arm's: poses, twists, wrenches, and the joints that follow the tool's way.

use nalgebra::{DVector, Isometry3, UnitQuaternion, Vector6};
use robot::{
    DifferentialKinematics, FrameId, FrameMotion, JointReference, Manipulator, Redundancy, RobotError, TaskRows,
};

use super::reference::SpatialReference;

pub(super) fn in_base(model: &Manipulator, world_from_tool: &Isometry3<f64>) -> Isometry3<f64> {
    model.world_from_base().inv_mul(world_from_tool)
}

/// A twist or wrench turned from world axes into the base's.
pub(super) fn turned_into_base(model: &Manipulator, vector: &Vector6<f64>) -> Vector6<f64> {
    turned(&model.world_from_base().rotation.inverse(), vector)
}

/// A twist or wrench turned from the base's axes into the world's.
pub(super) fn turned_into_world(model: &Manipulator, vector: &Vector6<f64>) -> Vector6<f64> {
    turned(&model.world_from_base().rotation, vector)
}

fn turned(turn: &UnitQuaternion<f64>, vector: &Vector6<f64>) -> Vector6<f64> {
    let (first, second) = (turn * vector.fixed_rows::<3>(0), turn * vector.fixed_rows::<3>(3));
    Vector6::new(first.x, first.y, first.z, second.x, second.y, second.z)
}

pub(super) fn frame_motion(model: &Manipulator, reference: &SpatialReference) -> FrameMotion {
    FrameMotion {
        base_from_frame: in_base(model, &reference.world_from_tool),
        velocity: turned_into_base(model, &reference.velocity),
        acceleration: turned_into_base(model, &reference.acceleration),
    }
}

/// Leads the tool's frame `frame` of `model` from posture `q` (rad or m) on, one reference every `period_s`; what the arm has to
/// spare is drawn to that posture and away from limits, so that the same way of the tool always comes back to the same
/// posture.
///
/// # Errors
/// [`RobotError::TooFewJoints`] if the arm has fewer than six joints.
pub(super) fn follower(
    model: &Manipulator,
    frame: FrameId,
    q: &DVector<f64>,
    period_s: f64,
) -> Result<DifferentialKinematics, RobotError> {
    if model.joint_count() > TaskRows::Pose.indices().len() {
        let redundancy = Redundancy::toward(q.clone(), period_s);
        DifferentialKinematics::with_redundancy(model, frame, TaskRows::Pose, redundancy)
    } else {
        DifferentialKinematics::new(model, frame, TaskRows::Pose)
    }
}

/// Leads the tool on by one period, and the joints that mimic others along with their leaders. Allocates nothing unless it
/// fails.
///
/// # Errors
/// Those of [`DifferentialKinematics::follow`].
pub(super) fn follow(
    follower: &mut DifferentialKinematics,
    model: &Manipulator,
    wanted: &FrameMotion,
    reference: &mut JointReference,
) -> Result<(), RobotError> {
    follower.follow(wanted, reference)?;
    model.complete_positions(&mut reference.q)?;
    model.complete_velocities(&mut reference.dq)?;
    // accelerations obey the law of velocities
    model.complete_velocities(&mut reference.ddq)
}
