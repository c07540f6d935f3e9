//! Why a motion or plan in space was refused.

use thiserror::Error;

use crate::error::SkillError;
use crate::field::FieldError;

/// States why a motion or plan in space was refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SpatialError {
    /// Too few knots, or they do not begin at 0 s.
    #[error(
        "build track: found {found} knots, the first at {first_s} s; expected at least 2 from 0 s on; give both ends"
    )]
    Knots {
        /// Knots found.
        found: usize,
        /// Time of the first, s; NaN without any.
        first_s: f64,
    },
    /// A knot has a number that is not finite.
    #[error(
        "build track: knot {row} ({time_s} s) has a number that is not finite; expected finite ones; mend that knot"
    )]
    NonFinite {
        /// Index of the knot, from 0.
        row: usize,
        /// Its time, s.
        time_s: f64,
    },
    /// Times do not increase.
    #[error("build track: knot {row} is at {time_s} s; expected later than the one before; drop repeated knots")]
    TimesNotIncreasing {
        /// Index of the knot, from 0.
        row: usize,
        /// Its time, s.
        time_s: f64,
    },
    /// The tool turns too far between two knots.
    #[error(
        "build track: the tool turns by {turn_rad:.3} rad up to knot {row}; expected at most {largest_rad} rad; add knots"
    )]
    FastTurn {
        /// Index of the knot after the turn, from 0.
        row: usize,
        /// Angle between the knots, rad.
        turn_rad: f64,
        /// Largest angle accepted, rad.
        largest_rad: f64,
    },
    /// A plan without actions.
    #[error("chain actions: found none; expected at least 1; add one")]
    NoActions,
    /// Two actions do not meet.
    #[error(
        "chain actions: from '{before}' to '{after}' at {time_s:.3} s the {quantity} jumps by {found:.3e} {unit}; expected \
         at most {limit:.3e} {unit}; let the second begin as the first ends"
    )]
    Joint {
        /// Name of the action that ends.
        before: String,
        /// Name of the action that begins.
        after: String,
        /// Time of the plan, s.
        time_s: f64,
        /// What jumps.
        quantity: &'static str,
        /// Unit of the jump.
        unit: &'static str,
        /// The jump.
        found: f64,
        /// Largest one accepted.
        limit: f64,
    },
    /// The tool leaves the workspace.
    #[error(
        "verify plan: '{action}' leaves the workspace by {beyond_m:.4} m along {axis} at {time_s:.3} s; expected to stay \
         inside; move what it works on, or widen workspace_m"
    )]
    Workspace {
        /// Name of the action.
        action: String,
        /// Axis of the world: x, y or z.
        axis: char,
        /// How far beyond the box, m.
        beyond_m: f64,
        /// Time of the plan, s.
        time_s: f64,
    },
    /// A rate is above its limit.
    #[error(
        "verify plan: '{action}' reaches {found:.4} {unit} of {quantity} at {time_s:.3} s; expected at most {limit:.4} {unit}; \
         give it more time, or raise the limit"
    )]
    Rate {
        /// Name of the action.
        action: String,
        /// What is too large.
        quantity: &'static str,
        /// Unit.
        unit: &'static str,
        /// Certified upper bound of it.
        found: f64,
        /// The limit.
        limit: f64,
        /// Time of the plan, s.
        time_s: f64,
    },
    /// An option or argument cannot be used.
    #[error(transparent)]
    Skill(#[from] SkillError),
}

impl From<FieldError> for SpatialError {
    fn from(error: FieldError) -> Self {
        Self::Skill(error.into())
    }
}
