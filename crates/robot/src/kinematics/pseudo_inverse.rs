//! Joint velocities for a task velocity: x = Jᵀ (J Jᵀ + damping)⁻¹ e over chosen rows and free joints.

use nalgebra::{Cholesky, DVector, Matrix6, Matrix6xX, U6, Vector6};

use crate::kinematics::task_rows::TaskRows;

/// A factored J Jᵀ. Rows outside the task hold the identity, so that six rows serve every task.
pub(crate) struct PseudoInverse {
    factor: Cholesky<f64, U6>,
    /// Smallest squared pivot among the task's rows.
    pub smallest_pivot: f64,
}

impl PseudoInverse {
    /// Factors J Jᵀ + `damping` over the rows of the task and the joints that are not `locked`; `None` if it is not
    /// positive definite. The Jacobian has zeros in rows outside the task.
    pub fn new(jacobian: &Matrix6xX<f64>, rows: TaskRows, locked: &[bool], damping: f64) -> Option<Self> {
        let mut gram = Matrix6::zeros();
        for (column, _) in jacobian.column_iter().zip(locked).filter(|(_, locked)| !**locked) {
            gram.ger(1.0, &column, &column, 1.0);
        }
        for row in 0..6 {
            gram[(row, row)] += if rows.indices().contains(&row) { damping } else { 1.0 };
        }
        let factor = Cholesky::new(gram)?;
        let pivots = rows.indices().iter().map(|&row| factor.l_dirty()[(row, row)].powi(2));
        let smallest_pivot = pivots.fold(f64::INFINITY, f64::min);
        Some(Self { factor, smallest_pivot })
    }

    /// Returns (J Jᵀ + damping)⁻¹ times a task velocity.
    pub fn weights(&self, task: &Vector6<f64>) -> Vector6<f64> {
        self.factor.solve(task)
    }

    /// Takes from joint velocities what moves the frame: z − J⁺ J z. Locked joints must be at rest in `velocities`.
    pub fn keep_null_part(
        &self,
        jacobian: &Matrix6xX<f64>,
        locked: &[bool],
        velocities: &mut DVector<f64>,
        scratch: &mut DVector<f64>,
    ) {
        self.solve_into(jacobian, locked, &task_part(jacobian, velocities), scratch);
        *velocities -= &*scratch;
    }

    /// Writes the joint velocities (n entries) for a task velocity; locked joints get zero.
    pub fn solve_into(&self, jacobian: &Matrix6xX<f64>, locked: &[bool], task: &Vector6<f64>, out: &mut DVector<f64>) {
        let weights = self.weights(task);
        for ((column, &locked), value) in jacobian.column_iter().zip(locked).zip(out.iter_mut()) {
            *value = if locked { 0.0 } else { column.dot(&weights) };
        }
    }
}

/// Jacobian times joint velocities; zero in rows outside the task.
pub(crate) fn task_part(jacobian: &Matrix6xX<f64>, velocities: &DVector<f64>) -> Vector6<f64> {
    let mut task = Vector6::zeros();
    task.gemv(1.0, jacobian, velocities, 0.0);
    task
}

/// Sets the rows of a Jacobian outside the task to zero.
pub(crate) fn keep_task_rows(jacobian: &mut Matrix6xX<f64>, rows: TaskRows) {
    for row in (0..6).filter(|row| !rows.indices().contains(row)) {
        jacobian.row_mut(row).fill(0.0);
    }
}

/// Sets the rows of a task velocity outside the task to zero.
pub(crate) fn masked(task: &Vector6<f64>, rows: TaskRows) -> Vector6<f64> {
    let mut result = Vector6::zeros();
    for &row in rows.indices() {
        result[row] = task[row];
    }
    result
}
