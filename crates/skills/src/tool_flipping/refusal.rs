//! Why a tool flip could not be divided, learned or generalized.

use crate::error::SkillError;
use crate::field::FieldError;

/// States why an operation on a tool flip was refused; the text is a lower-case fragment that fits after a prefix.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FlipError {
    /// A factor is a quotient by a displacement that is zero.
    #[error(
        "solve factor: {displacement} is zero; expected a displacement that k1 can turn and scale; use the factor \
         identity and solve for the goal"
    )]
    NoDisplacement {
        /// The displacement, in words.
        displacement: &'static str,
    },
    /// The factor k1 cannot be divided by.
    #[error(
        "divide flip: k1 of condition {condition:e} has no inverse; expected an invertible k1; use the factor identity"
    )]
    Singular {
        /// Largest over smallest singular value.
        condition: f64,
    },
    /// Two primitives do not share attractor, phase, bases and form.
    #[error(
        "combine primitives: their forms, attractors, bases or ends differ; expected forcing terms of one phase; learn \
         both with one configuration, in another form than scaled"
    )]
    UnsharedSystem,
    /// A demonstration does not move.
    #[error(
        "learn flip: demonstration {demonstration} moves the object by 0 m in the tool's frame; expected a flip; drop it"
    )]
    Still {
        /// Index of the demonstration, from 0.
        demonstration: usize,
    },
    /// The object overlaps the tool where the flip starts or ends.
    #[error(
        "generalize flip: the object overlaps the tool by {depth_m:.2e} m at the {end} contact; expected at most \
         {tolerance_m:.2e} m; choose a contact with room for the object"
    )]
    ContactOverlaps {
        /// Which contact: `first` or `second`.
        end: &'static str,
        /// Depth of the overlap, m.
        depth_m: f64,
        /// Greatest depth allowed, m.
        tolerance_m: f64,
    },
    /// Along the normal of a contact there is no place that is free by the margin.
    #[error(
        "generalize flip: along the normal of the {end} contact the object gets {reached_m:.4} m clear of the tool; \
         expected {margin_m:.4} m; lower margin_m or choose another contact"
    )]
    NoRetreat {
        /// Which contact: `first` or `second`.
        end: &'static str,
        /// Clearance at the last place tried, m.
        reached_m: f64,
        /// Clearance wanted, m.
        margin_m: f64,
    },
    /// The way round the tool does not lead from one contact to the other.
    #[error(
        "generalize flip: the way round the tool passes the second contact at {miss_m:.4} m; expected to lead there; \
         lower margin_m, the contacts lie in hollows that do not connect"
    )]
    NoWayRound {
        /// Distance of the way from the place before the second contact, m.
        miss_m: f64,
    },
    /// No factor k2 keeps the object clear of the tool.
    #[error(
        "generalize flip: with k2 = {k2} the object comes to {clearance_m:.2e} m of the clearance required, at ratio \
         {at_ratio:.3} of the duration; expected at least {tolerance_m:.2e} m; raise margin_m or lower least_clearance_m"
    )]
    Collides {
        /// The last factor k2 tried.
        k2: f64,
        /// Certified clearance minus the clearance required, m.
        clearance_m: f64,
        /// Where, as time over duration.
        at_ratio: f64,
        /// The smallest value allowed, m: minus the tolerance at a contact.
        tolerance_m: f64,
    },
    /// An operation below was refused.
    #[error(transparent)]
    Skill(#[from] SkillError),
}

impl From<FieldError> for FlipError {
    fn from(error: FieldError) -> Self {
        Self::Skill(error.into())
    }
}
