//! Whether the arm can carry out a plan at all, found out before anything moves.

use nalgebra::{DVector, Isometry3};
use robot::{InverseKinematics, InverseKinematicsOptions, JointReference, Manipulator, RobotError, TaskRows};
use skills::field::FieldError;

use super::frames::{follow, follower, frame_motion, in_base};
use super::reference::ReferenceSource;
use super::tool::TOOL_FRAME;
use crate::error::SimError;

/// Time between two looks at a plan's reach, s: that between two references of a usual run, which then are the same.
const REACH_CHECK_S: f64 = 0.001;
/// Longest plan that is looked at, s.
const LONGEST_PLAN_S: f64 = 3600.0;

/// Checks that the arm reaches every tool pose of a plan of `duration_s` without passing a limit of a joint or of its speed,
/// from a posture near `near` (the bare posture of a robot, say); returns its posture at the start. The plan is looked at
/// every millisecond.
///
/// # Errors
/// [`SimError::Unreachable`] with the time, the pose and the joint at fault; [`SimError::Field`] for a duration or a posture
/// that cannot be used; [`SimError::Robot`] if the model has no tool.
pub fn check_reach(
    model: &Manipulator,
    near: &DVector<f64>,
    duration_s: f64,
    source: &mut dyn ReferenceSource,
) -> Result<DVector<f64>, SimError> {
    check_reach_along(model, near, duration_s, source, &mut |_, _| Ok(()))
}

/// Takes the time, s, and the posture of a look at a plan.
pub type EachLook<'a> = &'a mut dyn FnMut(f64, &DVector<f64>) -> Result<(), SimError>;

/// As [`check_reach`], and shows each look's time, s, and posture to `each`, whose error ends the check.
///
/// # Errors
/// As [`check_reach`], and those of `each`.
pub fn check_reach_along(
    model: &Manipulator,
    near: &DVector<f64>,
    duration_s: f64,
    source: &mut dyn ReferenceSource,
    each: EachLook<'_>,
) -> Result<DVector<f64>, SimError> {
    skills::field::within("duration_s", duration_s, 0.0, LONGEST_PLAN_S)?;
    check_posture("near", model, near)?;
    let frame = model.frame(TOOL_FRAME)?;
    let unreachable = |error: RobotError, time_s: f64| SimError::Unreachable { reason: error.to_string(), time_s };
    let first = source.next(0.0, &Isometry3::identity());
    if !in_base(model, &first.world_from_tool).to_homogeneous().iter().all(|value| value.is_finite()) {
        let reason = "reach pose: the plan's first pose has a coordinate that is not finite".into();
        return Err(SimError::Unreachable { reason, time_s: 0.0 });
    }
    let options =
        InverseKinematicsOptions { preferred_posture: Some(near.clone()), ..InverseKinematicsOptions::default() };
    let mut solver = InverseKinematics::new(model, frame, TaskRows::Pose, options)?;
    let found = solver.solve(&in_base(model, &first.world_from_tool), near);
    let mut start = found.map_err(|error| unreachable(error, 0.0))?.q;
    model.complete_positions(&mut start)?;
    let mut follower = follower(model, frame, &start, REACH_CHECK_S)?;
    let mut reference = JointReference::at_rest(start.clone());
    let looks = (duration_s / REACH_CHECK_S).ceil() as usize;
    let mut world_from_tool = first.world_from_tool;
    for look in 0..=looks {
        let time_s = (look as f64 * REACH_CHECK_S).min(duration_s);
        // the tool is taken to be where the plan wanted it last
        let wanted = source.next(time_s, &world_from_tool);
        world_from_tool = wanted.world_from_tool;
        let motion = frame_motion(model, &wanted);
        follow(&mut follower, model, &motion, &mut reference).map_err(|error| unreachable(error, time_s))?;
        check_speeds(model, &reference, time_s)?;
        each(time_s, &reference.q)?;
    }
    Ok(start)
}

/// How far a pose is out of an arm's reach.
#[derive(Clone, Debug, PartialEq)]
pub struct OutOfReach {
    /// Distance of the tool's origin from where it should be, in the closest posture found, m.
    pub distance_m: f64,
    /// Angle left there, rad.
    pub angle_rad: f64,
    /// What holds the arm back, in words.
    pub reason: String,
}

/// Looks for a posture that brings the tool to `world_from_tool`, from `near` and from others; returns how much is missing of it, or
/// `None` if the arm gets there.
///
/// # Errors
/// [`SimError::Field`] for a posture that cannot be used; [`SimError::Robot`] if the model has no tool or the pose is not finite.
pub fn out_of_reach(
    model: &Manipulator,
    near: &DVector<f64>,
    world_from_tool: &Isometry3<f64>,
) -> Result<Option<OutOfReach>, SimError> {
    check_posture("near", model, near)?;
    let frame = model.frame(TOOL_FRAME)?;
    let options = InverseKinematicsOptions::default();
    let mut solver = InverseKinematics::new(model, frame, TaskRows::Pose, options)?;
    match solver.solve(&in_base(model, world_from_tool), near) {
        Ok(_) => Ok(None),
        Err(RobotError::Unreachable { position_error_m, angle_error_rad, reason, .. }) => Ok(Some(OutOfReach {
            distance_m: position_error_m,
            angle_rad: angle_error_rad,
            reason: reason.to_string(),
        })),
        Err(error) => Err(error.into()),
    }
}

/// Checks that a posture has a finite coordinate for each joint.
pub(super) fn check_posture(field: &str, model: &Manipulator, q: &DVector<f64>) -> Result<(), FieldError> {
    if q.len() != model.joint_count() {
        let expected = format!("{}: one for each joint of the arm", model.joint_count());
        return Err(FieldError::new(field, format!("a posture of {} numbers", q.len()), expected));
    }
    skills::field::finite(field, q.as_slice())
}

/// Checks that no joint must move faster than its limit.
fn check_speeds(model: &Manipulator, reference: &JointReference, time_s: f64) -> Result<(), SimError> {
    for (joint, speed) in model.joints().iter().zip(reference.dq.iter()) {
        if let Some(limit) = joint.limits.velocity.filter(|limit| speed.abs() > *limit) {
            let unit = if joint.kind.rotates() { "rad/s" } else { "m/s" };
            let reason = format!(
                "follow plan: joint `{}` would have to move at {:.2} {unit}; expected at most {limit} {unit}; slow the task down",
                joint.name,
                speed.abs()
            );
            return Err(SimError::Unreachable { reason, time_s });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{HeldTool, arm_with_tool, standard_gravity};

    /// A Panda whose finger slides by a tenth of the turn of the last joint.
    fn panda_with_a_follower() -> Manipulator {
        const FINGER: &str = r#"<link name="f"><inertial><mass value="0.01"/>
            <inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial></link>
            <joint name="jf" type="prismatic"><parent link="panda_link7"/><child link="f"/><axis xyz="1 0 0"/>
            <limit lower="-1" upper="1" effort="10" velocity="1"/><mimic joint="panda_joint7" multiplier="0.1"/></joint></robot>"#;
        let text = include_str!("../../../../assets/robots/panda.urdf").replace("</robot>", FINGER);
        let arm = Manipulator::from_urdf_str(&text).expect("valid");
        let (base, gravity) = (Isometry3::identity(), standard_gravity());
        arm_with_tool(&arm, "panda_hand_tcp", &HeldTool::none(), &base, &gravity, &[]).expect("an arm")
    }

    #[test]
    fn a_pose_out_of_reach_is_told_with_what_is_missing() {
        let model = panda_with_a_follower();
        let near = DVector::from_column_slice(&[0.0, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8, 0.08]);
        let down = nalgebra::UnitQuaternion::from_axis_angle(&nalgebra::Vector3::x_axis(), std::f64::consts::PI);
        let at = |x: f64| Isometry3::from_parts(nalgebra::Translation3::new(x, 0.0, 0.3), down);
        assert_eq!(out_of_reach(&model, &near, &at(0.5)).expect("usable"), None);
        // a meter farther out, a meter more is missing
        let [far, farther] = [2.0, 3.0].map(|x| out_of_reach(&model, &near, &at(x)).expect("usable").expect("too far"));
        assert!((farther.distance_m - far.distance_m - 1.0).abs() < 0.03, "{far:?} {farther:?}");
        assert!((0.9..1.3).contains(&far.distance_m), "{far:?}");
        assert!(far.reason.contains("panda_joint1"), "{far:?}");
    }

    #[test]
    fn a_joint_that_mimics_another_is_led_along_with_it() {
        const ROUNDING: f64 = 1e-12;
        let model = panda_with_a_follower();
        let near = DVector::from_column_slice(&[0.0, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8, 0.5]);
        let mut largest = (0.0_f64, 0.0_f64);
        let mut workspace = model.workspace();
        workspace.set_positions(&near).expect("fits");
        let start = workspace.base_from_frame(model.frame(TOOL_FRAME).expect("known"));
        let mut turning = |time_s: f64, _: &Isometry3<f64>| {
            let turn = nalgebra::UnitQuaternion::from_axis_angle(&nalgebra::Vector3::z_axis(), 0.4 * time_s);
            let mut reference = crate::spatial::SpatialReference::at_rest(Isometry3::from_parts(
                start.translation,
                turn * start.rotation,
            ));
            reference.velocity[5] = 0.4;
            reference
        };
        let posture = check_reach_along(&model, &near, 0.5, &mut turning, &mut |_, q| {
            largest = (largest.0.max((q[7] - 0.1 * q[6]).abs()), largest.1.max((q[6] - near[6]).abs()));
            Ok(())
        })
        .expect("within reach");
        assert!((posture[7] - 0.1 * posture[6]).abs() < ROUNDING);
        assert!(largest.0 < ROUNDING, "{largest:?}");
        assert!(largest.1 > 0.05, "the leader must turn for the test to tell: {largest:?}");
    }
}
