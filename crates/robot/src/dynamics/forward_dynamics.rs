//! Joint accelerations under given torques, by the articulated-body algorithm.

use nalgebra::{DVector, Vector6};

use crate::dynamics::composite::fit_vector;
use crate::error::RobotError;
use crate::manipulator::check_length;
use crate::workspace::Workspace;

impl Workspace {
    /// Writes the accelerations q̈ = M⁻¹ (τ − C q̇ − g) (n entries; rad/s² or m/s²) under torques `torques` (n entries;
    /// N m or N) in the present state. External forces enter as torques Jᵀ F. A joint that moves neither mass nor
    /// rotor gets an acceleration that is not finite.
    ///
    /// # Errors
    /// [`RobotError::WrongLength`].
    pub fn forward_dynamics_into(&mut self, torques: &DVector<f64>, out: &mut DVector<f64>) -> Result<(), RobotError> {
        check_length("forward dynamics: torques", torques.len(), self.model.joint_count())?;
        fit_vector(out, self.model.joint_count());
        self.refresh_inertias();
        self.gather_articulated_inertias(torques);
        self.release_accelerations(out);
        Ok(())
    }

    /// Inward pass: what each joint feels of the tree it carries.
    fn gather_articulated_inertias(&mut self, torques: &DVector<f64>) {
        let scratch = &mut self.dynamics;
        for (index, state) in self.bodies.iter().enumerate() {
            scratch.articulated[index] = scratch.inertias[index].to_matrix();
            scratch.articulated_forces[index] = scratch.inertias[index].gyroscopic(&state.velocity).to_vector();
        }
        for (index, joint) in self.model.joints.iter().enumerate().rev() {
            let state = &self.bodies[index];
            let subspace = state.subspace.to_vector();
            let inertia = scratch.articulated[index];
            let force = scratch.articulated_forces[index];
            let column = inertia * subspace;
            let pivot = subspace.dot(&column) + joint.rotor_inertia;
            let effort = torques[index] - subspace.dot(&force);
            scratch.articulated_columns[index] = column;
            scratch.pivots[index] = pivot;
            scratch.efforts[index] = effort;
            if let Some(parent) = joint.parent {
                let reduced = inertia - column * (column / pivot).transpose();
                let velocity_part = state.subspace_rate.scaled(self.dq[index]).to_vector();
                scratch.articulated[parent] += reduced;
                scratch.articulated_forces[parent] += force + reduced * velocity_part + column * (effort / pivot);
            }
        }
    }

    /// Outward pass: accelerations, with the base accelerated against gravity.
    fn release_accelerations(&mut self, out: &mut DVector<f64>) {
        let gravity = self.model.gravity_in_base;
        let base = Vector6::new(0.0, 0.0, 0.0, -gravity.x, -gravity.y, -gravity.z);
        let scratch = &mut self.dynamics;
        for (index, joint) in self.model.joints.iter().enumerate() {
            let state = &self.bodies[index];
            // the inward forces are not needed any more, so their places take the accelerations
            let parent = joint.parent.map_or(base, |parent| scratch.articulated_forces[parent]);
            let carried = parent + state.subspace_rate.scaled(self.dq[index]).to_vector();
            let free = scratch.efforts[index] - scratch.articulated_columns[index].dot(&carried);
            out[index] = free / scratch.pivots[index];
            scratch.articulated_forces[index] = carried + state.subspace.to_vector() * out[index];
        }
    }
}
