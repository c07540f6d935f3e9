//! The errors of this crate: one enum, its values as fields, so that a caller can word or locate them anew.

use thiserror::Error;

use crate::field::FieldError;

/// States why an operation of this crate was refused; the text is a lower-case fragment that fits after a prefix.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SkillError {
    /// A configuration value lies outside its range.
    #[error("check configuration: {0}")]
    InvalidConfig(#[from] FieldError),
    /// An argument of a call lies outside its range.
    #[error("{operation}: {argument} is {found}; expected {expected}; pass another {argument}")]
    InvalidArgument {
        /// What was attempted.
        operation: &'static str,
        /// Name of the argument, with its unit as suffix.
        argument: &'static str,
        /// The value found.
        found: f64,
        /// The range expected.
        expected: &'static str,
    },
    /// A recording tells nothing for so long that what happened would have to be invented.
    #[error(
        "read demonstration: the {part} was not recorded for {gap_s:.3} s, from {from_s:.3} s on; expected at most {largest_s} s \
         between two rows; record without a pause"
    )]
    RecordingGap {
        /// What was not recorded: the tool or the object.
        part: &'static str,
        /// Length of the gap, s.
        gap_s: f64,
        /// Where it begins, s.
        from_s: f64,
        /// Longest gap accepted, s.
        largest_s: f64,
    },
    /// A table of samples has the wrong number of rows.
    #[error("{operation}: found {found} rows; expected {expected}; give one row per instant")]
    RowCount {
        /// What was attempted.
        operation: &'static str,
        /// Rows found.
        found: usize,
        /// Rows expected, in words.
        expected: String,
    },
    /// A vector or table has the wrong number of coordinates.
    #[error("{operation}: found {found} coordinates; expected {expected}; give one value per coordinate")]
    Dimension {
        /// What was attempted.
        operation: &'static str,
        /// Coordinates found.
        found: usize,
        /// Coordinates expected.
        expected: usize,
    },
    /// A sample is not a finite number.
    #[error("{operation}: row {row}, column {column} is {found}; expected a finite number; mend or drop that row")]
    NonFinite {
        /// What was attempted.
        operation: &'static str,
        /// Row of the sample, from 0.
        row: usize,
        /// Column of the sample, from 0.
        column: usize,
        /// The value found.
        found: f64,
    },
    /// The times of a trajectory do not increase strictly.
    #[error(
        "check trajectory: time {time_s} s of row {row} follows {previous_s} s; expected strictly increasing finite \
         times; drop repeated rows"
    )]
    TimesNotIncreasing {
        /// Row at fault, from 0.
        row: usize,
        /// Time of the row before, s (the row's own time if it is the first).
        previous_s: f64,
        /// Time of the row, s.
        time_s: f64,
    },
    /// Two trajectories to be joined do not meet.
    #[error(
        "join motions: the ends are {gap:.4} apart (m, or rad of an angle); expected at most {largest_gap:.4}; move the \
         second one or allow a larger gap"
    )]
    Gap {
        /// Euclidean distance of the two ends, in the unit of the samples.
        gap: f64,
        /// Largest distance allowed, in the unit of the samples.
        largest_gap: f64,
    },
    /// There is nothing to learn from.
    #[error("learn primitive: found 0 demonstrations; expected at least 1; record or load one")]
    NoDemonstrations,
    /// A demonstration has another dimension than the first.
    #[error(
        "learn primitive: demonstration {demonstration} has {found} coordinates; expected {expected} as in \
         demonstration 0; learn them apart"
    )]
    DemonstrationDimension {
        /// Index of the demonstration, from 0.
        demonstration: usize,
        /// Its coordinates.
        found: usize,
        /// Coordinates of the first demonstration.
        expected: usize,
    },
    /// The scaled forcing term cannot be learned where a demonstration ends at its start.
    #[error(
        "learn primitive: demonstration {demonstration} displaces coordinate {coordinate} by {displacement} only; \
         expected more than {smallest} to scale its forcing term by; use form = \"residual\""
    )]
    NoDisplacement {
        /// Index of the demonstration, from 0.
        demonstration: usize,
        /// Index of the coordinate, from 0.
        coordinate: usize,
        /// Goal minus start, in the unit of the samples.
        displacement: f64,
        /// Smallest displacement accepted, in the unit of the samples.
        smallest: f64,
    },
    /// The normal equations of a regression are not positive definite.
    #[error(
        "fit weights: {samples} samples leave {bases} bases undetermined; expected positive definite normal \
         equations; raise lambda or use fewer bases"
    )]
    Undetermined {
        /// Number of samples.
        samples: usize,
        /// Number of bases.
        bases: usize,
    },
    /// A coupling Δu of Eq. (6) is not a finite number.
    #[error(
        "evaluate coupling {coupling}: it makes coordinate {coordinate} of the sum {found}; expected a finite number; \
         mend or drop that coupling"
    )]
    NonFiniteCoupling {
        /// Index of the coupling in the list that was given, from 0.
        coupling: usize,
        /// Coordinate at fault, from 0.
        coordinate: usize,
        /// The value found.
        found: f64,
    },
}
