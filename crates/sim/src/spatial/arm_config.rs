//! How a simulated arm differs from a frictionless arm of ideal motors.

use serde::{Deserialize, Serialize};
use skills::field::{FieldError, not_negative, positive};

/// Friction of one joint, which the controller does not know of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct JointFriction {
    /// Coulomb friction, N m (N): the largest torque with which the joint resists motion, also at rest.
    #[schemars(range(min = 0.0))]
    pub coulomb_nm: f64,
    /// Viscous friction, N m s/rad (N s/m).
    #[schemars(range(min = 0.0))]
    pub viscous_nm_s_per_rad: f64,
}

/// Friction and motors of a simulated arm.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ArmConfig {
    /// Friction of each joint; one entry for all joints, one per joint, or none.
    pub friction: Vec<JointFriction>,
    /// Largest change of a motor's torque, N m/s; any if absent. A Franka arm takes 1000 N m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub torque_rate_limit_nm_per_s: Option<f64>,
    /// Whether the motors give any torque, whatever the arm's description says they can.
    pub ideal_motors: bool,
}

impl ArmConfig {
    /// Checks the numbers for an arm of `joints` joints.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self, joints: usize) -> Result<(), FieldError> {
        if ![0, 1, joints].contains(&self.friction.len()) {
            let expected = format!("none, one for all joints, or {joints}: one for each joint of the arm");
            return Err(FieldError::new("friction", format!("{} entries", self.friction.len()), expected));
        }
        for (index, friction) in self.friction.iter().enumerate() {
            let at = |error: FieldError| error.within(format!("friction.{index}"));
            not_negative("coulomb_nm", friction.coulomb_nm).map_err(at)?;
            not_negative("viscous_nm_s_per_rad", friction.viscous_nm_s_per_rad).map_err(at)?;
        }
        self.torque_rate_limit_nm_per_s.map_or(Ok(()), |rate| positive("torque_rate_limit_nm_per_s", rate))
    }

    /// Friction of joint number `joint`.
    #[must_use]
    pub fn friction_of(&self, joint: usize) -> JointFriction {
        let only = self.friction.first().filter(|_| self.friction.len() == 1);
        self.friction.get(joint).or(only).copied().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_friction_serves_all_joints_and_none_is_none() {
        let friction = JointFriction { coulomb_nm: 1.0, viscous_nm_s_per_rad: 0.5 };
        let config = ArmConfig { friction: vec![friction], ..ArmConfig::default() };
        assert_eq!(config.friction_of(6), friction);
        assert_eq!(ArmConfig::default().friction_of(0), JointFriction::default());
    }

    #[test]
    fn numbers_that_cannot_be_used_are_named() {
        let friction = |coulomb_nm| JointFriction { coulomb_nm, ..JointFriction::default() };
        let with = |friction: Vec<JointFriction>, rate| ArmConfig {
            friction,
            torque_rate_limit_nm_per_s: rate,
            ..ArmConfig::default()
        };
        let field = |config: ArmConfig| config.validate(7).expect_err("invalid").field;
        assert_eq!(field(with(vec![friction(0.0); 3], None)), "friction");
        assert_eq!(field(with(vec![friction(-1.0)], None)), "friction.0.coulomb_nm");
        assert_eq!(field(with(vec![], Some(0.0))), "torque_rate_limit_nm_per_s");
        assert!(with(vec![friction(1.0); 7], Some(1000.0)).validate(7).is_ok());
    }
}
