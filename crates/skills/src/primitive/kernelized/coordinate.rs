//! The kernel solution of one coordinate: (K + λΣ) w = μ with both ends given exactly, and its conditioning on more rows.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::config::KernelizedConfig;
use super::kernel::{Kernel, Row};
use super::reference::{Reference, progress};

/// Variance of a row that is given exactly, far below every other and far above rounding.
const EXACT: f64 = 1e-13;

/// Learned kernel solution of one coordinate, in units of the reference's scale.
#[derive(Debug, Clone)]
pub(super) struct Coordinate {
    pub(super) reference: Reference,
    // of K + λΣ: 2N rows, value and rate of each reference in turn
    factor: Cholesky<f64, Dyn>,
    // (K + λΣ)⁻¹μ
    weights: DVector<f64>,
}

/// Further rows that a coordinate is conditioned on, with what is needed to ask for its variance.
#[derive(Debug, Clone)]
pub(super) struct Conditioned {
    /// Weights of the 2N rows of the references.
    pub(super) weights: DVector<f64>,
    /// Weights of the further rows.
    pub(super) further: DVector<f64>,
    // K between references and further rows, 2N × m
    cross: DMatrix<f64>,
    // of the covariance of the further rows given the references; nothing without any
    factor: Option<Cholesky<f64, Dyn>>,
}

/// Row that is asked to take `target`, up to the variance `variance`, both in units of the reference's scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Given {
    pub(super) row: Row,
    pub(super) target: f64,
    pub(super) variance: f64,
}

impl Coordinate {
    /// Solves the system; nothing if it is not positive definite.
    pub(super) fn solve(config: &KernelizedConfig, kernel: Kernel, reference: Reference) -> Option<Self> {
        let rows = rows(config);
        let mut matrix = DMatrix::from_fn(rows.len(), rows.len(), |i, j| kernel.between(rows[i], rows[j]));
        let last = config.references - 1;
        let mut means = DVector::zeros(rows.len());
        for (index, (mean, [xx, xv, vv])) in reference.means.iter().zip(&reference.covariances).enumerate() {
            let (x, v) = (2 * index, 2 * index + 1);
            // the residual vanishes with its rate at both ends
            if index == 0 || index == last {
                matrix[(x, x)] += EXACT;
                matrix[(v, v)] += EXACT;
                continue;
            }
            matrix[(x, x)] += config.lambda * xx;
            matrix[(v, v)] += config.lambda * vv;
            matrix[(x, v)] += config.lambda * xv;
            matrix[(v, x)] += config.lambda * xv;
            (means[x], means[v]) = (mean[0], mean[1]);
        }
        let factor = matrix.cholesky()?;
        let weights = factor.solve(&means);
        Some(Self { reference, factor, weights })
    }

    /// Conditions on further rows; nothing if these contradict each other.
    pub(super) fn conditioned(
        &self,
        config: &KernelizedConfig,
        kernel: Kernel,
        given: &[Given],
    ) -> Option<Conditioned> {
        let mut weights = self.weights.clone();
        let rows = rows(config);
        let cross = DMatrix::from_fn(rows.len(), given.len(), |i, j| kernel.between(rows[i], given[j].row));
        if given.is_empty() {
            return Some(Conditioned { weights, further: DVector::zeros(0), cross, factor: None });
        }
        let solved = self.factor.solve(&cross);
        let mut covariance = DMatrix::from_fn(given.len(), given.len(), |i, j| {
            kernel.between(given[i].row, given[j].row) - cross.column(i).dot(&solved.column(j))
        });
        for (i, given) in given.iter().enumerate() {
            covariance[(i, i)] += config.lambda * given.variance;
        }
        let factor = covariance.cholesky()?;
        let missing = DVector::from_fn(given.len(), |i, _| given[i].target - cross.column(i).dot(&weights));
        let further = factor.solve(&missing);
        weights -= solved * &further;
        Some(Conditioned { weights, further, cross, factor: Some(factor) })
    }

    /// Evaluates the variance of the value at `progress`, (N/λ)(k − k*ᵀ(K + λΣ)⁻¹k*), in squared units of the scale.
    pub(super) fn variance(
        &self,
        config: &KernelizedConfig,
        kernel: Kernel,
        conditioned: &Conditioned,
        given: &[Row],
        progress: f64,
    ) -> f64 {
        let here = Row::value(progress);
        let column = DVector::from_iterator(
            2 * config.references,
            rows(config).into_iter().map(|row| kernel.between(row, here)),
        );
        let solved = self.factor.solve(&column);
        let mut variance = 1.0 - column.dot(&solved);
        if let Some(factor) = &conditioned.factor {
            let left = DVector::from_fn(given.len(), |i, _| {
                kernel.between(given[i], here) - conditioned.cross.column(i).dot(&solved)
            });
            variance -= left.dot(&factor.solve(&left));
        }
        config.references as f64 / config.lambda * variance.max(0.0)
    }
}

// value and rate of each reference in turn
fn rows(config: &KernelizedConfig) -> Vec<Row> {
    let both = |index: usize| [Row::value(progress(config, index)), Row::rate(progress(config, index))];
    (0..config.references).flat_map(both).collect()
}
