//! Why a pour was not learned or planned.

use thiserror::Error;

use crate::corridor_filter::FilterError;
use crate::error::SkillError;
use crate::field::FieldError;
use crate::primitive::pose::PoseError;
use crate::separation::constraint_based::ConstraintError;
use crate::spatial::SpatialError;

/// States why a pour was not learned or planned.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PourError {
    /// The demonstration does not pour.
    #[error(
        "learn pour: the cup tilts by {tilt_rad:.3} rad; expected at least {least_rad:.3} rad after an approach; record all of the pour"
    )]
    NotTilted {
        /// Greatest tilt found, rad.
        tilt_rad: f64,
        /// Least tilt expected, rad.
        least_rad: f64,
    },
    /// The mouth is too narrow for the lip.
    #[error(
        "plan pour: the mouth's radius is {radius_m:.4} m; expected more than {least_m:.4} m for the lip to stay over it; \
         lower lip_margin_m, or put a funnel on it"
    )]
    MouthTooNarrow {
        /// Radius of the mouth, m.
        radius_m: f64,
        /// Least radius, m.
        least_m: f64,
    },
    /// The lip cannot be near the mouth when the flow may begin.
    #[error(
        "plan pour: at the onset of {onset_rad:.3} rad the cup clears the rim only with its lip {gap_m:.4} m above it; expected \
         at most {largest_m:.4} m; take a cup with a spout or less fill, or raise largest_gap_m"
    )]
    TooHigh {
        /// Tilt at the onset, rad.
        onset_rad: f64,
        /// Height of the lip above the rim, m.
        gap_m: f64,
        /// Largest height accepted, m.
        largest_m: f64,
    },
    /// The cup stands in the way of its own approach.
    #[error(
        "plan pour: the cup stands {distance_m:.4} m from where its approach ends; expected at least {least_m:.4} m; put it \
         farther from the mouth or tell another direction_rad"
    )]
    TooNear {
        /// Distance of the start from the end of the approach, m.
        distance_m: f64,
        /// Least distance, m.
        least_m: f64,
    },
    /// Cup and rim are not certified to keep clear.
    #[error(
        "plan pour: in '{action}' the cup {}, sampled {sampled_m:.4} m at {time_s:.2} s; expected at least {least_m:.4} m; raise margin_m or gap_m, or tell another direction_rad",
        certified(*clearance_m)
    )]
    NotClear {
        /// Name of the action.
        action: String,
        /// Certified clearance, m; −∞ where the search gave up.
        clearance_m: f64,
        /// Clearance found, m.
        sampled_m: f64,
        /// Time of the action, s.
        time_s: f64,
        /// Clearance expected, m.
        least_m: f64,
    },
    /// The filtered motion is not certified to stay inside its corridor.
    #[error(
        "plan pour: the {motion} is certified to a margin of {margin:.2e} in its corridor; expected more than 0; take the \
         default corridor_filter"
    )]
    NotInside {
        /// What moves.
        motion: &'static str,
        /// Smallest margin.
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

impl From<FieldError> for PourError {
    fn from(error: FieldError) -> Self {
        Self::Skill(error.into())
    }
}

/// What is certified of a clearance, m; −∞ where the search gave up.
fn certified(clearance_m: f64) -> String {
    if clearance_m.is_finite() {
        format!("is certified to {clearance_m:.4} m of the rim only")
    } else {
        "is not certified to keep any distance from the rim".into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_that_gave_up_is_told_in_words_and_not_as_infinity() {
        let refused = |clearance_m| PourError::NotClear {
            action: "approach".into(),
            clearance_m,
            sampled_m: 0.001,
            time_s: 1.5,
            least_m: 0.005,
        };
        let told = refused(f64::NEG_INFINITY).to_string();
        assert!(
            told.contains("the cup is not certified to keep any distance from the rim, sampled 0.0010 m"),
            "{told}"
        );
        assert!(refused(0.002).to_string().contains("the cup is certified to 0.0020 m of the rim only, sampled"));
    }
}
