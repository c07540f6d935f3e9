//! Why a skill could not be constrained.

use crate::error::SkillError;

/// Why a skill could not be constrained to a corridor.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilterError {
    /// The motion would start outside the corridor.
    #[error(
        "constrain skill: coordinate {coordinate} starts at {start}, {excess} outside the corridor from {lower} to \
         {upper}; expected a start between the bounds; move the start, or widen the corridor there"
    )]
    StartOutside {
        /// Index of the coordinate, from 0.
        coordinate: usize,
        /// The start, in the unit of the skill.
        start: f64,
        /// Distance from the bound that is passed, in the unit of the skill.
        excess: f64,
        /// Lower bound at the start.
        lower: f64,
        /// Upper bound at the start.
        upper: f64,
    },
    /// The corridor has no width at some time.
    #[error(
        "constrain skill: the corridor of coordinate {coordinate} is {width} wide at {time_s} s; expected more than 0 at \
         all times, also between samples; widen it, or smooth it with a least width"
    )]
    Closed {
        /// Index of the coordinate, from 0.
        coordinate: usize,
        /// Time, s.
        time_s: f64,
        /// Width W there; not above 0, or not a number.
        width: f64,
    },
    /// The law diverged.
    #[error(
        "constrain skill: coordinate {coordinate} diverged at {time_s} s; expected to stay near the corridor; take a \
         shorter time step, other gains, or the default filter"
    )]
    Diverged {
        /// Index of the coordinate, from 0.
        coordinate: usize,
        /// Time of the first sample that is not finite, or further than a million widths from the corridor, s.
        time_s: f64,
    },
    /// An argument, an option or a sample is not usable.
    #[error(transparent)]
    Skill(#[from] SkillError),
}
