//! The range of the basis Ψ that all demonstrations share, and what is left of a table outside it.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::IdentificationData;
use crate::basis::GaussianBasis;
use crate::canonical::CanonicalSystem;
use crate::error::SkillError;
use crate::primitive::DmpConfig;
use crate::regression::{RegressionConfig, Ridge};

/// Activations Ψ of all samples with the factor of their normal equations; factored once, used by every round.
///
/// A sample activates few neighboring bases, so only those are kept.
pub(super) struct SharedBasis {
    /// Per sample, its first active basis and where its activations begin in `activations`.
    rows: Vec<(usize, usize)>,
    /// Activations of all samples one after another.
    activations: Vec<f64>,
    /// Weights of the samples.
    weights: DVector<f64>,
    factor: Cholesky<f64, Dyn>,
}

impl SharedBasis {
    /// Evaluates Ψ at the phases of `data` and factors ΨᵀVΨ + λ·tr(ΨᵀVΨ)/n·I, with the λ of the primitive's ridge.
    ///
    /// # Errors
    /// If the samples do not determine the weights.
    pub(super) fn new(primitive: &DmpConfig, data: &IdentificationData) -> Result<Self, SkillError> {
        let canonical = CanonicalSystem::new(primitive.gamma);
        let basis = GaussianBasis::uniform_in_time(primitive.bases, canonical, primitive.crossing());
        let ridge = match &primitive.regression {
            RegressionConfig::Ridge(ridge) => ridge.lambda,
            RegressionConfig::Lwr(_) | RegressionConfig::Recursive(_) => Ridge::default().lambda,
        };
        let count = basis.count();
        let mut rows = Vec::with_capacity(data.phases().len());
        let mut activations = Vec::new();
        let mut normal = DMatrix::zeros(count, count);
        let mut all = DVector::zeros(count);
        for (phase, weight) in data.phases().iter().zip(data.weights().iter()) {
            basis.activate_into(*phase, &mut all);
            let first = all.iter().position(|value| *value != 0.0).unwrap_or(0);
            let end = all.iter().rposition(|value| *value != 0.0).map_or(0, |last| last + 1);
            let active = all.rows(first, end.saturating_sub(first));
            rows.push((first, activations.len()));
            activations.extend(active.iter());
            let size = active.len();
            normal.view_mut((first, first), (size, size)).ger(*weight, &active, &active, 1.0);
        }
        let added = ridge * normal.trace() / count as f64;
        for i in 0..count {
            normal[(i, i)] += added;
        }
        let undetermined = SkillError::Undetermined { samples: rows.len(), bases: count };
        let factor = normal.cholesky().ok_or(undetermined)?;
        Ok(Self { rows, activations, weights: data.weights().clone(), factor })
    }

    /// Returns the number n of bases.
    pub(super) fn count(&self) -> usize {
        self.factor.l_dirty().nrows()
    }

    /// Evaluates (I − P) of `table` (M × d): what the least squares of Eq. (13) over demonstrations and samples leaves.
    pub(super) fn residual(&self, table: &DMatrix<f64>) -> DMatrix<f64> {
        let mut weights = DMatrix::zeros(self.count(), table.ncols());
        for (values, mut sums) in table.column_iter().zip(weights.column_iter_mut()) {
            let sums = sums.as_mut_slice();
            for (m, (value, weight)) in values.iter().zip(self.weights.iter()).enumerate() {
                let (first, active) = self.active(m);
                let scaled = weight * value;
                for (sum, activation) in sums[first..].iter_mut().zip(active) {
                    *sum += scaled * activation;
                }
            }
        }
        self.factor.solve_mut(&mut weights);
        let mut residual = table.clone();
        for (mut values, weights) in residual.column_iter_mut().zip(weights.column_iter()) {
            let weights = weights.as_slice();
            for (m, value) in values.iter_mut().enumerate() {
                let (first, active) = self.active(m);
                *value -=
                    weights[first..].iter().zip(active).map(|(weight, activation)| weight * activation).sum::<f64>();
            }
        }
        residual
    }

    // first active basis of a sample and its activations
    fn active(&self, m: usize) -> (usize, &[f64]) {
        let (first, begin) = self.rows[m];
        let end = self.rows.get(m + 1).map_or(self.activations.len(), |(_, end)| *end);
        (first, &self.activations[begin..end])
    }
}
