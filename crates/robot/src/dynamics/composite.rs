//! Body inertias in base axes, and composite inertias of each body with all it carries; gravity follows from them.

use nalgebra::{DVector, Matrix3, Vector3};

use crate::joint::{Body, parallel_axis};
use crate::spatial::RigidInertia;
use crate::workspace::{BodyState, Workspace};

impl Workspace {
    /// Brings inertias and composite inertias to the present state, once for each state.
    pub(crate) fn refresh_inertias(&mut self) {
        if !self.dynamics.stale {
            return;
        }
        let scratch = &mut self.dynamics;
        for (index, (joint, state)) in self.model.joints.iter().zip(&self.bodies).enumerate() {
            scratch.inertias[index] = inertia_in_base(&joint.body, state);
            scratch.composites[index] = scratch.inertias[index];
        }
        for (index, joint) in self.model.joints.iter().enumerate().rev() {
            if let Some(parent) = joint.parent {
                let carried = scratch.composites[index];
                scratch.composites[parent] += carried;
            }
        }
        scratch.stale = false;
    }

    /// Writes the torques g(q) (n entries; N m or N) that hold the arm against gravity at the present positions.
    pub fn gravity_into(&mut self, out: &mut DVector<f64>) {
        fit_vector(out, self.model.joint_count());
        self.refresh_inertias();
        let gravity = self.model.gravity_in_base;
        for (index, (state, composite)) in self.bodies.iter().zip(&self.dynamics.composites).enumerate() {
            let moment = composite.first_moment.cross(&gravity);
            let force = gravity * composite.mass;
            out[index] = -(state.subspace.angular.dot(&moment) + state.subspace.linear.dot(&force));
        }
    }

    /// Returns the kinetic energy ½ q̇ᵀ M q̇ (J), rotors included.
    pub fn kinetic_energy_j(&mut self) -> f64 {
        self.refresh_inertias();
        let bodies = self.bodies.iter().zip(&self.dynamics.inertias);
        let moving: f64 = bodies.map(|(state, inertia)| state.velocity.dot(&inertia.apply(&state.velocity))).sum();
        let joints = self.model.joints.iter().zip(self.dq.iter());
        let rotors: f64 = joints.map(|(joint, dq)| joint.rotor_inertia * dq * dq).sum();
        0.5 * (moving + rotors)
    }

    /// Returns the potential energy of the moving bodies (J), zero for a center of mass at the base origin.
    pub fn potential_energy_j(&mut self) -> f64 {
        self.refresh_inertias();
        let first_moment: Vector3<f64> = self.dynamics.inertias.iter().map(|inertia| inertia.first_moment).sum();
        -self.model.gravity_in_base.dot(&first_moment)
    }
}

fn inertia_in_base(body: &Body, state: &BodyState) -> RigidInertia {
    let center = state.origin + state.rotation * body.center_of_mass_m;
    let about_center: Matrix3<f64> = state.rotation * body.inertia_kg_m2 * state.rotation.transpose();
    RigidInertia {
        mass: body.mass_kg,
        first_moment: center * body.mass_kg,
        about_origin: about_center + parallel_axis(body.mass_kg, center),
    }
}

/// Gives an output vector `n` entries if it has another number.
pub(crate) fn fit_vector(out: &mut DVector<f64>, n: usize) {
    if out.len() != n {
        *out = DVector::zeros(n);
    }
}
