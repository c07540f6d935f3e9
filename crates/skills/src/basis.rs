//! The normalized Gaussian basis functions of Eq. (2) and where they stand.
//!
//! The paper leaves centers and widths open. Centers here are uniform in time (c_i = e^{−γi/(n−1)}), not in phase, and a
//! width is told by the level at which neighbors cross: with centers uniform in phase the end of a motion has no bases.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use crate::canonical::CanonicalSystem;

/// Exponent beyond the smallest from which a basis counts as zero: e^{−60} is far below the rounding of the sum.
pub(crate) const NEGLIGIBLE: f64 = 60.0;

/// Gaussian basis functions φ_i(s) = exp(−h_i(s − c_i)²) of Eq. (2).
#[derive(Debug, Clone, PartialEq)]
pub struct GaussianBasis {
    crossing: f64,
    centers: DVector<f64>,
    widths: DVector<f64>,
}

impl GaussianBasis {
    /// Places `count` (≥ 2) bases uniformly in time over the motion; each crosses its later neighbor at the height
    /// `crossing`, in (0, 1).
    ///
    /// h_i = −ln(crossing)/(d_i/2)² with d_i = |c_{i+1} − c_i|, the last distance repeated.
    #[must_use]
    pub fn uniform_in_time(count: usize, canonical: CanonicalSystem, crossing: f64) -> Self {
        let last = count.saturating_sub(1).max(1);
        let center = |i: usize| canonical.phase(i as f64 / last as f64);
        let centers = DVector::from_fn(count, |i, _| center(i));
        let widths = DVector::from_fn(count, |i, _| {
            let i = i.min(last - 1);
            let half = 0.5 * (center(i + 1) - center(i));
            -crossing.ln() / (half * half)
        });
        Self { crossing, centers, widths }
    }

    /// Returns the number n of bases.
    #[must_use]
    pub fn count(&self) -> usize {
        self.centers.len()
    }

    /// Returns the height, in (0, 1), at which neighbors cross.
    #[must_use]
    pub fn crossing(&self) -> f64 {
        self.crossing
    }

    /// Returns the centers c_i in phase, n values, falling.
    #[must_use]
    pub fn centers(&self) -> &DVector<f64> {
        &self.centers
    }

    /// Returns the widths h_i, n values, 1/phase².
    #[must_use]
    pub fn widths(&self) -> &DVector<f64> {
        &self.widths
    }

    /// Returns −ln φ_i(s) of basis `i` (< n), which never underflows.
    #[must_use]
    pub fn exponent(&self, i: usize, phase: f64) -> f64 {
        let distance = phase - self.centers[i];
        self.widths[i] * distance * distance
    }

    /// Finds the bases that are not negligible at `phase`, which are neighbors: those above e^{−60} of the largest.
    #[must_use]
    pub fn active(&self, phase: f64) -> Range<usize> {
        self.band(phase).0
    }

    // the active bases and the smallest exponent
    fn band(&self, phase: f64) -> (Range<usize>, f64) {
        // by the placement of centers and widths the exponents fall up to the phase and rise beyond it, so the smallest is
        // one of the two about the phase
        let after = self.centers.as_slice().partition_point(|center| *center > phase);
        let about = after.saturating_sub(1)..self.count().min(after + 1);
        let smallest = about.map(|i| self.exponent(i, phase)).fold(f64::INFINITY, f64::min);
        let negligible = |i: &usize| self.exponent(*i, phase) - smallest >= NEGLIGIBLE;
        let first = (0..after).rev().find(negligible).map_or(0, |i| i + 1);
        let end = (after..self.count()).find(negligible).unwrap_or(self.count());
        (first..end, smallest)
    }

    /// Evaluates the active part of Ψ(s) of Eq. (2), ψ_i = φ_i s/Σφ, without allocating: writes `activations[i]` for i in
    /// the range that is returned (see [`GaussianBasis::active`]) and leaves the others alone.
    ///
    /// All exponents are taken relative to the smallest, so that the quotient exists for every phase, also past the last
    /// center where each φ_i underflows.
    ///
    /// # Panics
    /// If `activations` has not n values.
    pub fn activate_active(&self, phase: f64, activations: &mut [f64]) -> Range<usize> {
        assert_eq!(activations.len(), self.count(), "one activation is written per basis");
        let (active, smallest) = self.band(phase);
        let mut sum = 0.0;
        for i in active.clone() {
            activations[i] = (smallest - self.exponent(i, phase)).exp();
            sum += activations[i];
        }
        let scale = phase / sum;
        activations[active.clone()].iter_mut().for_each(|activation| *activation *= scale);
        active
    }

    /// Evaluates Ψ(s) of Eq. (2), ψ_i = φ_i s/Σφ, into `activations` (n values) without allocating; those that are not
    /// active are zero.
    ///
    /// # Panics
    /// If `activations` has not n values.
    pub fn activate_into(&self, phase: f64, activations: &mut DVector<f64>) {
        activations.fill(0.0);
        self.activate_active(phase, activations.as_mut_slice());
    }

    /// Evaluates Ψ of Eq. (2) at each of M phases; returns M × n.
    #[must_use]
    pub fn design_matrix(&self, phases: &DVector<f64>) -> DMatrix<f64> {
        let mut row = DVector::zeros(self.count());
        let mut design = DMatrix::zeros(phases.len(), self.count());
        for (m, phase) in phases.iter().enumerate() {
            self.activate_into(*phase, &mut row);
            design.row_mut(m).tr_copy_from(&row);
        }
        design
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::*;

    /// A few roundings, magnified by the exponential of arguments of order ten.
    const ROUNDING: f64 = 1e-12;

    fn ten() -> GaussianBasis {
        GaussianBasis::uniform_in_time(10, CanonicalSystem::new(100f64.ln()), 0.7)
    }

    #[test]
    fn neighbors_cross_halfway_at_the_given_level() {
        let basis = ten();
        for i in 0..9 {
            let halfway = 0.5 * (basis.centers()[i] + basis.centers()[i + 1]);
            assert_relative_eq!((-basis.exponent(i, halfway)).exp(), 0.7, max_relative = ROUNDING);
        }
    }

    #[test]
    fn centers_are_equally_spaced_in_time() {
        let basis = ten();
        for i in 1..9 {
            let ratio = basis.centers()[i + 1] / basis.centers()[i];
            assert_relative_eq!(ratio, basis.centers()[1], max_relative = ROUNDING);
        }
    }

    #[test]
    fn activations_exist_where_every_gaussian_underflows() {
        let basis = GaussianBasis::uniform_in_time(1000, CanonicalSystem::new(100f64.ln()), 0.5);
        let mut activations = DVector::zeros(1000);
        basis.activate_into(1e-6, &mut activations);
        assert!((-basis.exponent(999, 1e-6)).exp() == 0.0);
        assert_relative_eq!(activations.sum(), 1e-6, max_relative = ROUNDING);
    }

    #[test]
    fn few_of_many_bases_are_active() {
        let canonical = CanonicalSystem::new(100f64.ln());
        for (crossing, most) in [(0.5, 11), (0.7, 15)] {
            let basis = GaussianBasis::uniform_in_time(50, canonical, crossing);
            let count = |progress: f64| basis.active(canonical.phase(progress)).len();
            assert!((0..100).all(|k| count(f64::from(k) / 100.0) <= most));
        }
    }

    // Ψ by Eq. (2) as written, over all bases
    fn by_definition(basis: &GaussianBasis, phase: f64) -> DVector<f64> {
        let heights = DVector::from_fn(basis.count(), |i, _| (-basis.exponent(i, phase)).exp());
        &heights * (phase / heights.sum())
    }

    proptest! {
        #[test]
        fn active_bases_are_those_that_are_not_negligible(
            count in 2usize..200, gamma in 0.1f64..20.0, crossing in 0.01f64..0.99, progress in -0.1f64..1.2,
        ) {
            let canonical = CanonicalSystem::new(gamma);
            let basis = GaussianBasis::uniform_in_time(count, canonical, crossing);
            let phase = canonical.phase(progress);
            let exponents: Vec<f64> = (0..count).map(|i| basis.exponent(i, phase)).collect();
            let smallest = exponents.iter().copied().fold(f64::INFINITY, f64::min);
            let above: Vec<usize> = (0..count).filter(|i| exponents[*i] - smallest < NEGLIGIBLE).collect();
            prop_assert_eq!(basis.active(phase).collect::<Vec<_>>(), above);
            // where no Gaussian of the definition underflows
            if (0.0..=1.0).contains(&progress) {
                let mut activations = DVector::zeros(count);
                basis.activate_into(phase, &mut activations);
                prop_assert!((activations - by_definition(&basis, phase)).amax() <= ROUNDING * phase);
            }
        }

        #[test]
        fn activations_add_up_to_the_phase(phase in 1e-9f64..1.0) {
            let basis = ten();
            let mut activations = DVector::zeros(10);
            basis.activate_into(phase, &mut activations);
            prop_assert!((activations.sum() - phase).abs() <= ROUNDING * phase);
        }
    }
}
