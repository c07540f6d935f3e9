//! Filters that keep a generalized skill inside a corridor, Eqs. (29)–(32), and the certificate of what they did.
//!
//! Departs from the paper: the law (32) does not keep the motion inside the corridor (Theorem 1 replaces a gain by a
//! smaller one and takes moving bounds for fixed), leads to the middle of the corridor instead of the skill, and is left
//! with a part 1/e of its slow mode at t = τ. It is kept as [`Published`]; the default is [`Logit`].
//!
//! | kind | guarantee at samples | leads to | acceleration | needs |
//! |---|---|---|---|---|
//! | [`Logit`] (default) | strictly inside for every step and every bounds, also jumping ones | the skill, exactly it and its goal where it lies well inside | what the corridor demands: highest | x^u, bounds, two derivatives of both for the acceleration only |
//! | [`Logit`] without feed-forward | as above | a low-pass of the skill; its goal in the end | lower | as above |
//! | [`Ecbf`] sampled | inside, by its position row; bends out between long steps | the skill, touching the bounds | lowest | bounds one step ahead, C¹ |
//! | [`Ecbf`] plain | none (inside for small steps and a slow start) | the skill | lowest | second derivatives of the bounds |
//! | [`TheoremOne`] transformed | strictly inside for every step | the middle of the corridor, whatever the skill | low | second derivatives of the bounds |
//! | [`TheoremOne`] explicit | none (inside for small steps) | the middle of the corridor | low | second derivatives of the bounds |
//! | [`OriginalReconstruction`] | none (inside for small steps) | the skill, saturated | middle | second derivatives of skill and bounds |
//! | [`Published`] | none: leaves about as often as an unfiltered skill | the middle of the corridor, slowly | that of the skill | bounds |
//!
//! All of them work axis by axis on position bounds; none bounds velocity or acceleration. [`Certificate`] tells for each
//! motion what came of it, between the samples too.
//!
//! A further kind is one file with implementations of [`CorridorFilter`] and [`AxisLaw`], and its lines in this one.

mod axis;
pub mod barrier;
mod certificate;
mod constraining;
mod coupling;
mod ecbf;
mod logit;
mod original;
mod published;
mod refusal;
mod saturation;
mod theorem_one;

use std::fmt;

use serde::{Deserialize, Serialize};

pub use axis::{AxisFilter, AxisSample, AxisTask};
pub use certificate::{AxisCertificate, Certificate, Margin, certify};
pub use constraining::{Constrained, FilterRequest, constrain};
pub use coupling::{additional_term, skill_forcing};
pub use ecbf::{Ecbf, EcbfForm};
pub use logit::Logit;
pub use original::OriginalReconstruction;
pub use published::Published;
pub use refusal::FilterError;
pub use saturation::SmoothSaturation;
pub use theorem_one::{Integration, TheoremOne};

use crate::field::FieldError;
use crate::time_law::PathState;

/// Law that keeps one coordinate of a motion inside a corridor, with its options.
///
/// Contract: deterministic; what it begins starts at the task's start exactly.
pub trait CorridorFilter: fmt::Debug + Send + Sync {
    /// Begins a motion of one coordinate: returns the law in its first state, and x^N there. The start lies inside the
    /// bounds of `first`, and all numbers are finite.
    fn begin(&self, task: &AxisTask, first: &AxisSample) -> (Box<dyn AxisLaw>, PathState);

    /// Checks the options.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to the options.
    fn validate(&self) -> Result<(), FieldError>;
}

/// Law of one coordinate in progress.
///
/// Contract: a step allocates nothing; a law that fails yields numbers that are not finite or far outside, which
/// [`AxisFilter`] reports.
pub trait AxisLaw: fmt::Debug + Send + Sync {
    /// Advances x^N by `time_step_s` (> 0) from `motion` to the time of `to`.
    fn step(&mut self, motion: PathState, to: &AxisSample, time_step_s: f64) -> PathState;
}

/// Kinds of corridor filter, as a table in a file: `corridor_filter.logit.margin = 0.15`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum CorridorFilterConfig {
    /// Constrained primitive in the logit of the place in the corridor (default).
    Logit(Logit),
    /// Eqs. (29) and (32) as printed.
    Published(Published),
    /// A reconstruction of the law that (32) abridges.
    OriginalReconstruction(OriginalReconstruction),
    /// Theorem 1, corrected.
    TheoremOne(TheoremOne),
    /// Exponential control barrier function.
    Ecbf(Ecbf),
}

impl Default for CorridorFilterConfig {
    fn default() -> Self {
        Self::Logit(Logit::default())
    }
}

impl CorridorFilterConfig {
    /// Returns the filter of this kind.
    #[must_use]
    pub fn filter(&self) -> &dyn CorridorFilter {
        match self {
            Self::Logit(filter) => filter,
            Self::Published(filter) => filter,
            Self::OriginalReconstruction(filter) => filter,
            Self::TheoremOne(filter) => filter,
            Self::Ecbf(filter) => filter,
        }
    }

    /// Returns the name of the kind as written in a file.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Logit(_) => "logit",
            Self::Published(_) => "published",
            Self::OriginalReconstruction(_) => "original_reconstruction",
            Self::TheoremOne(_) => "theorem_one",
            Self::Ecbf(_) => "ecbf",
        }
    }

    /// Checks the options of the kind.
    ///
    /// # Errors
    /// A [`FieldError`] with a field such as `logit.margin`.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.filter().validate().map_err(|error| error.within(self.name()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_the_logit_law_and_options_are_named_by_their_path() {
        let parsed: CorridorFilterConfig = serde_json::from_str(r#"{"logit": {}}"#).unwrap();
        assert_eq!(parsed, CorridorFilterConfig::default());
        assert_eq!(parsed.validate(), Ok(()));
        for (text, field) in [
            (r#"{"logit": {"margin": 0.6}}"#, "logit.margin"),
            (r#"{"published": {"k_n": 0.0}}"#, "published.k_n"),
            (r#"{"original_reconstruction": {"epsilon": 0.0}}"#, "original_reconstruction.epsilon"),
            (r#"{"theorem_one": {"k_lambda": -1.0}}"#, "theorem_one.k_lambda"),
            (r#"{"ecbf": {"rate_1": -1.0}}"#, "ecbf.rate_1"),
        ] {
            let config: CorridorFilterConfig = serde_json::from_str(text).unwrap();
            assert_eq!(config.validate().unwrap_err().field, field);
        }
        assert!(serde_json::from_str::<CorridorFilterConfig>(r#"{"logit": {"m": 0.3}}"#).is_err());
    }

    #[test]
    fn every_kind_is_written_under_its_name() {
        let kinds = [
            CorridorFilterConfig::default(),
            CorridorFilterConfig::Published(Published::default()),
            CorridorFilterConfig::OriginalReconstruction(OriginalReconstruction::default()),
            CorridorFilterConfig::TheoremOne(TheoremOne::default()),
            CorridorFilterConfig::Ecbf(Ecbf::default()),
        ];
        for kind in kinds {
            let written = serde_json::to_value(&kind).unwrap();
            assert!(written.get(kind.name()).is_some(), "{written}");
            assert_eq!(kind.validate(), Ok(()));
        }
    }
}
