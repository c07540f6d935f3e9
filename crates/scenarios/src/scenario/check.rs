//! Checks of a scenario against its arm: lists of numbers, names of frames.

use robot::{Manipulator, RobotError};
use skills::field::FieldError;

use super::ArmKeys;
use super::document::path;
use super::explain::{Context, bad_value, key_name};
use super::named::field_problem;
use crate::diagnostic::Diagnostic;
use crate::suggest::{did_you_mean, listed};
use crate::tasks::spatial::SpatialRobotConfig;

/// Checks lists and names against the arm.
pub(crate) fn check_arm(context: Context<'_>, keys: &ArmKeys<'_>, arm: &Manipulator) -> Vec<Diagnostic> {
    let spatial = keys.spatial.and_then(|robot| spatial_robot(context, robot, arm));
    [gains(context, keys, arm), rotor_inertia(context, keys, arm), tool_frame(context, keys, arm), spatial]
        .into_iter()
        .flatten()
        .collect()
}

fn gains(context: Context<'_>, keys: &ArmKeys<'_>, arm: &Manipulator) -> Option<Diagnostic> {
    let error = keys.controller.validate(arm.joint_count()).err()?;
    Some(refused(context, error.within("controller"), arm))
}

/// Lists of the arm's posture and of its motors, for an arm that moves in space.
fn spatial_robot(context: Context<'_>, robot: &SpatialRobotConfig, arm: &Manipulator) -> Option<Diagnostic> {
    Some(refused(context, robot.validate_for(arm).err()?.within("robot"), arm))
}

/// A refused value at its place; one that counts joints is told their names.
fn refused(context: Context<'_>, error: FieldError, arm: &Manipulator) -> Diagnostic {
    let about_joints =
        error.expected.contains("joint").then(|| format!("the joints of the arm are {}", joint_names(arm)));
    field_problem(context, error).help(about_joints)
}

fn rotor_inertia(context: Context<'_>, keys: &ArmKeys<'_>, arm: &Manipulator) -> Option<Diagnostic> {
    let (found, joints) = (keys.rotor_inertia_kg_m2.len(), arm.joint_count());
    if found == 0 || found == joints {
        return None;
    }
    let key = path("robot.rotor_inertia_kg_m2");
    let problem = context
        .problem_at_value(&key, bad_value(&key))
        .found(format!("{found} numbers"))
        .expected(format!("{joints} numbers, one for each joint of the arm, or none"))
        .help([format!("the joints of the arm are {}", joint_names(arm))]);
    Some(problem)
}

fn tool_frame(context: Context<'_>, keys: &ArmKeys<'_>, arm: &Manipulator) -> Option<Diagnostic> {
    let wanted = keys.tool_frame;
    let Err(RobotError::UnknownFrame { known, .. }) = arm.frame(wanted) else { return None };
    let key = path("robot.tool_frame");
    let problem = context
        .problem_at_value(&key, format!("unknown frame in {}", key_name(&key)))
        .found(format!("{wanted:?}"))
        .expected(format!("one of {}", listed(&known)))
        .help(did_you_mean(wanted, &known));
    Some(problem)
}

fn joint_names(arm: &Manipulator) -> String {
    listed(&arm.joints().iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>())
}
