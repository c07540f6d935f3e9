//! A learned primitive as plain data, to be written to a file and read back.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::Dmp;
use super::config::{DmpConfig, DmpForm};
use crate::error::SkillError;
use crate::field::{FieldError, finite, not_negative};

/// Everything that defines a learned [`Dmp`].
///
/// What is restored rolls out to the same bits as what was saved, provided that the file keeps every digit of a number
/// and the machine evaluates the exponential alike.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedDmp {
    /// Form of Eq. (1) that the weights were learned in.
    pub form: DmpForm,
    /// Stiffness α of Eq. (1), without unit; β = α/4.
    pub alpha: f64,
    /// Decay γ of Eq. (3), without unit.
    pub gamma: f64,
    /// Height at which neighboring bases cross, between 0 and 1.
    pub overlap: f64,
    /// Weights W of Eq. (2): n rows, one per basis, of d values, unit of the demonstrations (without unit if the form is
    /// scaled).
    pub weights: Vec<Vec<f64>>,
    /// Whether the forcing term fades before the end of the motion, see [`Dmp::fades_before_end`].
    pub fades_before_end: bool,
    /// Greatest speed at which a demonstration ended, unit of the demonstrations per second.
    pub end_speed: f64,
}

impl Dmp {
    /// Copies what defines the primitive into plain data.
    #[must_use]
    pub fn saved(&self) -> SavedDmp {
        SavedDmp {
            form: self.form,
            alpha: self.attractor.alpha(),
            gamma: self.canonical().gamma(),
            overlap: self.basis().crossing(),
            weights: self.weights().row_iter().map(|row| row.iter().copied().collect()).collect(),
            fades_before_end: self.fades_before_end(),
            end_speed: self.end_speed,
        }
    }
}

impl SavedDmp {
    /// Restores the primitive.
    ///
    /// # Errors
    /// A [`SkillError::InvalidConfig`] that names the field if a number is not finite or outside the range it has in
    /// [`DmpConfig`], or the rows of the weights are not alike.
    pub fn restore(self) -> Result<Dmp, SkillError> {
        let dimension = self.validate()?;
        let (config, fades_before_end, end_speed) = (self.config(), self.fades_before_end, self.end_speed);
        let weights = DMatrix::from_row_iterator(config.bases, dimension, self.weights.into_iter().flatten());
        Dmp::assemble(&config, weights, end_speed, fades_before_end)
    }

    fn config(&self) -> DmpConfig {
        DmpConfig {
            form: self.form,
            bases: self.weights.len(),
            alpha: self.alpha,
            gamma: self.gamma,
            overlap: Some(self.overlap),
            ..DmpConfig::default()
        }
    }

    // returns the dimension
    fn validate(&self) -> Result<usize, FieldError> {
        let bases = self.weights.len();
        self.config().validate().map_err(|error| match error.field.as_str() {
            // here the bases are the rows of the weights
            "bases" => FieldError::new("weights", format!("{bases} rows"), "2 to 1000 rows, one per basis"),
            _ => error,
        })?;
        let dimension = self.weights.first().map_or(0, Vec::len);
        for (i, row) in self.weights.iter().enumerate() {
            let field = format!("weights[{i}]");
            if row.is_empty() || row.len() != dimension {
                let expected = format!("{}, as many in every row", dimension.max(1));
                return Err(FieldError::new(field, format!("{} values", row.len()), expected));
            }
            finite(&field, row)?;
        }
        not_negative("end_speed", self.end_speed)?;
        Ok(dimension)
    }
}
