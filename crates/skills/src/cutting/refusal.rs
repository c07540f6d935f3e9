//! Why a cut was not learned or planned.

use thiserror::Error;

use crate::corridor_filter::FilterError;
use crate::error::SkillError;
use crate::field::FieldError;
use crate::primitive::pose::PoseError;
use crate::separation::constraint_based::ConstraintError;
use crate::spatial::SpatialError;

/// States why a cut was not learned or planned.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CutError {
    /// What was shown does not cut the section that was told.
    #[error(
        "learn cut: the knife reaches {depth_m:.4} m below the top of the food; expected the board at {height_m:.4} m, but \
         for {tolerance_m:.4} m; check the pose and height of the section"
    )]
    NotThrough {
        /// Greatest depth of the knife, m.
        depth_m: f64,
        /// Height of the food, m.
        height_m: f64,
        /// Distance from the board accepted, m.
        tolerance_m: f64,
    },
    /// The demonstration has no approach, cut or withdrawal.
    #[error(
        "learn cut: no {phase} was shown; expected the knife to begin and end above the food; record all of the cut"
    )]
    Phase {
        /// The phase that is missing.
        phase: &'static str,
    },
    /// The knife is not in the plane of the section.
    #[error(
        "learn cut: in the cut the {coordinate} is {mean:.4} {unit} off the section on average; expected at most \
         {largest:.4} {unit}; check the pose of the section and the axes of the tool's frame"
    )]
    OutOfPlane {
        /// Name of the coordinate.
        coordinate: &'static str,
        /// Mean deviation.
        mean: f64,
        /// Largest mean accepted.
        largest: f64,
        /// Unit.
        unit: &'static str,
    },
    /// The edge is too short to cut without draw.
    #[error(
        "plan cut {cut}: the usable edge of {usable_m:.4} m does not cover the food's {width_m:.4} m and the stroke has no \
         draw; expected a longer edge; take another knife or a stroke with slice.ratio"
    )]
    TooShortToPress {
        /// Index of the section, from 0.
        cut: usize,
        /// Usable length of the edge, m.
        usable_m: f64,
        /// Width of the food, m.
        width_m: f64,
    },
    /// The edge is far too short.
    #[error(
        "plan cut {cut}: the usable edge of {usable_m:.4} m is too short to saw the food's {width_m:.4} m; expected at least \
         {least_m:.4} m; take another knife"
    )]
    TooShort {
        /// Index of the section, from 0.
        cut: usize,
        /// Usable length of the edge, m.
        usable_m: f64,
        /// Width of the food, m.
        width_m: f64,
        /// Least usable length, m.
        least_m: f64,
    },
    /// The belly would have to roll too far.
    #[error(
        "plan cut {cut}: the belly has to roll by {roll_rad:.3} rad to cut the whole width; expected at most \
         {largest_rad:.3} rad; take a flatter knife or raise largest_rock_rad"
    )]
    BellyTooRound {
        /// Index of the section, from 0.
        cut: usize,
        /// Angle needed, rad.
        roll_rad: f64,
        /// Largest angle, rad.
        largest_rad: f64,
    },
    /// A stroke takes more passes than make sense.
    #[error(
        "plan cut {cut}: {found} strokes to and fro are needed; expected at most {most}; lower slice.ratio or take a longer edge"
    )]
    TooManyStrokes {
        /// Index of the section, from 0.
        cut: usize,
        /// Strokes needed.
        found: f64,
        /// Most strokes.
        most: f64,
    },
    /// The filtered stroke is not certified to stay inside its corridor.
    #[error(
        "plan cut {cut}: the {coordinate} is certified to {margin:.2e} of its corridor only; expected more than 0; take the \
         default corridor_filter or widen the limits"
    )]
    NotCertified {
        /// Index of the section, from 0.
        cut: usize,
        /// Name of the coordinate.
        coordinate: &'static str,
        /// Smallest margin, in depths of the stroke or rad.
        margin: f64,
    },
    /// Refused by the separation of the skill.
    #[error(transparent)]
    Constraint(#[from] ConstraintError),
    /// Refused by the corridor filter.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// Refused as a pose trajectory.
    #[error(transparent)]
    Pose(#[from] PoseError),
    /// Refused as a motion in space.
    #[error(transparent)]
    Spatial(#[from] SpatialError),
    /// Refused as a configuration or table of samples.
    #[error(transparent)]
    Skill(#[from] SkillError),
}

impl From<FieldError> for CutError {
    fn from(error: FieldError) -> Self {
        Self::Skill(error.into())
    }
}
