//! The canonical system, Eq. (3): the phase that replaces time in the forcing term.
//!
//! The paper integrates τṡ = −γs; here the closed form s = e^{−γt/τ} is evaluated, which has no integration error and
//! can be entered at any time.

/// Canonical system of Eq. (3), in closed form.
///
/// Progress is t/τ, without unit: 0 at the start, 1 at the end of the motion (τ = T), more than 1 while settling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CanonicalSystem {
    gamma: f64,
}

impl CanonicalSystem {
    /// Builds the system with the decay `gamma` (> 0, without unit).
    #[must_use]
    pub fn new(gamma: f64) -> Self {
        Self { gamma }
    }

    /// Returns the decay γ of Eq. (3), without unit.
    #[must_use]
    pub fn gamma(&self) -> f64 {
        self.gamma
    }

    /// Evaluates the phase s = e^{−γ·progress}, Eq. (3) with s(0) = 1.
    #[must_use]
    pub fn phase(&self, progress: f64) -> f64 {
        (-self.gamma * progress).exp()
    }

    /// Returns s(T) = e^{−γ}, the phase at the end of the motion.
    #[must_use]
    pub fn final_phase(&self) -> f64 {
        self.phase(1.0)
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    /// A few roundings.
    const ROUNDING: f64 = 1e-14;

    #[test]
    fn the_phase_is_one_at_the_start_and_a_hundredth_at_the_end() {
        let canonical = CanonicalSystem::new(100f64.ln());
        assert_eq!(canonical.phase(0.0), 1.0);
        assert_relative_eq!(canonical.final_phase(), 0.01, max_relative = ROUNDING);
        assert_relative_eq!(canonical.phase(0.5), 0.1, max_relative = ROUNDING);
    }

    #[test]
    fn the_phase_solves_equation_3() {
        let canonical = CanonicalSystem::new(3.0);
        let step = 1e-6;
        let slope = (canonical.phase(0.4 + step) - canonical.phase(0.4 - step)) / (2.0 * step);
        assert_relative_eq!(slope, -3.0 * canonical.phase(0.4), max_relative = 1e-9);
    }
}
