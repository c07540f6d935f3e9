//! Why nothing could be learned, and why there is no plan.

use crate::error::SkillError;
use crate::separation::constraint_based::ConstraintError;

/// Why demonstrations teach no tool use.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LearnError {
    /// No demonstration shows a push that can be learned from.
    #[error(
        "learn skills: found no push in {found} demonstrations{reasons}; expected one in which the tool moves the object; \
         record both in one frame, the tool's axes along the frame's"
    )]
    NoPush {
        /// Number of demonstrations.
        found: usize,
        /// Names and reasons of those that were left out, in brackets; empty if there are none.
        reasons: String,
    },
    /// The intention could not be separated from the tool's constraints.
    #[error(transparent)]
    Intention(#[from] ConstraintError),
    /// A primitive could not be learned.
    #[error(transparent)]
    Skill(#[from] SkillError),
}

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// The demonstrated surfaces cannot push the object to the goal.
    #[error(
        "plan push: the goal needs {length_m:.4} m of push with the surface '{surface}'; expected at least 0, since a \
         surface cannot pull; choose another goal, or demonstrate with a surface that faces the other way"
    )]
    Pull {
        /// Name of the surface.
        surface: String,
        /// Length that it would have to push, m.
        length_m: f64,
    },
    /// The demonstrated surfaces do not span the displacement.
    #[error(
        "plan push: the demonstrated surfaces miss the goal by {miss_m:.4} m; expected directions that add up to the \
         displacement; demonstrate a push in the missing direction"
    )]
    Directions {
        /// What is left of the displacement, m.
        miss_m: f64,
    },
    /// The object is where it is wanted.
    #[error(
        "plan push: the object starts {distance_m:.4} m from its goal; expected at least {least_m:.4} m, the shortest \
         push; choose another start or goal"
    )]
    AtGoal {
        /// Distance of the start from the goal, m.
        distance_m: f64,
        /// Shortest push, m.
        least_m: f64,
    },
    /// The skills use a surface that the tool does not have.
    #[error(
        "plan push: the skills push with surface {surface} (from 0) of their tool; the tool '{tool}' has {surfaces}; give \
         it that surface, or demonstrate with it"
    )]
    Surface {
        /// Index of the surface.
        surface: usize,
        /// Name of the tool.
        tool: String,
        /// Number of surfaces that the tool has.
        surfaces: usize,
    },
    /// A skill could not be rolled out.
    #[error(transparent)]
    Skill(#[from] SkillError),
}
