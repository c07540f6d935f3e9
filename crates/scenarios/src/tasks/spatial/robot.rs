//! The section `robot` of scenarios in space.

use nalgebra::{DVector, Isometry3, Translation3, UnitQuaternion};
use robot::Manipulator;
use serde::{Deserialize, Serialize};
use sim::controllers::ControllerConfig;
use sim::spatial::{ArmConfig, ModelMismatch};
use skills::field::{FieldError, finite, not_negative, within};

use crate::scenario::ArmKeys;

/// Farthest base from the world's origin along an axis, m: there coordinates still tell a nanometer apart.
const FARTHEST_BASE_M: f64 = 1e6;

/// Coordinates of a pose in space, each of which takes a joint.
const POSE_COORDINATES: usize = 6;

/// The arm that holds the tool, anywhere in space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpatialRobotConfig {
    /// Name of a URDF file in `assets/robots`, without its ending.
    #[schemars(extend("x-asset" = "robots"))]
    pub asset: String,
    /// Position of the arm's base in the world, m.
    #[serde(default)]
    #[schemars(inner(range(min = -FARTHEST_BASE_M, max = FARTHEST_BASE_M)))]
    pub base_m: [f64; 3],
    /// Rotation of the arm's base in the world: roll, pitch, yaw about the world's axes x, y, z, in this order, rad.
    #[serde(default)]
    pub base_rpy_rad: [f64; 3],
    /// Rotor inertia felt at each joint, kg m²; one number per joint, or none for a bare arm.
    #[serde(default)]
    #[schemars(inner(range(min = 0.0)))]
    pub rotor_inertia_kg_m2: Vec<f64>,
    /// Frame of the arm that grips the tool.
    #[serde(default = "default_tool_frame")]
    pub tool_frame: String,
    /// Posture near which the arm begins, and which its spare freedom prefers, rad; the middle of each joint's range if empty.
    #[serde(default)]
    pub posture_rad: Vec<f64>,
    /// Friction of the joints and limits of the motors, which the controller does not know of.
    #[serde(default)]
    pub motors: ArmConfig,
    /// How wrong the controller's model of the arm is.
    #[serde(default)]
    pub mismatch: ModelMismatch,
}

fn default_tool_frame() -> String {
    "panda_hand_tcp".into()
}

impl SpatialRobotConfig {
    /// What is said about the arm, together with its controller.
    pub(crate) fn keys<'a>(&'a self, controller: &'a ControllerConfig) -> ArmKeys<'a> {
        ArmKeys {
            asset: &self.asset,
            rotor_inertia_kg_m2: &self.rotor_inertia_kg_m2,
            tool_frame: &self.tool_frame,
            controller,
            spatial: Some(self),
        }
    }

    /// Checks the numbers on their own.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.base_m.iter().try_for_each(|&place_m| within("base_m", place_m, -FARTHEST_BASE_M, FARTHEST_BASE_M))?;
        finite("base_rpy_rad", &self.base_rpy_rad)?;
        self.rotor_inertia_kg_m2.iter().try_for_each(|&inertia| not_negative("rotor_inertia_kg_m2", inertia))?;
        finite("posture_rad", &self.posture_rad)?;
        self.mismatch.validate().map_err(|error| error.within("mismatch"))
    }

    /// Checks what only the arm tells: the number of its joints, and their limits.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate_for(&self, arm: &Manipulator) -> Result<(), FieldError> {
        let joints = arm.joint_count();
        if joints < POSE_COORDINATES {
            let expected = "at least 6, for a tool that is led in position and orientation";
            return Err(FieldError::new("asset", format!("an arm of {joints} joints"), expected));
        }
        if ![0, joints].contains(&self.posture_rad.len()) {
            let expected = format!("{joints} numbers, one for each joint of the arm, or none");
            return Err(FieldError::new("posture_rad", format!("{} numbers", self.posture_rad.len()), expected));
        }
        for (index, (&position, joint)) in self.posture_rad.iter().zip(arm.joints()).enumerate() {
            let nearest = joint.limits.clamp(position);
            if nearest != position {
                let side = if position < nearest { "at least" } else { "at most" };
                let expected = format!("{side} {nearest}, the limit of joint `{}`", joint.name);
                return Err(FieldError::new(format!("posture_rad.{index}"), position, expected));
            }
        }
        self.motors.validate(joints).map_err(|error| error.within("motors"))
    }

    /// Pose of the arm's base in the world.
    #[must_use]
    pub fn world_from_base(&self) -> Isometry3<f64> {
        let [roll, pitch, yaw] = self.base_rpy_rad;
        let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        Isometry3::from_parts(Translation3::from(nalgebra::Vector3::from(self.base_m)), turn)
    }

    /// The posture near which the arm begins, rad.
    #[must_use]
    pub fn posture(&self, arm: &Manipulator) -> DVector<f64> {
        if self.posture_rad.len() == arm.joint_count() {
            return DVector::from_column_slice(&self.posture_rad);
        }
        let middle = |limits: &robot::JointLimits| match (limits.lower, limits.upper) {
            (Some(lower), Some(upper)) => 0.5 * lower + 0.5 * upper,
            _ => limits.clamp(0.0),
        };
        DVector::from_iterator(arm.joint_count(), arm.joints().iter().map(|joint| middle(&joint.limits)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PANDA: &str = include_str!("../../../../../assets/robots/panda.urdf");
    const PLANAR: &str = include_str!("../../../../../assets/robots/planar_3r.urdf");

    fn refused(urdf: &str, keys: &str) -> Option<FieldError> {
        let config: SpatialRobotConfig = toml::from_str(&format!("asset = \"arm\"\n{keys}")).expect("reads");
        let arm = Manipulator::from_urdf_str(urdf).expect("valid");
        config.validate().and_then(|()| config.validate_for(&arm)).err()
    }

    #[test]
    fn a_posture_outside_a_joints_range_is_refused_with_the_nearest_within() {
        let error = refused(PANDA, "posture_rad = [0.0, 5.0, 0.0, -2.0, 0.0, 1.5, 0.0]").expect("refused");
        assert_eq!(error.field, "posture_rad.1");
        assert!(error.expected.contains("panda_joint2") && error.expected.contains("1.7628"), "{error}");
        assert_eq!(refused(PANDA, "posture_rad = [0.0, 1.7628, 0.0, -2.0, 0.0, 1.5, 0.0]"), None);
    }

    #[test]
    fn an_arm_that_cannot_lead_a_tool_in_space_is_refused_before_the_run() {
        assert_eq!(refused(PLANAR, "").expect("refused").field, "asset");
    }

    #[test]
    fn a_base_so_far_away_that_millimeters_are_lost_is_refused() {
        assert_eq!(refused(PANDA, "base_m = [1e300, 0.0, 0.0]").expect("refused").field, "base_m");
    }
}
