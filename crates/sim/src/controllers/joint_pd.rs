//! Springs and dampers at the joints with the arm's weight held: the baseline that other controllers are compared with.
//!
//! Law: τ = K(qᵈ − q) + D(q̇ᵈ − q̇) + g(q), K and D diagonal (Takegaki and Arimoto 1981).
//! It holds a posture stably without a model of inertia, but lags behind a motion by D⁻¹ or K⁻¹ times the torques that the
//! motion takes. Held over a control period dt it needs about λ_max(M⁻¹D)·dt < 2.

use nalgebra::{DMatrix, DVector};
use robot::{JointReference, JointState, RobotError, Workspace};
use serde::{Deserialize, Serialize};
use skills::field::FieldError;

use super::Controller;
use super::feedback::Feedback;
use super::gains::per_joint;
use super::terms::check_lengths;

const STIFFNESS: &str = "stiffness_nm_per_rad";
const DAMPING: &str = "damping_nm_s_per_rad";

/// Gains of the joint springs and dampers.
///
/// One number of each serves the shipped planar arms and a Panda alike. D = 10 N m s/rad is half of what the sampled loop
/// bears at the lightest direction of the arms as they are shipped, 2 λ_min(M)/dt with λ_min(M) ≈ 0.01 kg m² and
/// dt = 1 ms, and what the paper gives its own controller. K = 600 N m/rad is the stiffness of the large joints in Franka's
/// example of joint impedance control (libfranka, `joint_impedance_control.cpp`): 10 N at a lever of 0.7 m turn a joint by
/// 12 mrad and move the hand by 8 mm. The price of one number: a joint that moves 2 kg m² swings with a damping ratio
/// D/(2 √(K M)) of 0.14; a list with more damping at the large joints settles sooner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct JointPdConfig {
    /// K of each joint, N m/rad; one number serves all joints.
    pub stiffness_nm_per_rad: Vec<f64>,
    /// D of each joint, N m s/rad; one number serves all joints.
    pub damping_nm_s_per_rad: Vec<f64>,
}

impl Default for JointPdConfig {
    fn default() -> Self {
        Self { stiffness_nm_per_rad: vec![600.0], damping_nm_s_per_rad: vec![10.0] }
    }
}

/// The joint springs and dampers of one arm.
#[derive(Clone, Debug)]
pub struct JointPd {
    stiffness: DVector<f64>,
    damping: DVector<f64>,
}

impl JointPd {
    /// A controller for an arm of `joints` joints.
    ///
    /// # Errors
    /// A [`FieldError`] if a gain is not positive or their number is neither one nor that of the joints.
    pub fn new(config: &JointPdConfig, joints: usize) -> Result<Self, FieldError> {
        let stiffness = per_joint(STIFFNESS, &config.stiffness_nm_per_rad, joints)?;
        Ok(Self { stiffness, damping: per_joint(DAMPING, &config.damping_nm_s_per_rad, joints)? })
    }
}

impl Controller for JointPd {
    fn torque(
        &mut self,
        workspace: &mut Workspace,
        state: &JointState,
        reference: &JointReference,
        torque_nm: &mut DVector<f64>,
    ) -> Result<(), RobotError> {
        check_lengths(self.stiffness.len(), state, reference)?;
        workspace.set_state(&state.q, &state.dq)?;
        workspace.gravity_into(torque_nm);
        for joint in 0..self.stiffness.len() {
            torque_nm[joint] += self.stiffness[joint] * (reference.q[joint] - state.q[joint])
                + self.damping[joint] * (reference.dq[joint] - state.dq[joint]);
        }
        Ok(())
    }

    fn feedback(&self, workspace: &mut Workspace, q: &DVector<f64>) -> Result<Feedback, RobotError> {
        workspace.set_positions(q)?;
        let mut mass = DMatrix::zeros(q.len(), q.len());
        workspace.mass_matrix_into(&mut mass);
        Ok(Feedback { mass, stiffness: self.stiffness.clone(), damping: DMatrix::from_diagonal(&self.damping) })
    }

    fn decisive_gain(&self) -> (&'static str, &'static str) {
        ("joint_pd", DAMPING)
    }
}
