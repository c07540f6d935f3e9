//! The Coriolis matrix of the Christoffel symbols, so that Ṁ − 2C is exactly skew.
//!
//! C = Σₖ Jₖᵀ (Iₖ J̇ₖ + Bₖ Jₖ), where B(I, v) = ½ [v×* I − I v× + (I v) ×̄*] is the part of the velocity forces that is
//! symmetric in its two velocities (Echeandia and Wensing, J. Mech. Robotics 13, 2021). About the base origin, B has only
//! two blocks. For a body of points at r with velocities ṙ and linear momentum f,
//!
//! B (ω′, v′) = (A ω′, ω′ × f),  A = tr(X) 1 − X,  X = ∫ ṙ rᵀ dm = v hᵀ + ω× Σ,  Σ = ½ tr(Ī) 1 − Ī,
//!
//! and both A and f of a composite are the sums over its bodies.

use nalgebra::{DMatrix, Matrix3};

use crate::dynamics::mass_matrix::fit_square;
use crate::spatial::{Force, Motion, RigidInertia};
use crate::workspace::Workspace;

impl Workspace {
    /// Writes the Coriolis matrix C(q, q̇) (n × n) of the Christoffel symbols: C q̇ is the velocity torque, Ṁ = C + Cᵀ.
    pub fn coriolis_matrix_into(&mut self, out: &mut DMatrix<f64>) {
        fit_square(out, self.model.joint_count());
        self.refresh_composites();
        self.refresh_coriolis_blocks();
        out.fill(0.0);
        let scratch = &self.dynamics;
        for (column, joint) in self.model.joints.iter().enumerate() {
            let state = &self.bodies[column];
            let (block, momentum) = (&scratch.coriolis_blocks[column], &scratch.momenta[column]);
            let subspace = &state.subspace;
            let rate_force = scratch.composites[column].apply(&state.subspace_rate);
            let velocity_force = Force { moment: block * subspace.angular, force: subspace.angular.cross(momentum) };
            let total = rate_force + velocity_force;
            let carried = scratch.composites[column].apply(subspace);
            let transposed = block.tr_mul(&subspace.angular) + momentum.cross(&subspace.linear);
            out[(column, column)] = subspace.dot(&total);
            let mut ancestor = joint.parent;
            while let Some(row) = ancestor {
                let above = &self.bodies[row];
                out[(row, column)] = above.subspace.dot(&total);
                out[(column, row)] = above.subspace_rate.dot(&carried) + above.subspace.angular.dot(&transposed);
                ancestor = self.model.joints[row].parent;
            }
        }
    }

    /// Sums the blocks A and f over each composite.
    fn refresh_coriolis_blocks(&mut self) {
        let scratch = &mut self.dynamics;
        for (index, state) in self.bodies.iter().enumerate() {
            let inertia = &scratch.inertias[index];
            scratch.coriolis_blocks[index] = angular_block(inertia, &state.velocity);
            scratch.momenta[index] = inertia.apply(&state.velocity).force;
        }
        for (index, joint) in self.model.joints.iter().enumerate().rev() {
            if let Some(parent) = joint.parent {
                let (block, momentum) = (scratch.coriolis_blocks[index], scratch.momenta[index]);
                scratch.coriolis_blocks[parent] += block;
                scratch.momenta[parent] += momentum;
            }
        }
    }
}

/// A = tr(X) 1 − X of one body.
fn angular_block(inertia: &RigidInertia, velocity: &Motion) -> Matrix3<f64> {
    let second_moment = Matrix3::from_diagonal_element(0.5 * inertia.about_origin.trace()) - inertia.about_origin;
    let transport =
        velocity.linear * inertia.first_moment.transpose() + velocity.angular.cross_matrix() * second_moment;
    Matrix3::from_diagonal_element(transport.trace()) - transport
}
