//! Why an obstacle term could not be identified.

use crate::error::SkillError;

/// Why γ and β of an obstacle term could not be identified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IdentificationError {
    /// No demonstration has an obstacle that turns it.
    #[error(
        "identify obstacle term: found no sample that an obstacle acts on; expected a demonstration that moves past a \
         known obstacle; add one, or learn the primitive without separation"
    )]
    NoObstacle,
    /// The forcing term can imitate the obstacle term.
    #[error(
        "identify obstacle term: the forcing term imitates it but for a part sin² = {found:.1e}; expected at least \
         {expected:.1e}; add an obstacle-free demonstration or one past another obstacle"
    )]
    NotIdentifiable {
        /// Least sin²θ found.
        found: f64,
        /// Least sin²θ accepted.
        expected: f64,
    },
    /// The demonstrations turn toward their obstacles.
    #[error(
        "identify obstacle term: the demonstrations turn toward their obstacles (gamma = {gamma:.3}, beta = {beta:.3} per \
         rad); expected gamma above 0; check the obstacles' positions and frame"
    )]
    Attracted {
        /// Gain found, without unit, at most 0.
        gamma: f64,
        /// Decay found, 1/rad.
        beta: f64,
    },
    /// The best decay lies at the edge of the range searched.
    #[error(
        "identify obstacle term: the best beta is {beta:.4} per rad; expected one inside ({least}, {greatest}); widen \
         least_beta and greatest_beta, or check that the demonstrations avoid their obstacles"
    )]
    AtEdge {
        /// Decay found, 1/rad.
        beta: f64,
        /// Least decay searched, 1/rad.
        least: f64,
        /// Greatest decay searched, 1/rad.
        greatest: f64,
    },
    /// The turn grows with the angle to the obstacle.
    #[error(
        "identify obstacle term: beta is {beta:.3} per rad; expected at least 0, a turn that fades with the angle; check the \
         obstacles' positions, or use identification = \"variable_projection\""
    )]
    NegativeDecay {
        /// Decay found, 1/rad.
        beta: f64,
    },
    /// The obstacle term found explains less than none.
    #[error(
        "identify obstacle term: the term found leaves {residual:.3e} of the forcing targets unexplained (root mean \
         square); expected at most {residual_without:.3e}, what no term leaves; use identification = \
         \"variable_projection\""
    )]
    Misfit {
        /// Root mean square left with the term found, unit of the demonstrations.
        residual: f64,
        /// Root mean square left without a term, unit of the demonstrations.
        residual_without: f64,
    },
    /// Too few logarithms exist for the regression of Eq. (14).
    #[error(
        "identify obstacle term: {used} equations are left in round {round} and {lost} lost to logarithms of numbers that \
         are not positive; expected at least 2 at different angles; use identification = \"variable_projection\""
    )]
    EquationsLost {
        /// Round at fault, from 0.
        round: usize,
        /// Equations left.
        used: usize,
        /// Equations lost.
        lost: usize,
    },
    /// The rounds of Eq. (14) ran away.
    #[error(
        "identify obstacle term: the parameters overflow in round {round}; expected them to converge; lower eta, or use \
         identification = \"variable_projection\""
    )]
    Diverged {
        /// Round at fault, from 0.
        round: usize,
    },
    /// The samples could not be used or the skill not be learned.
    #[error(transparent)]
    Skill(#[from] SkillError),
}
