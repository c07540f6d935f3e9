//! The paper's controller exactly as printed, (33) with (34), to show what the printed sign does; never for a scenario.
//!
//! Law: τ = M(q)(q̈ᵈ + kₑė) + C(q,q̇)(q̇ᵈ + kₑe) + g(q) + Ξr, acting on the printed plant M q̈ + C q̇ + G = JᵀFₑ − τ: what the
//! motors give is −τ. With unit inertia the error obeys ë − (kₑ + ξ)ė − kₑξe = 2(q̈ᵈ + …), whose characteristic polynomial
//! s² − (kₑ + ξ)s − kₑξ has a positive root for all positive gains.

use nalgebra::DVector;
use robot::{JointReference, JointState, RobotError, Workspace};
use skills::field::FieldError;

use super::feedback::Feedback;
use super::{Controller, Impedance, ImpedanceConfig};

/// The impedance controller with the sign of the printed plant.
#[derive(Clone, Debug)]
pub struct Literal {
    law: Impedance,
}

impl Literal {
    /// A controller for an arm of `joints` joints.
    ///
    /// # Errors
    /// A [`FieldError`] if a gain is not positive or their number is neither one nor that of the joints.
    pub fn new(config: &ImpedanceConfig, joints: usize) -> Result<Self, FieldError> {
        Ok(Self { law: Impedance::new(config, joints)? })
    }
}

/// Why no scenario may use this controller.
pub(super) fn refusal() -> FieldError {
    FieldError::new(
        "literal",
        "the controller (34) as printed, which drives errors up for all gains: (33) has the torque with the wrong sign",
        "`impedance`, the same law with the sign mended",
    )
}

impl Controller for Literal {
    fn torque(
        &mut self,
        workspace: &mut Workspace,
        state: &JointState,
        reference: &JointReference,
        torque_nm: &mut DVector<f64>,
    ) -> Result<(), RobotError> {
        self.law.torque(workspace, state, reference, torque_nm)?;
        torque_nm.neg_mut();
        Ok(())
    }

    fn feedback(&self, workspace: &mut Workspace, q: &DVector<f64>) -> Result<Feedback, RobotError> {
        let meant = self.law.feedback(workspace, q)?;
        Ok(Feedback { mass: meant.mass, stiffness: -meant.stiffness, damping: -meant.damping })
    }

    fn decisive_gain(&self) -> (&'static str, &'static str) {
        ("literal", "damping_nm_s_per_rad")
    }

    fn check_stability(&self, _: &mut Workspace, _: &DVector<f64>, _: f64) -> Result<(), FieldError> {
        Err(refusal())
    }
}
