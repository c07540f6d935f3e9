//! Joint torques for a wanted acceleration, by the recursive Newton-Euler algorithm.

use nalgebra::DVector;

use crate::dynamics::composite::fit_vector;
use crate::error::RobotError;
use crate::manipulator::check_length;
use crate::spatial::{Motion, RigidInertia};
use crate::workspace::Workspace;

impl Workspace {
    /// Writes the torques τ = M q̈ + C q̇ + g (n entries; N m or N) that give accelerations `ddq` (n entries; rad/s² or
    /// m/s²) in the present state, rotor inertias included, friction and damping not.
    ///
    /// # Errors
    /// [`RobotError::WrongLength`].
    pub fn inverse_dynamics_into(&mut self, ddq: &DVector<f64>, out: &mut DVector<f64>) -> Result<(), RobotError> {
        check_length("inverse dynamics: ddq", ddq.len(), self.model.joint_count())?;
        self.newton_euler(ddq, out);
        Ok(())
    }

    /// Writes the bias torques C q̇ + g (n entries; N m or N) of the present state.
    pub fn bias_into(&mut self, out: &mut DVector<f64>) {
        let zeros = std::mem::replace(&mut self.dynamics.zeros, DVector::zeros(0));
        self.newton_euler(&zeros, out);
        self.dynamics.zeros = zeros;
    }

    fn newton_euler(&mut self, ddq: &DVector<f64>, out: &mut DVector<f64>) {
        fit_vector(out, self.model.joint_count());
        self.refresh_inertias();
        // the base accelerates upward instead of gravity pulling down
        let base = Motion { linear: -self.model.gravity_in_base, ..Motion::zeros() };
        for (index, joint) in self.model.joints.iter().enumerate() {
            let state = &self.bodies[index];
            let parent = joint.parent.map_or(base, |parent| self.dynamics.accelerations[parent]);
            let own = state.subspace.scaled(ddq[index]) + state.subspace_rate.scaled(self.dq[index]);
            let acceleration = parent + own;
            let inertia: &RigidInertia = &self.dynamics.inertias[index];
            self.dynamics.forces[index] = inertia.apply(&acceleration) + inertia.gyroscopic(&state.velocity);
            self.dynamics.accelerations[index] = acceleration;
        }
        for (index, joint) in self.model.joints.iter().enumerate().rev() {
            let force = self.dynamics.forces[index];
            out[index] = self.bodies[index].subspace.dot(&force) + joint.rotor_inertia * ddq[index];
            if let Some(parent) = joint.parent {
                self.dynamics.forces[parent] = self.dynamics.forces[parent] + force;
            }
        }
    }
}
