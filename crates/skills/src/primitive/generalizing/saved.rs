//! The generalizing primitive as plain data, for files.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::Generalizing;
use super::config::GeneralizingConfig;
use super::leave_one_out::RuleScore;
use super::rule::Shown;
use crate::error::SkillError;
use crate::primitive::Dmp;
use crate::primitive::rollout::check_vector;

/// Everything a [`Generalizing`] primitive was learned to; restored, its rollouts are equal bit by bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedGeneralizing {
    /// Options it was learned with.
    pub config: GeneralizingConfig,
    /// Weights of each demonstration, n × d each.
    pub weights: Vec<DMatrix<f64>>,
    /// Goal minus start of each demonstration, d values each.
    pub displacements: Vec<DVector<f64>>,
    /// Length of the way of each demonstration, in the unit of its samples.
    pub path_lengths: Vec<f64>,
    /// The table of rules.
    pub scores: Vec<RuleScore>,
    /// Greatest speed at which a demonstration ended, unit of the demonstrations per second.
    pub end_speed: f64,
    /// Whether a demonstration ended in motion.
    pub fades_before_end: bool,
}

impl SavedGeneralizing {
    /// Checks the data and makes a primitive of them.
    ///
    /// # Errors
    /// If the options are invalid, tables differ in number or shape, a value is not finite, or the shares of the rules
    /// are not positive and add up to one.
    pub fn restore(self) -> Result<Generalizing, SkillError> {
        self.config.validate()?;
        let operation = "restore primitive";
        let dimension = self.weights.first().ok_or(SkillError::NoDemonstrations)?.ncols();
        for found in [self.displacements.len(), self.path_lengths.len()] {
            if found != self.weights.len() {
                let expected = format!("{}, one per demonstration", self.weights.len());
                return Err(SkillError::RowCount { operation, found, expected });
            }
        }
        for weights in &self.weights {
            Dmp::assemble(&self.config.dmp, weights.clone(), self.end_speed, self.fades_before_end)?;
            if weights.ncols() != dimension {
                return Err(SkillError::Dimension { operation, found: weights.ncols(), expected: dimension });
            }
        }
        for displacement in &self.displacements {
            check_vector("displacement", dimension, displacement.as_slice())?;
        }
        check_vector("path_length", self.weights.len(), &self.path_lengths)?;
        self.check_shares()?;
        let pairs = self.displacements.into_iter().zip(self.path_lengths);
        Ok(Generalizing {
            shown: pairs.map(|(displacement, path_length)| Shown { displacement, path_length }).collect(),
            config: self.config,
            weights: self.weights,
            scores: self.scores,
            end_speed: self.end_speed,
            fades_before_end: self.fades_before_end,
        })
    }

    fn check_shares(&self) -> Result<(), SkillError> {
        let refused = |found: f64, expected: &'static str| {
            Err(SkillError::InvalidArgument { operation: "restore primitive", argument: "share", found, expected })
        };
        for score in &self.scores {
            if !(0.0..=1.0).contains(&score.share) {
                return refused(score.share, "a number from 0 to 1");
            }
        }
        let sum: f64 = self.scores.iter().map(|score| score.share).sum();
        if (sum - 1.0).abs() > 1e-9 { refused(sum, "shares that add up to 1") } else { Ok(()) }
    }
}

impl Generalizing {
    /// Returns everything that was learned, as plain data.
    #[must_use]
    pub fn saved(&self) -> SavedGeneralizing {
        SavedGeneralizing {
            config: self.config.clone(),
            weights: self.weights.clone(),
            displacements: self.shown.iter().map(|shown| shown.displacement.clone()).collect(),
            path_lengths: self.shown.iter().map(|shown| shown.path_length).collect(),
            scores: self.scores.clone(),
            end_speed: self.end_speed,
            fades_before_end: self.fades_before_end,
        }
    }
}
