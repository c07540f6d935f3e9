//! Recursive locally weighted regression: the weights of Eq. (4) updated sample by sample.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::{ForcingSamples, Regression};
use crate::basis::GaussianBasis;
use crate::error::SkillError;
use crate::field::FieldError;

/// Recursive least squares per basis: on each sample (s, F) of weight v, S_i ← ρ^{φ_i}·S_i + vφ_i s², then
/// w_i ← w_i + vφ_i s(F − w_i s)/S_i.
///
/// 1/S_i is the covariance P_i of the usual form P_i ← P_i − P_i²s²/(1/φ_i + P_i s²); kept as S_i it can begin at zero,
/// without a prior that biases the first samples. For ρ = 1 the result is that of [`super::Lwr`] up to rounding. Forgetting
/// goes with the activation φ_i, so that a basis forgets only as it learns: at its center S_i decays by ρ per sample.
///
/// Relation to locally weighted projection regression, which the paper names for its linear cost (S. Vijayakumar, A.
/// D'Souza, S. Schaal, Neural Computation 17(12), 2005, doi:10.1162/089976605774320557): both update local models alone,
/// each by its own recursive least squares. LWPR also projects inputs of many dimensions, adds receptive fields where the
/// data ask for them and adapts their widths; here the input is the phase alone and the receptive fields are the bases of
/// Eq. (2), fixed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Recursive {
    /// ρ, above 0 and at most 1, without unit; 1 by default: nothing is forgotten. Below 1 the order of the samples counts.
    pub forgetting: f64,
}

impl Default for Recursive {
    fn default() -> Self {
        Self { forgetting: 1.0 }
    }
}

impl Regression for Recursive {
    fn fit(&self, samples: &ForcingSamples, basis: &GaussianBasis) -> Result<DMatrix<f64>, SkillError> {
        let mut fit = RecursiveFit::new(self, basis.clone(), samples.targets.ncols())?;
        let targets = samples.targets.transpose();
        for (m, (phase, weight)) in samples.phases.iter().zip(samples.weights.iter()).enumerate() {
            fit.absorb(*phase, targets.column(m).as_slice(), *weight)?;
        }
        if fit.is_determined() {
            return Ok(fit.weights);
        }
        Err(SkillError::Undetermined { samples: samples.phases.len(), bases: basis.count() })
    }

    fn default_crossing(&self) -> f64 {
        0.5
    }

    fn validate(&self) -> Result<(), FieldError> {
        if self.forgetting > 0.0 && self.forgetting <= 1.0 {
            return Ok(());
        }
        Err(FieldError::new("forgetting", self.forgetting, "a number above 0 and at most 1"))
    }
}

/// Weights that take in one sample after the other; absorbing allocates nothing and costs as much as the active bases.
#[derive(Debug, Clone, PartialEq)]
pub struct RecursiveFit {
    basis: GaussianBasis,
    forgetting: f64,
    // S_i, n values
    information: Vec<f64>,
    // n × d
    weights: DMatrix<f64>,
}

impl RecursiveFit {
    /// Begins without any sample: all weights zero, to be replaced by the first sample that reaches them.
    ///
    /// # Errors
    /// If an option is out of range or the `dimension` d is zero.
    pub fn new(options: &Recursive, basis: GaussianBasis, dimension: usize) -> Result<Self, SkillError> {
        options.validate()?;
        if dimension == 0 {
            return Err(SkillError::Dimension { operation: "fit weights", found: 0, expected: 1 });
        }
        let count = basis.count();
        let weights = DMatrix::zeros(count, dimension);
        Ok(Self { basis, forgetting: options.forgetting, information: vec![0.0; count], weights })
    }

    /// Takes in one sample: the forcing target F of Eq. (5) (d values, unit of the trajectory) at `phase`, in (0, 1], with
    /// `weight` ≥ 0; 0 changes nothing.
    ///
    /// # Errors
    /// If the target has not d finite values, or phase or weight is out of range; nothing is then changed.
    pub fn absorb(&mut self, phase: f64, target: &[f64], weight: f64) -> Result<(), SkillError> {
        self.check(phase, target, weight)?;
        if weight == 0.0 {
            return Ok(());
        }
        for i in self.basis.active(phase) {
            let activation = (-self.basis.exponent(i, phase)).exp();
            let gain = weight * activation * phase;
            let information = self.forgetting.powf(activation) * self.information[i] + gain * phase;
            self.information[i] = information;
            if information > 0.0 {
                for (k, target) in target.iter().enumerate() {
                    let error = target - self.weights[(i, k)] * phase;
                    self.weights[(i, k)] += gain / information * error;
                }
            }
        }
        Ok(())
    }

    /// Returns the weights W of Eq. (2), n × d; zero where no sample was within reach of a basis.
    #[must_use]
    pub fn weights(&self) -> &DMatrix<f64> {
        &self.weights
    }

    /// Tells whether every basis has met a sample of some weight.
    #[must_use]
    pub fn is_determined(&self) -> bool {
        self.information.iter().all(|information| *information > 0.0)
    }

    fn check(&self, phase: f64, target: &[f64], weight: f64) -> Result<(), SkillError> {
        let operation = "absorb sample";
        let refused =
            |argument, found, expected| Err(SkillError::InvalidArgument { operation, argument, found, expected });
        if target.len() != self.weights.ncols() {
            return Err(SkillError::Dimension { operation, found: target.len(), expected: self.weights.ncols() });
        }
        if let Some(found) = target.iter().find(|value| !value.is_finite()) {
            return refused("target", *found, "finite numbers");
        }
        if !(phase > 0.0 && phase <= 1.0) {
            return refused("phase", phase, "a number above 0 and at most 1");
        }
        if !(weight.is_finite() && weight >= 0.0) {
            return refused("weight", weight, "a finite number of at least 0");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::{DVector, dvector};

    use super::*;
    use crate::canonical::CanonicalSystem;
    use crate::regression::Lwr;

    /// Some thousand roundings.
    const ROUNDING: f64 = 1e-11;

    fn samples(count: usize) -> ForcingSamples {
        let phases = DVector::from_fn(count, |m, _| 0.01f64.powf(m as f64 / (count - 1) as f64));
        let targets = DMatrix::from_fn(count, 2, |m, k| ((3 + 4 * k) as f64 * phases[m]).sin() + 0.1 * (m % 3) as f64);
        let weights = DVector::from_fn(count, |m, _| 0.5 + (m % 5) as f64);
        ForcingSamples { phases, targets, weights }
    }

    fn basis(count: usize) -> GaussianBasis {
        GaussianBasis::uniform_in_time(count, CanonicalSystem::new(100f64.ln()), 0.5)
    }

    #[test]
    fn absorbing_all_samples_equals_the_batch() {
        for bases in [10, 50, 100] {
            let recursive = Recursive::default().fit(&samples(1000), &basis(bases)).unwrap();
            let batch = Lwr {}.fit(&samples(1000), &basis(bases)).unwrap();
            assert!((recursive - &batch).amax() < ROUNDING * batch.amax());
        }
    }

    #[test]
    fn the_order_of_the_samples_does_not_matter_without_forgetting() {
        let there = samples(300);
        let back = ForcingSamples {
            phases: DVector::from_fn(300, |m, _| there.phases[299 - m]),
            targets: DMatrix::from_fn(300, 2, |m, k| there.targets[(299 - m, k)]),
            weights: DVector::from_fn(300, |m, _| there.weights[299 - m]),
        };
        let [there, back] = [there, back].map(|samples| Recursive::default().fit(&samples, &basis(30)).unwrap());
        assert!((&there - back).amax() < ROUNDING * there.amax());
    }

    #[test]
    fn forgetting_prefers_the_later_of_two_contradicting_samples() {
        // at the center of basis 0 φ = 1: w = (ρF₁ + F₂)/((1 + ρ)s) with s = 1
        let mut fit = RecursiveFit::new(&Recursive { forgetting: 0.5 }, basis(2), 1).unwrap();
        fit.absorb(1.0, &[2.0], 1.0).unwrap();
        assert_relative_eq!(fit.weights()[(0, 0)], 2.0, max_relative = ROUNDING);
        fit.absorb(1.0, &[5.0], 1.0).unwrap();
        assert_relative_eq!(fit.weights()[(0, 0)], (0.5 * 2.0 + 5.0) / 1.5, max_relative = ROUNDING);
    }

    #[test]
    fn a_skill_that_changes_is_followed_only_with_forgetting() {
        let passes = |forgetting: f64| {
            let mut fit = RecursiveFit::new(&Recursive { forgetting }, basis(20), 1).unwrap();
            let phases = samples(200).phases;
            for gain in [[1.0; 10], [4.0; 10]].concat() {
                phases.iter().for_each(|phase| fit.absorb(*phase, &[gain * phase], 1.0).unwrap());
            }
            fit.weights().clone()
        };
        // without forgetting the two halves average; with it the second has replaced the first
        passes(1.0).iter().for_each(|weight| assert_relative_eq!(*weight, 2.5, max_relative = 1e-9));
        passes(0.9).iter().for_each(|weight| assert_relative_eq!(*weight, 4.0, max_relative = 1e-2));
    }

    #[test]
    fn bases_out_of_reach_of_every_sample_are_refused_in_a_batch_and_zero_on_line() {
        let lonely =
            ForcingSamples { phases: dvector![1.0], targets: DMatrix::repeat(1, 1, 2.0), weights: dvector![1.0] };
        let refused = Recursive::default().fit(&lonely, &basis(50));
        assert_eq!(refused, Err(SkillError::Undetermined { samples: 1, bases: 50 }));
        let mut fit = RecursiveFit::new(&Recursive::default(), basis(50), 1).unwrap();
        fit.absorb(1.0, &[2.0], 1.0).unwrap();
        assert_eq!(fit.weights()[(49, 0)], 0.0);
        assert!(!fit.is_determined());
    }

    #[test]
    fn bad_samples_are_refused_by_name_and_change_nothing() {
        let mut fit = RecursiveFit::new(&Recursive::default(), basis(5), 2).unwrap();
        let before = fit.clone();
        let mut named = |phase, target: &[f64], weight| match fit.absorb(phase, target, weight) {
            Err(SkillError::InvalidArgument { argument, .. }) => argument,
            other => panic!("{other:?}"),
        };
        assert_eq!(named(0.0, &[1.0, 1.0], 1.0), "phase");
        assert_eq!(named(f64::NAN, &[1.0, 1.0], 1.0), "phase");
        assert_eq!(named(0.5, &[1.0, f64::NAN], 1.0), "target");
        assert_eq!(named(0.5, &[1.0, 1.0], -1.0), "weight");
        assert!(matches!(fit.absorb(0.5, &[1.0], 1.0), Err(SkillError::Dimension { found: 1, expected: 2, .. })));
        assert_eq!(fit, before);
        assert!(Recursive { forgetting: 0.0 }.validate().is_err());
        assert!(Recursive { forgetting: 1.1 }.validate().is_err());
    }
}
