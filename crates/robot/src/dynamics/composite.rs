//! Body inertias in base axes, and composite inertias of each body with all it carries; gravity follows from them.

use nalgebra::{DVector, Matrix3, Vector3};

use crate::joint::Body;
use crate::spatial::RigidInertia;
use crate::workspace::{BodyState, Workspace};

impl Workspace {
    /// Brings the bodies' inertias to the present state, once for each state.
    pub(crate) fn refresh_inertias(&mut self) {
        if !self.dynamics.stale {
            return;
        }
        for ((joint, state), inertia) in self.model.joints.iter().zip(&self.bodies).zip(&mut self.dynamics.inertias) {
            *inertia = inertia_in_base(&joint.body, state);
        }
        self.dynamics.stale = false;
        self.dynamics.composites_stale = true;
    }

    /// Brings inertias and composite inertias to the present state, once for each state.
    pub(crate) fn refresh_composites(&mut self) {
        self.refresh_inertias();
        let scratch = &mut self.dynamics;
        if !scratch.composites_stale {
            return;
        }
        scratch.composites.copy_from_slice(&scratch.inertias);
        for (index, joint) in self.model.joints.iter().enumerate().rev() {
            if let Some(parent) = joint.parent {
                let carried = scratch.composites[index];
                scratch.composites[parent] += carried;
            }
        }
        scratch.composites_stale = false;
    }

    /// Writes the torques g(q) (n entries; N m or N) that hold the arm against gravity at the present positions.
    pub fn gravity_into(&mut self, out: &mut DVector<f64>) {
        fit_vector(out, self.model.joint_count());
        self.refresh_composites();
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

/// The body's inertia about the base origin, R I Rᵀ + m (|c|² 1 − c cᵀ); of the symmetric tensor one half is computed.
fn inertia_in_base(body: &Body, state: &BodyState) -> RigidInertia {
    let rotation = &state.rotation;
    let center = state.origin + rotation * body.center_of_mass_m;
    let half = rotation * body.inertia_kg_m2;
    let turned = |row: usize, column: usize| {
        half[(row, 0)] * rotation[(column, 0)]
            + half[(row, 1)] * rotation[(column, 1)]
            + half[(row, 2)] * rotation[(column, 2)]
    };
    let (mass, squared) = (body.mass_kg, center.norm_squared());
    let on = |axis: usize| turned(axis, axis) + (squared - center[axis] * center[axis]) * mass;
    let off = |row: usize, column: usize| turned(row, column) - center[row] * center[column] * mass;
    let (xy, xz, yz) = (off(0, 1), off(0, 2), off(1, 2));
    RigidInertia {
        mass,
        first_moment: center * mass,
        about_origin: Matrix3::new(on(0), xy, xz, xy, on(1), yz, xz, yz, on(2)),
    }
}

/// Gives an output vector `n` entries if it has another number.
pub(crate) fn fit_vector(out: &mut DVector<f64>, n: usize) {
    if out.len() != n {
        *out = DVector::zeros(n);
    }
}
