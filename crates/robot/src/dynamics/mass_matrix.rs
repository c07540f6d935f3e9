//! The joint-space mass matrix by the composite-rigid-body algorithm.

use nalgebra::DMatrix;

use crate::workspace::Workspace;

impl Workspace {
    /// Writes the symmetric mass matrix M(q) (n × n; kg m² for pairs of rotary joints), rotor inertias on the diagonal.
    ///
    /// Featherstone, Rigid Body Dynamics Algorithms, 2008, section 6.2.
    pub fn mass_matrix_into(&mut self, out: &mut DMatrix<f64>) {
        fit_square(out, self.model.joint_count());
        self.refresh_composites();
        out.fill(0.0);
        for (index, joint) in self.model.joints.iter().enumerate() {
            let momentum = self.dynamics.composites[index].apply(&self.bodies[index].subspace);
            out[(index, index)] = self.bodies[index].subspace.dot(&momentum) + joint.rotor_inertia;
            let mut ancestor = joint.parent;
            while let Some(row) = ancestor {
                let entry = self.bodies[row].subspace.dot(&momentum);
                out[(row, index)] = entry;
                out[(index, row)] = entry;
                ancestor = self.model.joints[row].parent;
            }
        }
    }
}

/// Gives an output matrix n × n entries if it has another shape.
pub(crate) fn fit_square(out: &mut DMatrix<f64>, n: usize) {
    if out.shape() != (n, n) {
        *out = DMatrix::zeros(n, n);
    }
}
