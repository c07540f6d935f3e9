//! The paper's impedance controller (34), with the signs that make it stable.
//!
//! Law: τ = M(q)(q̈ᵈ + kₑė) + C(q,q̇)(q̇ᵈ + kₑe) + g(q) + Ξr, with e = qᵈ − q, r = ė + kₑe, Ξ = diag(ξ).
//! With the plant M q̈ + C q̇ + g = τ + JᵀFₑ (Fₑ: force of the environment on the arm) it gives M ṙ + C r + Ξ r = −JᵀFₑ:
//! passive from force to r, since Ṁ − 2C is skew for the Christoffel C that is used here. The printed plant equation has
//! τ with the opposite sign, for which the law diverges: see [`super::Literal`].
//!
//! What breaks it: torques held over a control period dt feed velocity errors back with Ξ + kₑM, which needs
//! (ξ/λ_min(M) + kₑ)·dt < 2: light joints without rotor inertia go unstable under gains that suit heavy ones. A constant tip
//! force F leaves e = −JᵀF/(kₑξ).

use nalgebra::{DMatrix, DVector};
use robot::{JointReference, JointState, RobotError, Workspace};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, positive};

use super::Controller;
use super::feedback::Feedback;
use super::gains::per_joint;
use super::terms::ModelTerms;

const DAMPING: &str = "damping_nm_s_per_rad";

/// Gains of the impedance controller.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImpedanceConfig {
    /// kₑ: rate at which a position error fades, 1/s.
    #[serde(default = "paper_error_gain")]
    #[schemars(extend("exclusiveMinimum" = 0))]
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

impl ImpedanceConfig {
    /// The gains of the paper, section IV: kₑ = 3, ξ = 10. For a light planar arm; a Panda gives way by 10 to 20 cm under 10 N.
    #[must_use]
    pub fn paper() -> Self {
        Self { error_gain_per_s: paper_error_gain(), damping_nm_s_per_rad: paper_damping() }
    }
}

/// The impedance controller of one arm.
#[derive(Clone, Debug)]
pub struct Impedance {
    error_gain_per_s: f64,
    damping: DVector<f64>,
    terms: ModelTerms,
}

impl Impedance {
    /// A controller for an arm of `joints` joints.
    ///
    /// # Errors
    /// A [`FieldError`] if a gain is not positive or their number is neither one nor that of the joints.
    pub fn new(config: &ImpedanceConfig, joints: usize) -> Result<Self, FieldError> {
        positive("error_gain_per_s", config.error_gain_per_s)?;
        let damping = per_joint(DAMPING, &config.damping_nm_s_per_rad, joints)?;
        Ok(Self { error_gain_per_s: config.error_gain_per_s, damping, terms: ModelTerms::new(joints) })
    }
}

impl Controller for Impedance {
    fn torque(
        &mut self,
        workspace: &mut Workspace,
        state: &JointState,
        reference: &JointReference,
        torque_nm: &mut DVector<f64>,
    ) -> Result<(), RobotError> {
        self.terms.evaluate(workspace, state, reference, self.error_gain_per_s, torque_nm)?;
        torque_nm.cmpy(1.0, &self.damping, &self.terms.sliding_error, 1.0);
        Ok(())
    }

    fn feedback(&self, workspace: &mut Workspace, q: &DVector<f64>) -> Result<Feedback, RobotError> {
        workspace.set_positions(q)?;
        let mut mass = self.terms.mass.clone();
        workspace.mass_matrix_into(&mut mass);
        let damping = &mass * self.error_gain_per_s + DMatrix::from_diagonal(&self.damping);
        Ok(Feedback { mass, stiffness: &self.damping * self.error_gain_per_s, damping })
    }

    fn decisive_gain(&self) -> (&'static str, &'static str) {
        ("impedance", DAMPING)
    }
}
