//! A dynamic movement primitive put together from weights that are known already: mixed from others, or saved.

use nalgebra::DMatrix;

use super::Dmp;
use super::attractor::Attractor;
use super::config::DmpConfig;
use super::forcing::ForcingTerm;
use crate::basis::GaussianBasis;
use crate::canonical::CanonicalSystem;
use crate::error::SkillError;
use crate::trajectory::check_finite;

impl Dmp {
    /// Puts `weights` (n × d) under the bases and the attractor of `config`; how the demonstrations ended is told by
    /// `end_speed` and `fades_before_end`, see the getters of these names.
    ///
    /// # Errors
    /// If `config` is invalid, the weights have not one row per basis, no column or a value that is not finite, or the
    /// speed is not a finite number of at least 0.
    pub(in crate::primitive) fn assemble(
        config: &DmpConfig,
        weights: DMatrix<f64>,
        end_speed: f64,
        fades_before_end: bool,
    ) -> Result<Self, SkillError> {
        config.validate()?;
        let operation = "assemble primitive";
        if weights.nrows() != config.bases {
            let expected = format!("{}, one per basis", config.bases);
            return Err(SkillError::RowCount { operation, found: weights.nrows(), expected });
        }
        if weights.ncols() == 0 {
            return Err(SkillError::Dimension { operation, found: 0, expected: 1 });
        }
        check_finite(operation, &weights)?;
        if !(end_speed.is_finite() && end_speed >= 0.0) {
            let expected = "a finite number of at least 0";
            return Err(SkillError::InvalidArgument { operation, argument: "end_speed", found: end_speed, expected });
        }
        let canonical = CanonicalSystem::new(config.gamma);
        let basis = GaussianBasis::uniform_in_time(config.bases, canonical, config.crossing());
        Ok(Self {
            form: config.form,
            attractor: Attractor::new(config.alpha),
            forcing: ForcingTerm { canonical, basis, weights, fades_before_end },
            end_speed,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trajectory::Trajectory;

    #[test]
    fn a_primitive_put_together_from_its_own_parts_is_the_same() {
        let wave = DMatrix::from_fn(101, 2, |row, k| (row as f64 * 0.05 * (k + 1) as f64).sin());
        let config = DmpConfig::default();
        let learned = Dmp::learn(&config, &[Trajectory::uniform(0.01, wave).unwrap()]).unwrap();
        let (speed, fades) = (learned.end_speed(), learned.fades_before_end());
        assert_eq!(Dmp::assemble(&config, learned.weights().clone(), speed, fades).unwrap(), learned);
    }

    #[test]
    fn parts_that_do_not_fit_are_refused() {
        let config = DmpConfig { bases: 3, ..DmpConfig::default() };
        let assemble = |weights, speed| Dmp::assemble(&config, weights, speed, false);
        assert!(matches!(assemble(DMatrix::zeros(2, 1), 0.0), Err(SkillError::RowCount { found: 2, .. })));
        assert!(matches!(assemble(DMatrix::zeros(3, 0), 0.0), Err(SkillError::Dimension { .. })));
        assert!(matches!(assemble(DMatrix::repeat(3, 1, f64::NAN), 0.0), Err(SkillError::NonFinite { .. })));
        assert!(matches!(assemble(DMatrix::zeros(3, 1), f64::NAN), Err(SkillError::InvalidArgument { .. })));
    }
}
