//! Ridge regression: weighted least squares over all bases at once.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::{ForcingSamples, Regression};
use crate::basis::GaussianBasis;
use crate::error::SkillError;
use crate::field::{FieldError, not_negative};

/// Least squares with a ridge: (PᵀVP + λ·tr(PᵀVP)/n·I) W = PᵀVF, with P the M × n rows Ψ(s_m)ᵀ of Eq. (2), V the sample
/// weights and F the targets of Eq. (5).
///
/// The ridge is relative to the mean diagonal, so that λ means the same for every number of samples and every unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Ridge {
    /// λ ≥ 0, without unit; 1e-8 by default.
    #[schemars(range(min = 0.0))]
    pub lambda: f64,
}

impl Default for Ridge {
    fn default() -> Self {
        Self { lambda: 1e-8 }
    }
}

impl Regression for Ridge {
    fn fit(&self, samples: &ForcingSamples, basis: &GaussianBasis) -> Result<DMatrix<f64>, SkillError> {
        let targets = samples.targets.transpose();
        let mut activations = vec![0.0; basis.count()];
        let mut normal = DMatrix::zeros(basis.count(), basis.count());
        let mut moments = DMatrix::zeros(targets.nrows(), basis.count());
        for (m, (phase, weight)) in samples.phases.iter().zip(samples.weights.iter()).enumerate() {
            // only a band of neighboring bases is active: the rest of the row of P is zero
            let active = basis.activate_active(*phase, &mut activations);
            for column in active.clone() {
                let weighted = weight * activations[column];
                moments.column_mut(column).axpy(weighted, &targets.column(m), 1.0);
                for row in column..active.end {
                    normal[(row, column)] += weighted * activations[row];
                }
            }
        }
        let ridge = self.lambda * normal.trace() / basis.count() as f64;
        for i in 0..basis.count() {
            normal[(i, i)] += ridge;
        }
        let undetermined = SkillError::Undetermined { samples: samples.phases.len(), bases: basis.count() };
        // reads the lower triangle alone
        let factor = normal.cholesky().ok_or(undetermined)?;
        Ok(factor.solve(&moments.transpose()))
    }

    fn default_crossing(&self) -> f64 {
        0.72
    }

    fn validate(&self) -> Result<(), FieldError> {
        not_negative("lambda", self.lambda)
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::DVector;

    use super::*;
    use crate::canonical::CanonicalSystem;

    /// Rounding times the condition number of four well separated bases.
    const ROUNDING: f64 = 1e-9;

    fn samples_of(weights: &DMatrix<f64>, basis: &GaussianBasis, repeats: usize) -> ForcingSamples {
        let phases = DVector::from_fn(60 * repeats, |m, _| 0.01f64.powf((m % 60) as f64 / 59.0));
        let targets = basis.design_matrix(&phases) * weights;
        ForcingSamples { weights: DVector::repeat(phases.len(), 1.0), phases, targets }
    }

    fn four() -> (GaussianBasis, DMatrix<f64>) {
        let basis = GaussianBasis::uniform_in_time(4, CanonicalSystem::new(100f64.ln()), 0.5);
        (basis, DMatrix::from_row_slice(4, 2, &[1.0, -2.0, 3.0, 0.5, -1.0, 4.0, 2.0, -3.0]))
    }

    #[test]
    fn a_forcing_term_of_the_bases_is_recovered_without_ridge() {
        let (basis, weights) = four();
        let fitted = Ridge { lambda: 0.0 }.fit(&samples_of(&weights, &basis, 1), &basis).unwrap();
        assert_relative_eq!(fitted, weights, max_relative = ROUNDING);
    }

    #[test]
    fn repeating_every_sample_changes_nothing() {
        let (basis, weights) = four();
        let once = Ridge { lambda: 1e-2 }.fit(&samples_of(&weights, &basis, 1), &basis).unwrap();
        let twice = Ridge { lambda: 1e-2 }.fit(&samples_of(&weights, &basis, 2), &basis).unwrap();
        assert_relative_eq!(once, twice, max_relative = ROUNDING);
    }

    #[test]
    fn too_few_samples_without_ridge_are_refused() {
        let (basis, weights) = four();
        let mut samples = samples_of(&weights, &basis, 1);
        samples.weights.fill(0.0);
        let error = Ridge { lambda: 0.0 }.fit(&samples, &basis).unwrap_err();
        assert_eq!(error, SkillError::Undetermined { samples: 60, bases: 4 });
    }
}
