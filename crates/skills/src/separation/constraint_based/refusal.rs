//! Why no skill is separated from demonstrations in corridors, and why none is generated in one.

use crate::error::SkillError;

/// Why Algorithm 2 was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConstraintError {
    /// More of a demonstration lies outside its corridor than noise explains: the bounds are wrong.
    #[error(
        "separate skill: {percent:.1} % of demonstration {demonstration} lies more than {tolerance:.4} outside in \
         coordinate {coordinate}, furthest row {row} at {time_s:.3} s by {outside:.4}; expected at most 2 %; widen the \
         bounds, shift their time, or state more noise"
    )]
    OutsideCorridor {
        /// Index of the demonstration, from 0.
        demonstration: usize,
        /// Index of the coordinate, from 0.
        coordinate: usize,
        /// Part of the samples that are outside by more than the tolerance, percent.
        percent: f64,
        /// Row of the sample that is furthest outside, from 0.
        row: usize,
        /// Time of that sample, s.
        time_s: f64,
        /// How far that sample is outside, in the unit of the samples.
        outside: f64,
        /// Three standard deviations of the noise, in the unit of the samples.
        tolerance: f64,
    },
    /// The map has no value for a sample.
    #[error(
        "separate skill: row {row} of demonstration {demonstration}, coordinate {coordinate}, is {position} between \
         bounds {lower} and {upper}, for which Eq. (17) as published has no finite value; expected a sample \
         strictly inside; choose another map"
    )]
    NoValue {
        /// Index of the demonstration, from 0.
        demonstration: usize,
        /// Row of the sample, from 0.
        row: usize,
        /// Index of the coordinate, from 0.
        coordinate: usize,
        /// The sample.
        position: f64,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// The start or goal of a motion to generate is not strictly inside its corridor.
    #[error(
        "generate constrained motion: the {end} is {position} in coordinate {coordinate}; expected strictly between \
         the bounds {lower} and {upper} there; move the {end} or widen the corridor"
    )]
    EndOutside {
        /// "start" or "goal".
        end: &'static str,
        /// Index of the coordinate, from 0.
        coordinate: usize,
        /// Position of that end.
        position: f64,
        /// Lower bound there.
        lower: f64,
        /// Upper bound there.
        upper: f64,
    },
    /// An argument is invalid, or the primitive could not be learned or rolled out.
    #[error(transparent)]
    Skill(#[from] SkillError),
}
