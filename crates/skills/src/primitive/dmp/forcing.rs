//! The forcing term f(s) = WᵀΨ(s) of Eq. (2) over the progress of a motion.
//!
//! Departs from the paper at the end of the motion: nothing was demonstrated past T, where the term would go on as
//! s·w_n, so it fades over the twentieth of the duration after T; over the twentieth before T where a demonstration ends
//! in motion, for otherwise the primitive overshoots its goal by the demonstrated end speed.

use nalgebra::{DMatrix, DVector};

use crate::basis::GaussianBasis;
use crate::canonical::CanonicalSystem;
use crate::time_law::minimum_jerk;

/// Part of the duration over which the forcing term fades.
const FADE: f64 = 0.05;

/// Learned forcing term of d coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ForcingTerm {
    pub(super) canonical: CanonicalSystem,
    pub(super) basis: GaussianBasis,
    /// W, n × d.
    pub(super) weights: DMatrix<f64>,
    /// Whether the term has faded to zero at T already, not only a little later.
    pub(super) fades_before_end: bool,
}

impl ForcingTerm {
    /// Evaluates f at `progress` = t/τ into `forcing` (d values), with `activations` (n values) as scratch; allocates
    /// nothing.
    pub(super) fn evaluate_into(&self, progress: f64, activations: &mut DVector<f64>, forcing: &mut DVector<f64>) {
        let gate = self.gate(progress);
        if gate == 0.0 {
            forcing.fill(0.0);
            return;
        }
        let active = self.basis.activate_active(self.canonical.phase(progress), activations.as_mut_slice());
        let activations = activations.as_slice();
        let columns = self.weights.as_slice().chunks_exact(activations.len());
        for (forcing, weights) in forcing.iter_mut().zip(columns) {
            let terms = weights[active.clone()].iter().zip(&activations[active.clone()]);
            *forcing = gate * terms.map(|(weight, activation)| weight * activation).sum::<f64>();
        }
    }

    fn gate(&self, progress: f64) -> f64 {
        let begin = if self.fades_before_end { 1.0 - FADE } else { 1.0 };
        1.0 - minimum_jerk((progress - begin) / FADE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn constant(fades_before_end: bool) -> ForcingTerm {
        let canonical = CanonicalSystem::new(1.0);
        let basis = GaussianBasis::uniform_in_time(3, canonical, 0.5);
        ForcingTerm { canonical, basis, weights: DMatrix::repeat(3, 1, 2.0), fades_before_end }
    }

    fn at(term: &ForcingTerm, progress: f64) -> f64 {
        let (mut activations, mut forcing) = (DVector::zeros(3), DVector::zeros(1));
        term.evaluate_into(progress, &mut activations, &mut forcing);
        forcing[0]
    }

    #[test]
    fn equal_weights_give_a_term_proportional_to_the_phase() {
        for progress in [0.0, 0.4, 1.0] {
            approx::assert_relative_eq!(at(&constant(false), progress), 2.0 * (-progress).exp(), max_relative = 1e-13);
        }
    }

    #[test]
    fn a_term_fades_over_the_twentieth_after_the_end() {
        let half = (-1.025f64).exp();
        approx::assert_relative_eq!(at(&constant(false), 1.025), half, max_relative = 1e-12);
        assert_eq!(at(&constant(false), 1.06), 0.0);
    }

    #[test]
    fn a_term_that_fades_before_the_end_is_whole_until_the_last_twentieth() {
        assert_eq!(at(&constant(true), 0.95), at(&constant(false), 0.95));
        approx::assert_relative_eq!(at(&constant(true), 0.975), (-0.975f64).exp(), max_relative = 1e-12);
        assert_eq!(at(&constant(true), 1.0), 0.0);
        assert_eq!(at(&constant(true), 1.3), 0.0);
    }
}
