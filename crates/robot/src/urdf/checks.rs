//! Checks of single links and joints: names, numbers, types.

use std::collections::{HashMap, HashSet};

use urdf_rs::{Geometry, Joint, JointType, Link, Pose, Robot};

use crate::error::RobotError;

/// Axes shorter than this count as zero; written axes are unit vectors or small integers.
const SHORTEST_AXIS: f64 = 1e-9;

/// Checks names, inertials and shapes of all links.
pub(crate) fn check_links(robot: &Robot) -> Result<(), RobotError> {
    let mut seen = HashSet::new();
    for link in &robot.links {
        if !seen.insert(link.name.as_str()) {
            return Err(RobotError::DuplicateLink { link: link.name.clone() });
        }
        check_inertial(link)?;
        check_shapes(link)?;
    }
    Ok(())
}

fn check_inertial(link: &Link) -> Result<(), RobotError> {
    let element = || format!("link `{}`", link.name);
    let mass_kg = link.inertial.mass.value;
    let inertia = &link.inertial.inertia;
    let tensor = [inertia.ixx, inertia.ixy, inertia.ixz, inertia.iyy, inertia.iyz, inertia.izz];
    check_finite(&element, "mass", &[mass_kg])?;
    check_finite(&element, "inertia", &tensor)?;
    check_pose(&element, "inertial origin", &link.inertial.origin)?;
    if mass_kg < 0.0 { Err(RobotError::NegativeMass { element: element(), mass_kg }) } else { Ok(()) }
}

fn check_shapes(link: &Link) -> Result<(), RobotError> {
    let element = || format!("link `{}`", link.name);
    let visuals = link.visual.iter().map(|visual| (&visual.origin, &visual.geometry));
    let collisions = link.collision.iter().map(|collision| (&collision.origin, &collision.geometry));
    for (origin, geometry) in visuals.chain(collisions) {
        check_pose(&element, "shape origin", origin)?;
        let sizes: &[f64] = match geometry {
            Geometry::Box { size } => &size.0,
            Geometry::Cylinder { radius, length } | Geometry::Capsule { radius, length } => &[*radius, *length],
            Geometry::Sphere { radius } => &[*radius],
            Geometry::Mesh { scale, .. } => {
                check_finite(&element, "mesh scale", scale.as_ref().map_or(&[], |scale| &scale.0))?;
                continue;
            }
        };
        check_finite(&element, "shape size", sizes)?;
        check_not_negative(&element, "shape size", sizes)?;
    }
    Ok(())
}

/// Checks names, types, axes, limits and mimics of all joints.
pub(crate) fn check_joints(robot: &Robot) -> Result<(), RobotError> {
    let mut types = HashMap::new();
    for joint in &robot.joints {
        if types.insert(joint.name.as_str(), &joint.joint_type).is_some() {
            return Err(RobotError::DuplicateJoint { joint: joint.name.clone() });
        }
    }
    for joint in &robot.joints {
        let element = || format!("joint `{}`", joint.name);
        check_pose(&element, "origin", &joint.origin)?;
        check_type(joint)?;
        check_mimic(joint, &types)?;
        if joint.joint_type != JointType::Fixed {
            check_axis(joint)?;
            check_limits(joint)?;
        }
    }
    Ok(())
}

fn check_type(joint: &Joint) -> Result<(), RobotError> {
    let kind = match joint.joint_type {
        JointType::Fixed | JointType::Revolute | JointType::Continuous | JointType::Prismatic => return Ok(()),
        JointType::Floating => "floating",
        JointType::Planar => "planar",
        JointType::Spherical => "spherical",
    };
    Err(RobotError::UnsupportedJoint { joint: joint.name.clone(), kind })
}

fn check_mimic(joint: &Joint, types: &HashMap<&str, &JointType>) -> Result<(), RobotError> {
    let Some(mimic) = &joint.mimic else { return Ok(()) };
    let (name, target) = (joint.name.clone(), mimic.joint.clone());
    let Some(target_type) = types.get(target.as_str()) else {
        return Err(RobotError::MimicTargetMissing { joint: name, target });
    };
    // a fixed joint has nothing to couple, so its mimic says nothing
    if joint.joint_type == JointType::Fixed {
        return Ok(());
    }
    let numbers = [mimic.multiplier.unwrap_or(1.0), mimic.offset.unwrap_or(0.0)];
    check_finite(&|| format!("joint `{}`", joint.name), "mimic", &numbers)?;
    match target_type {
        JointType::Fixed => Err(RobotError::MimicTargetFixed { joint: name, target }),
        _ => Ok(()),
    }
}

fn check_axis(joint: &Joint) -> Result<(), RobotError> {
    let element = || format!("joint `{}`", joint.name);
    check_finite(&element, "axis", &joint.axis.xyz.0)?;
    let length_squared: f64 = joint.axis.xyz.iter().map(|value| value * value).sum();
    check_finite(&element, "axis", &[length_squared])?;
    if length_squared.sqrt() < SHORTEST_AXIS {
        return Err(RobotError::ZeroAxis { joint: joint.name.clone() });
    }
    Ok(())
}

fn check_limits(joint: &Joint) -> Result<(), RobotError> {
    let element = || format!("joint `{}`", joint.name);
    let limit = &joint.limit;
    // infinite limits are how the parser says that none is stated
    let values = [limit.lower, limit.upper, limit.velocity, limit.effort];
    if values.iter().any(|value| value.is_nan()) {
        return Err(RobotError::NonFinite { element: element(), quantity: "limit" });
    }
    if limit.lower > limit.upper {
        let (lower, upper) = (limit.lower, limit.upper);
        return Err(RobotError::LimitsReversed { joint: joint.name.clone(), lower, upper });
    }
    check_not_negative(&element, "velocity limit", &[limit.velocity])?;
    check_not_negative(&element, "effort limit", &[limit.effort])?;
    if let Some(dynamics) = &joint.dynamics {
        check_finite(&element, "dynamics", &[dynamics.damping, dynamics.friction])?;
        check_not_negative(&element, "damping", &[dynamics.damping])?;
        check_not_negative(&element, "friction", &[dynamics.friction])?;
    }
    Ok(())
}

fn check_pose(element: &dyn Fn() -> String, quantity: &'static str, pose: &Pose) -> Result<(), RobotError> {
    check_finite(element, quantity, &pose.xyz.0)?;
    check_finite(element, quantity, &pose.rpy.0)
}

fn check_finite(element: &dyn Fn() -> String, quantity: &'static str, values: &[f64]) -> Result<(), RobotError> {
    if values.iter().all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(RobotError::NonFinite { element: element(), quantity })
    }
}

fn check_not_negative(element: &dyn Fn() -> String, quantity: &'static str, values: &[f64]) -> Result<(), RobotError> {
    match values.iter().find(|value| **value < 0.0) {
        Some(&found) => Err(RobotError::Negative { element: element(), quantity, found }),
        None => Ok(()),
    }
}
