//! The paper's impedance controller (34) with a damping that follows the arm's inertia.
//!
//! Law: τ = M(q)(q̈ᵈ + kₑė) + C(q,q̇)(q̇ᵈ + kₑe) + g(q) + Ξ(q)r, with r = ė + kₑe, Ξ(q) = ω·diag(M(q)) + ξ0.
//! The closed loop M ṙ + C r + Ξ(q) r = −JᵀFₑ stays passive from force to r: the storage ½rᵀMr falls by rᵀΞr, whatever
//! Ξ(q) ≥ ξ0 > 0 does, since Ṁ − 2C is skew. Heavy joints are held stiffly and light ones are not fed back faster than about
//! ω: one number replaces a gain for each joint.
//!
//! What breaks it: as for the constant damping, (λ_max(M⁻¹Ξ) + kₑ)·dt < 2. λ_max(M⁻¹diag(M)) is at most the number of joints,
//! so that ω dt < 0.2 is safe for any arm of up to nine joints as long as ξ0 is small beside ω times the lightest inertia.

use nalgebra::{DMatrix, DVector};
use robot::{JointReference, JointState, RobotError, Workspace};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, positive};

use super::Controller;
use super::feedback::Feedback;
use super::terms::ModelTerms;

/// Gains of the inertia-shaped controller.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct InertiaShapedConfig {
    /// kₑ: rate at which a position error fades, 1/s.
    pub error_gain_per_s: f64,
    /// ω: rate at which a velocity error fades, 1/s.
    pub damping_rate_per_s: f64,
    /// ξ0: damping that every joint has at least, N m s/rad.
    pub least_damping_nm_s_per_rad: f64,
}

impl Default for InertiaShapedConfig {
    fn default() -> Self {
        Self { error_gain_per_s: 10.0, damping_rate_per_s: 40.0, least_damping_nm_s_per_rad: 0.5 }
    }
}

/// The inertia-shaped controller of one arm.
#[derive(Clone, Debug)]
pub struct InertiaShaped {
    gains: InertiaShapedConfig,
    terms: ModelTerms,
}

impl InertiaShaped {
    /// A controller for an arm of `joints` joints.
    ///
    /// # Errors
    /// A [`FieldError`] if a gain is not positive.
    pub fn new(config: &InertiaShapedConfig, joints: usize) -> Result<Self, FieldError> {
        positive("error_gain_per_s", config.error_gain_per_s)?;
        positive("damping_rate_per_s", config.damping_rate_per_s)?;
        positive("least_damping_nm_s_per_rad", config.least_damping_nm_s_per_rad)?;
        Ok(Self { gains: config.clone(), terms: ModelTerms::new(joints) })
    }
}

impl Controller for InertiaShaped {
    fn torque(
        &mut self,
        workspace: &mut Workspace,
        state: &JointState,
        reference: &JointReference,
        torque_nm: &mut DVector<f64>,
    ) -> Result<(), RobotError> {
        let gains = &self.gains;
        self.terms.evaluate(workspace, state, reference, gains.error_gain_per_s, torque_nm)?;
        for (joint, sliding_error) in self.terms.sliding_error.iter().enumerate() {
            let inertia = self.terms.mass[(joint, joint)];
            let damping = gains.damping_rate_per_s * inertia + gains.least_damping_nm_s_per_rad;
            torque_nm[joint] += damping * sliding_error;
        }
        Ok(())
    }

    fn feedback(&self, workspace: &mut Workspace, q: &DVector<f64>) -> Result<Feedback, RobotError> {
        workspace.set_positions(q)?;
        let (mut mass, gains) = (self.terms.mass.clone(), &self.gains);
        workspace.mass_matrix_into(&mut mass);
        let shaped = (mass.diagonal() * gains.damping_rate_per_s).add_scalar(gains.least_damping_nm_s_per_rad);
        let damping = &mass * gains.error_gain_per_s + DMatrix::from_diagonal(&shaped);
        Ok(Feedback { mass, stiffness: shaped * gains.error_gain_per_s, damping })
    }

    fn decisive_gain(&self) -> (&'static str, &'static str) {
        ("inertia_shaped", "damping_rate_per_s")
    }
}
