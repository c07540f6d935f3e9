//! The paper's impedance controller (34), with the signs that make it stable.
//!
//! Law: τ = M(q)(q̈ᵈ + kₑė) + C(q,q̇)(q̇ᵈ + kₑe) + g(q) + Ξr, with e = qᵈ − q, r = ė + kₑe, Ξ = diag(ξ).
//! With the plant M q̈ + C q̇ + g = τ + JᵀFₑ (Fₑ: force of the environment on the arm) it gives M ṙ + C r + Ξ r = −JᵀFₑ:
//! passive from force to r, since Ṁ − 2C is skew for the Christoffel C that is used here. The printed plant equation has
//! τ with the opposite sign, for which the law diverges.
//!
//! What breaks it: torques held over a control period dt feed velocity errors back with Ξ + kₑM, which needs
//! (ξ/λ_min(M) + kₑ)·dt < 2: light joints without rotor inertia go unstable under gains that suit heavy ones. A constant tip force F leaves e = −JᵀF/(kₑξ).

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use robot::{JointReference, JointState, Workspace};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, positive};

use super::Controller;

/// Gains of the impedance controller.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImpedanceConfig {
    /// kₑ: rate at which a position error fades, 1/s.
    #[serde(default = "paper_error_gain")]
    pub error_gain_per_s: f64,
    /// ξ of each joint, N m s/rad; one number serves all joints.
    #[serde(default = "paper_damping")]
    pub damping_nm_s_per_rad: Vec<f64>,
}

fn paper_error_gain() -> f64 {
    3.0
}

fn paper_damping() -> Vec<f64> {
    vec![10.0]
}

/// The impedance controller of one arm.
#[derive(Clone, Debug)]
pub struct Impedance {
    error_gain_per_s: f64,
    damping: DVector<f64>,
    mass: DMatrix<f64>,
    coriolis: DMatrix<f64>,
    gravity: DVector<f64>,
    acceleration: DVector<f64>,
    velocity: DVector<f64>,
}

/// Sampled feedback of velocity alternates in sign and grows beyond this value of (ξ/λ_min(M) + kₑ)·dt.
const SAMPLED_DAMPING_BOUND: f64 = 2.0;

impl Impedance {
    /// A controller for an arm of `joints` joints.
    ///
    /// # Errors
    /// A [`FieldError`] if a gain is not positive or their number is neither one nor that of the joints.
    pub fn new(config: &ImpedanceConfig, joints: usize) -> Result<Self, FieldError> {
        const DAMPING: &str = "damping_nm_s_per_rad";
        positive("error_gain_per_s", config.error_gain_per_s)?;
        config.damping_nm_s_per_rad.iter().try_for_each(|gain| positive(DAMPING, *gain))?;
        let damping = match config.damping_nm_s_per_rad.as_slice() {
            [one] => DVector::repeat(joints, *one),
            gains if gains.len() == joints => DVector::from_column_slice(gains),
            gains => {
                let expected = format!("one number, or {joints}: one for each joint of the arm");
                return Err(FieldError::new(DAMPING, format!("{} numbers", gains.len()), expected));
            }
        };
        Ok(Self {
            error_gain_per_s: config.error_gain_per_s,
            damping,
            mass: DMatrix::zeros(joints, joints),
            coriolis: DMatrix::zeros(joints, joints),
            gravity: DVector::zeros(joints),
            acceleration: DVector::zeros(joints),
            velocity: DVector::zeros(joints),
        })
    }

    /// kₑ plus the largest eigenvalue of M⁻¹Ξ at posture `q`, 1/s: the fastest rate at which velocity errors are fed back.
    fn fastest_rate_per_s(&self, workspace: &mut Workspace, q: &DVector<f64>) -> f64 {
        let mut mass = self.mass.clone();
        if workspace.set_positions(q).is_err() {
            return f64::INFINITY;
        }
        workspace.mass_matrix_into(&mut mass);
        let root = DMatrix::from_diagonal(&self.damping.map(f64::sqrt));
        let Some(inverse) = mass.try_inverse() else { return f64::INFINITY };
        self.error_gain_per_s + SymmetricEigen::new(&root * inverse * &root).eigenvalues.max()
    }
}

impl Controller for Impedance {
    fn torque(
        &mut self,
        workspace: &mut Workspace,
        state: &JointState,
        reference: &JointReference,
        torque_nm: &mut DVector<f64>,
    ) -> Result<(), robot::RobotError> {
        let gain = self.error_gain_per_s;
        workspace.set_state(&state.q, &state.dq)?;
        workspace.mass_matrix_into(&mut self.mass);
        workspace.coriolis_matrix_into(&mut self.coriolis);
        workspace.gravity_into(&mut self.gravity);
        for joint in 0..self.damping.len() {
            let error = reference.q[joint] - state.q[joint];
            let rate = reference.dq[joint] - state.dq[joint];
            self.acceleration[joint] = reference.ddq[joint] + gain * rate;
            self.velocity[joint] = reference.dq[joint] + gain * error;
            torque_nm[joint] = self.gravity[joint] + self.damping[joint] * (rate + gain * error);
        }
        torque_nm.gemv(1.0, &self.mass, &self.acceleration, 1.0);
        torque_nm.gemv(1.0, &self.coriolis, &self.velocity, 1.0);
        Ok(())
    }

    fn describe(&self, workspace: &mut Workspace, q: &DVector<f64>, control_period_s: f64) -> Vec<String> {
        let ratio = self.fastest_rate_per_s(workspace, q) * control_period_s;
        let stiffness: Vec<String> =
            self.damping.iter().map(|xi| format!("{:.1}", xi * self.error_gain_per_s)).collect();
        vec![
            format!(
                "impedance: error gain {} 1/s, joint stiffness {} N m/rad, errors settle to 2 % in {:.2} s",
                self.error_gain_per_s,
                stiffness.join(" / "),
                50.0_f64.ln() / self.error_gain_per_s
            ),
            format!(
                "impedance: sampled damping (xi/lambda_min(M) + k_e)*dt is {ratio:.3} at the start (stable below {SAMPLED_DAMPING_BOUND})"
            ),
        ]
    }

    fn check_stability(
        &self,
        workspace: &mut Workspace,
        q: &DVector<f64>,
        control_period_s: f64,
    ) -> Result<(), FieldError> {
        let ratio = self.fastest_rate_per_s(workspace, q) * control_period_s;
        if ratio < SAMPLED_DAMPING_BOUND {
            return Ok(());
        }
        Err(FieldError::new(
            "damping_nm_s_per_rad",
            format!("gains for which (xi/lambda_min(M) + error_gain_per_s)*dt is {ratio:.2} at the start"),
            format!(
                "a ratio below {SAMPLED_DAMPING_BOUND}: smaller gains, more rotor inertia or a shorter control period"
            ),
        )
        .within("impedance"))
    }
}
