//! Locally weighted regression: one weighted quotient per basis, as in the paper.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::{ForcingSamples, Regression};
use crate::basis::{GaussianBasis, NEGLIGIBLE};
use crate::error::SkillError;
use crate::field::FieldError;

/// Locally weighted regression of Eq. (4): w_i = Σ_m v_m φ_i(s_m) s_m F_m / Σ_m v_m φ_i(s_m) s_m².
///
/// Each basis fits F ≈ w_i s near its center alone, in O(n·M); the blend of Eq. (2) then smooths over neighbors, which
/// costs accuracy. Source: A. J. Ijspeert et al., Neural Computation 25(2), 2013, doi:10.1162/NECO_a_00393.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Lwr {}

impl Regression for Lwr {
    fn fit(&self, samples: &ForcingSamples, basis: &GaussianBasis) -> Result<DMatrix<f64>, SkillError> {
        let targets = samples.targets.transpose();
        let mut fitted = DMatrix::zeros(targets.nrows(), basis.count());
        for (i, mut fitted) in fitted.column_iter_mut().enumerate() {
            let weighted = samples.phases.iter().zip(samples.weights.iter()).enumerate();
            let weighted = weighted.filter(|(_, (_, weight))| **weight > 0.0);
            // relative to the nearest weighted sample, so that a basis between samples does not underflow
            let nearest = weighted.clone().map(|(_, (s, _))| basis.exponent(i, *s)).fold(f64::INFINITY, f64::min);
            let mut denominator = 0.0;
            for (m, (s, weight)) in weighted {
                let beyond = basis.exponent(i, *s) - nearest;
                if beyond < NEGLIGIBLE {
                    let activation = weight * (-beyond).exp();
                    denominator += activation * s * s;
                    fitted.axpy(activation * s, &targets.column(m), 1.0);
                }
            }
            if denominator <= 0.0 {
                return Err(SkillError::Undetermined { samples: samples.phases.len(), bases: basis.count() });
            }
            fitted /= denominator;
        }
        Ok(fitted.transpose())
    }

    fn default_crossing(&self) -> f64 {
        0.5
    }

    fn validate(&self) -> Result<(), FieldError> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::{DVector, dmatrix, dvector};

    use super::*;
    use crate::canonical::CanonicalSystem;

    /// A few roundings.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn a_forcing_term_proportional_to_the_phase_is_recovered() {
        let basis = GaussianBasis::uniform_in_time(50, CanonicalSystem::new(100f64.ln()), 0.5);
        let phases = DVector::from_fn(20, |m, _| 0.01f64.powf(m as f64 / 19.0));
        let targets = DMatrix::from_fn(20, 2, |m, column| phases[m] * [3.0, -7.0][column]);
        let samples = ForcingSamples { weights: DVector::repeat(20, 0.25), phases, targets };
        let fitted = Lwr {}.fit(&samples, &basis).unwrap();
        for i in 0..50 {
            assert_relative_eq!(fitted[(i, 0)], 3.0, max_relative = ROUNDING);
            assert_relative_eq!(fitted[(i, 1)], -7.0, max_relative = ROUNDING);
        }
    }

    #[test]
    fn contradicting_samples_average_by_their_weights() {
        let basis = GaussianBasis::uniform_in_time(2, CanonicalSystem::new(1.0), 0.5);
        let samples =
            ForcingSamples { phases: dvector![0.5, 0.5], targets: dmatrix![1.0; 3.0], weights: dvector![1.0, 3.0] };
        let fitted = Lwr {}.fit(&samples, &basis).unwrap();
        assert_relative_eq!(fitted[(0, 0)], 2.5 / 0.5, max_relative = ROUNDING);
    }

    #[test]
    fn samples_without_weight_are_refused() {
        let basis = GaussianBasis::uniform_in_time(2, CanonicalSystem::new(1.0), 0.5);
        let samples = ForcingSamples { phases: dvector![0.5], targets: dmatrix![1.0], weights: dvector![0.0] };
        assert_eq!(Lwr {}.fit(&samples, &basis), Err(SkillError::Undetermined { samples: 1, bases: 2 }));
    }
}
