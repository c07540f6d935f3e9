//! The additional term Δu^c of Eq. (29) that belongs to a motion, and the forcing term of the skill under it.

use crate::time_law::PathState;

/// Evaluates the additional term Δu^c that Eq. (29) needs for the motion x^N: Δu^c = τ²ẍ^N − α(β(g − x^N) − τẋ^N) − f^u.
///
/// β = α/4; `duration_s` is τ; `goal` g and `forcing` f^u are those of the skill, in its unit.
#[must_use]
pub fn additional_term(alpha: f64, duration_s: f64, goal: f64, forcing: f64, motion: PathState) -> f64 {
    skill_forcing(alpha, duration_s, goal, motion) - forcing
}

/// Evaluates the forcing term f^u that Eq. (21) needs for the skill x^u: f^u = τ²ẍ^u − α(β(g − x^u) − τẋ^u).
#[must_use]
pub fn skill_forcing(alpha: f64, duration_s: f64, goal: f64, skill: PathState) -> f64 {
    let attraction = alpha * (0.25 * alpha * (goal - skill.position) - duration_s * skill.first);
    duration_s * duration_s * skill.second - attraction
}
