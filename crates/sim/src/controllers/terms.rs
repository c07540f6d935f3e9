//! The part of the paper's law (34) that all its forms share: τ = M(q)(q̈ᵈ + kₑė) + C(q,q̇)(q̇ᵈ + kₑe) + g(q).

use nalgebra::{DMatrix, DVector};
use robot::{JointReference, JointState, RobotError, Workspace};

/// The model's terms at one instant, and the errors they act on; allocated once.
#[derive(Clone, Debug)]
pub(super) struct ModelTerms {
    /// M(q), n × n, kg m².
    pub mass: DMatrix<f64>,
    coriolis: DMatrix<f64>,
    acceleration: DVector<f64>,
    velocity: DVector<f64>,
    /// r = ė + kₑe, rad/s: the error that the damping Ξ acts on.
    pub sliding_error: DVector<f64>,
}

impl ModelTerms {
    pub fn new(joints: usize) -> Self {
        Self {
            mass: DMatrix::zeros(joints, joints),
            coriolis: DMatrix::zeros(joints, joints),
            acceleration: DVector::zeros(joints),
            velocity: DVector::zeros(joints),
            sliding_error: DVector::zeros(joints),
        }
    }

    /// Writes the shared part of the law with kₑ = `error_gain_per_s` to `torque_nm`.
    pub fn evaluate(
        &mut self,
        workspace: &mut Workspace,
        state: &JointState,
        reference: &JointReference,
        error_gain_per_s: f64,
        torque_nm: &mut DVector<f64>,
    ) -> Result<(), RobotError> {
        check_lengths(self.sliding_error.len(), state, reference)?;
        workspace.set_state(&state.q, &state.dq)?;
        workspace.mass_matrix_into(&mut self.mass);
        workspace.coriolis_matrix_into(&mut self.coriolis);
        workspace.gravity_into(torque_nm);
        for joint in 0..self.sliding_error.len() {
            let error = reference.q[joint] - state.q[joint];
            let rate = reference.dq[joint] - state.dq[joint];
            self.acceleration[joint] = reference.ddq[joint] + error_gain_per_s * rate;
            self.velocity[joint] = reference.dq[joint] + error_gain_per_s * error;
            self.sliding_error[joint] = rate + error_gain_per_s * error;
        }
        torque_nm.gemv(1.0, &self.mass, &self.acceleration, 1.0);
        torque_nm.gemv(1.0, &self.coriolis, &self.velocity, 1.0);
        Ok(())
    }
}

/// Checks that state and reference belong to the arm that a controller was built for.
pub(super) fn check_lengths(joints: usize, state: &JointState, reference: &JointReference) -> Result<(), RobotError> {
    let lists = [
        ("control: q", &state.q),
        ("control: dq", &state.dq),
        ("control: the reference's q", &reference.q),
        ("control: the reference's dq", &reference.dq),
        ("control: the reference's ddq", &reference.ddq),
    ];
    match lists.iter().find(|(_, list)| list.len() != joints) {
        Some((quantity, list)) => Err(RobotError::WrongLength { quantity, found: list.len(), expected: joints }),
        None => Ok(()),
    }
}
