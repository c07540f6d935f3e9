//! Cooperative coupling: two motions that keep a relative position, as two arms that carry one object.

use serde::{Deserialize, Serialize};

use super::MotionState;
use crate::error::SkillError;
use crate::field::{FieldError, finite, not_negative};

/// Strength of a [`CooperativeCoupling`].
///
/// The defaults make the relative position critically damped for α = 25, which is (α + 2c)² = 4(αβ + 2k), and shrink a
/// lasting disagreement of the two motions to a fourteenth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CooperativeConfig {
    /// Stiffness k ≥ 0, without unit, to be compared with αβ = α²/4 of Eq. (1).
    pub stiffness: f64,
    /// Damping c ≥ 0, without unit, to be compared with α of Eq. (1).
    pub damping: f64,
}

impl Default for CooperativeConfig {
    fn default() -> Self {
        Self { stiffness: 1000.0, damping: 33.9 }
    }
}

impl CooperativeConfig {
    /// Checks the options.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to the options.
    pub fn validate(&self) -> Result<(), FieldError> {
        not_negative("stiffness", self.stiffness)?;
        not_negative("damping", self.damping)
    }
}

/// Spring and damper between two motions of d coordinates, Eq. (6): Δu₁ = k(x₂ − x₁ − r) + c(v₂ − v₁), Δu₂ = −Δu₁, with
/// r the relative position wanted and v = τẋ.
///
/// Δu₁ and Δu₂ are opposite, so of two motions of equal duration the mean moves as if uncoupled, while their difference
/// is drawn to r with the stiffness αβ + 2k: a lasting disagreement e of the two goals with r is left as e·αβ/(αβ + 2k).
/// The coupling is held over a step dt, so 2c·dt/τ and 2k(dt/τ)² must stay below one.
///
/// Sources: A. Gams et al., "Coupling movement primitives: interaction with the environment and bimanual tasks", IEEE
/// Transactions on Robotics 30(4), 2014, doi:10.1109/TRO.2014.2304775, whose force of a virtual spring enters at the
/// velocity and, as its derivative, at the acceleration; here both parts enter at the acceleration, where Eq. (6) has its
/// term, so that the velocity stays that of the motion.
#[derive(Debug, Clone, PartialEq)]
pub struct CooperativeCoupling {
    config: CooperativeConfig,
    separation: Vec<f64>,
}

impl CooperativeCoupling {
    /// Couples by `config` to keep x₂ − x₁ = `separation` (d values, unit and frame of the motions).
    ///
    /// # Errors
    /// If an option is out of range, or the separation is empty or not finite.
    pub fn new(config: CooperativeConfig, separation: Vec<f64>) -> Result<Self, SkillError> {
        config.validate()?;
        finite("separation", &separation)?;
        if separation.is_empty() {
            return Err(SkillError::Dimension { operation: "couple motions", found: 0, expected: 1 });
        }
        Ok(Self { config, separation })
    }

    /// Returns the number d of coordinates.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.separation.len()
    }

    /// Adds Δu₁ to `on_first` and Δu₂ to `on_second` (d values each) at the states of the two motions.
    pub fn add_to_pair(
        &self,
        first: &MotionState<'_>,
        second: &MotionState<'_>,
        on_first: &mut [f64],
        on_second: &mut [f64],
    ) {
        let CooperativeConfig { stiffness, damping } = self.config;
        let relative = |k: usize| second.position[k] - first.position[k];
        let rate = |k: usize| second.duration_s * second.velocity[k] - first.duration_s * first.velocity[k];
        for (k, separation) in self.separation.iter().enumerate() {
            let pull = stiffness * (relative(k) - separation) + damping * rate(k);
            on_first[k] += pull;
            on_second[k] -= pull;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pull_of_a_stretched_pair_is_that_of_a_spring_and_a_damper() {
        let config = CooperativeConfig { stiffness: 10.0, damping: 3.0 };
        let coupling = CooperativeCoupling::new(config, vec![1.0, 0.0]).unwrap();
        let state = |position, velocity, duration_s| MotionState { position, velocity, elapsed_s: 0.0, duration_s };
        let (first, second) = (state(&[0.0, 0.0], &[0.0, 0.5], 2.0), state(&[1.5, -1.0], &[1.0, 0.0], 4.0));
        let (mut on_first, mut on_second) = ([7.0, 0.0], [0.0, 0.0]);
        coupling.add_to_pair(&first, &second, &mut on_first, &mut on_second);
        // k(1.5 − 1) + c(4·1 − 0), k(−1) + c(0 − 2·0.5), added to what was there
        assert_eq!(on_first, [7.0 + 17.0, -13.0]);
        assert_eq!(on_second, [-17.0, 13.0]);
    }

    #[test]
    fn options_out_of_range_are_refused_by_name() {
        let field = |config: CooperativeConfig| match CooperativeCoupling::new(config, vec![0.0]) {
            Err(SkillError::InvalidConfig(error)) => error.field,
            other => panic!("{other:?}"),
        };
        assert_eq!(field(CooperativeConfig { stiffness: -1.0, ..CooperativeConfig::default() }), "stiffness");
        assert_eq!(field(CooperativeConfig { damping: f64::NAN, ..CooperativeConfig::default() }), "damping");
        assert!(CooperativeCoupling::new(CooperativeConfig::default(), vec![f64::NAN]).is_err());
        assert!(CooperativeCoupling::new(CooperativeConfig::default(), vec![]).is_err());
    }
}
