//! The sigmoid maps between a corridor and the unconstrained coordinate, Eqs. (16)–(20): their contract, and the list
//! of kinds.
//!
//! Departs from the paper: the constants of Proposition 1 reverse or leave their range for a part of all motions, and
//! do not exist for a standing corridor as printed. The default is a family of maps that is strictly increasing, keeps
//! both ends and exists for every motion; Eqs. (18)–(20) are kept as printed and in a form that is solved correctly.
//!
//! A further kind is one file with an implementation of [`CorridorMap`], and its lines in this one.

mod as_published;
mod closed_form;
mod ends;
mod logistic;
mod logit_family;
mod m_form;
mod proximal;
mod validity;

use std::fmt;

use serde::{Deserialize, Serialize};

pub use as_published::{AsPublished, PublishedMap};
pub use closed_form::{ClosedForm, Fallback, NormalForm};
pub use ends::MotionEnds;
pub use logistic::{extended_logit, logistic, logit};
pub use logit_family::LogitFamily;
pub use m_form::MForm;
pub use proximal::Proximal;
pub use validity::Validity;

use crate::corridor::Bounds;
use crate::error::SkillError;
use crate::field::FieldError;

/// What is attempted, for errors.
const OPERATION: &str = "build corridor map";

/// Map of one coordinate of one motion between its corridor and the unconstrained coordinate x^u.
///
/// Contract: a pure function of its arguments, free of allocation; `bounds` are those at the same instant, with a
/// positive width; `progress` is time over duration, 0 at the start and 1 at the goal. Positions have the unit of the
/// bounds. NaN in gives NaN out.
pub trait CorridorMap: fmt::Debug + Send + Sync {
    /// Evaluates Eq. (17): the unconstrained coordinate of the position `x`.
    ///
    /// Finite for every finite `x`, also on and outside the bounds; only [`PublishedMap`] is NaN or infinite there.
    fn unconstrained(&self, bounds: &Bounds, progress: f64, x: f64) -> f64;

    /// Evaluates Eq. (16): the position of the unconstrained coordinate `unconstrained`.
    ///
    /// Strictly inside the bounds for every number; only [`PublishedMap`] may round onto one.
    fn constrained(&self, bounds: &Bounds, progress: f64, unconstrained: f64) -> f64;
}

/// Map of a motion as a configuration selected it.
#[derive(Debug)]
pub struct SelectedMap {
    /// The map.
    pub map: Box<dyn CorridorMap>,
    /// Why it is not the one asked for, if it is not.
    pub fallback: Option<Fallback>,
}

/// Kinds of map, as a table in a file: `map.proximal.strength = 0.05` or `map.closed_form = {}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum CorridorMapConfig {
    /// x plus a log-barrier correction: close to the identity away from the bounds (default).
    Proximal(Proximal),
    /// The logit about the middle of the corridor: Eq. (17) with k = 4/W.
    MForm(MForm),
    /// The constants of Proposition 1, solved without singularity, where they are valid; else
    /// [`CorridorMapConfig::MForm`].
    ClosedForm(ClosedForm),
    /// Eqs. (18)–(20) as printed, for comparison only: the ends are not kept.
    AsPublished(AsPublished),
}

impl Default for CorridorMapConfig {
    fn default() -> Self {
        Self::Proximal(Proximal::default())
    }
}

impl CorridorMapConfig {
    /// Builds the map of this kind for one coordinate of one motion, Proposition 1.
    ///
    /// `delta`, above 0 and at most a quarter, is the share of the width next to each bound in which Eq. (17) is
    /// continued by its tangent; [`MotionEnds::delta`] chooses it. [`CorridorMapConfig::AsPublished`] ignores it.
    ///
    /// # Errors
    /// If an end point is not finite, the corridor has no width at an end, or `delta` or a strength is outside its
    /// range; for [`CorridorMapConfig::AsPublished`] also if Eqs. (18)–(20) have no finite value.
    pub fn map(&self, ends: &MotionEnds, delta: f64) -> Result<SelectedMap, SkillError> {
        ends.check()?;
        check_delta(delta)?;
        let only = |map: Box<dyn CorridorMap>| SelectedMap { map, fallback: None };
        Ok(match self {
            Self::Proximal(proximal) => only(Box::new(proximal.map(ends, delta)?)),
            Self::MForm(m_form) => only(Box::new(m_form.map(ends, delta)?)),
            Self::ClosedForm(closed_form) => match closed_form.map(ends, delta) {
                Ok(map) => only(Box::new(map)),
                Err(reason) => {
                    SelectedMap { map: Box::new(MForm::default().map(ends, delta)?), fallback: Some(reason) }
                }
            },
            Self::AsPublished(as_published) => only(Box::new(as_published.map(ends)?)),
        })
    }

    /// Returns the name of the kind as written in a file.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Proximal(_) => "proximal",
            Self::MForm(_) => "m_form",
            Self::ClosedForm(_) => "closed_form",
            Self::AsPublished(_) => "as_published",
        }
    }

    /// Checks the options of the kind.
    ///
    /// # Errors
    /// A [`FieldError`] with a field such as `proximal.strength`.
    pub fn validate(&self) -> Result<(), FieldError> {
        let checked = match self {
            Self::Proximal(proximal) => proximal.validate(),
            Self::MForm(m_form) => m_form.validate(),
            Self::ClosedForm(closed_form) => closed_form.validate(),
            Self::AsPublished(as_published) => as_published.validate(),
        };
        checked.map_err(|error| error.within(self.name()))
    }
}

fn check(argument: &'static str, found: f64, holds: bool, expected: &'static str) -> Result<(), SkillError> {
    if holds { Ok(()) } else { Err(SkillError::InvalidArgument { operation: OPERATION, argument, found, expected }) }
}

fn check_delta(delta: f64) -> Result<(), SkillError> {
    check("delta", delta, delta > 0.0 && delta <= 0.25, "a number above 0 and at most 0.25")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(config: &CorridorMapConfig) -> String {
        config.validate().unwrap_err().field
    }

    fn ends(start: f64, goal: f64) -> MotionEnds {
        let bounds = Bounds::still(0.0, 1.0);
        MotionEnds { start, start_bounds: bounds, goal, goal_bounds: bounds }
    }

    #[test]
    fn the_defaults_are_valid_and_an_invalid_option_is_named_by_its_path() {
        assert_eq!(CorridorMapConfig::default().validate(), Ok(()));
        assert_eq!(CorridorMapConfig::ClosedForm(ClosedForm::default()).validate(), Ok(()));
        assert_eq!(CorridorMapConfig::AsPublished(AsPublished::default()).validate(), Ok(()));
        assert_eq!(field(&CorridorMapConfig::Proximal(Proximal { strength: 0.0 })), "proximal.strength");
        assert_eq!(field(&CorridorMapConfig::MForm(MForm { strength: f64::NAN })), "m_form.strength");
        let limits = ClosedForm { min_steepness: 2.0, max_steepness: 1.0 };
        assert_eq!(field(&CorridorMapConfig::ClosedForm(limits)), "closed_form.max_steepness");
        let sigmas = AsPublished { sigma1: 0.0, ..AsPublished::default() };
        assert_eq!(field(&CorridorMapConfig::AsPublished(sigmas)), "as_published.sigma1");
    }

    #[test]
    fn a_kind_is_a_table_and_a_misspelled_key_is_refused() {
        let parsed: CorridorMapConfig = serde_json::from_str(r#"{"proximal": {}}"#).unwrap();
        assert_eq!(parsed, CorridorMapConfig::default());
        let parsed: CorridorMapConfig = serde_json::from_str(r#"{"closed_form": {"max_steepness": 20}}"#).unwrap();
        assert_eq!(parsed.name(), "closed_form");
        assert!(serde_json::from_str::<CorridorMapConfig>(r#"{"m_form": {"strenght": 1}}"#).is_err());
        assert!(serde_json::from_str::<CorridorMapConfig>(r#"{"sigmoid": {}}"#).is_err());
    }

    #[test]
    fn ends_and_deltas_that_make_no_map_are_refused_by_name() {
        let named = |ends: &MotionEnds, delta: f64| match CorridorMapConfig::default().map(ends, delta) {
            Err(SkillError::InvalidArgument { argument, .. }) => argument,
            other => panic!("{other:?}"),
        };
        assert_eq!(named(&ends(f64::NAN, 0.5), 0.01), "start");
        assert_eq!(named(&ends(0.5, f64::INFINITY), 0.01), "goal");
        assert_eq!(named(&MotionEnds { goal_bounds: Bounds::still(1.0, 1.0), ..ends(0.5, 0.5) }, 0.01), "goal_width");
        assert_eq!(named(&ends(0.5, 0.5), 0.0), "delta");
        assert_eq!(named(&ends(0.5, 0.5), 0.3), "delta");
        assert_eq!(named(&ends(0.5, 0.5), f64::NAN), "delta");
    }

    #[test]
    fn the_published_constants_of_an_end_on_a_bound_are_refused() {
        let as_published = CorridorMapConfig::AsPublished(AsPublished::default());
        let refused = as_published.map(&ends(0.0, 0.5), 0.01);
        assert!(matches!(refused, Err(SkillError::InvalidArgument { argument: "k", .. })), "{refused:?}");
    }
}
