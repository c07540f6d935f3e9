//! The law of Eqs. (29) and (32) as printed, for comparison.

use serde::{Deserialize, Serialize};

use super::{AxisLaw, AxisSample, AxisTask, CorridorFilter};
use crate::field::{FieldError, not_negative, positive};
use crate::time_law::PathState;

/// Published law, Eq. (32): Δu^c = αβz₁ + (ατ − τ)ż₁ − (k_z + 1/(τ(h̄ − h̲)²))·z₂/k_n, with λ = τẋ^u − z₁ + (h̄ + h̲)/2.
///
/// With Eq. (29) it is exactly τ²z̈₁ + (1 + K)τż₁ + K(z₁ − (h̄ + h̲)/2) = 0, K = (k_z + 1/(τ(h̄ − h̲)²))/k_n: linear, so no
/// barrier, towards the middle of the corridor, with the poles −1/τ and −K/τ; α, β and f^u cancel.
///
/// The paper does not say how it integrates: here semi-implicit Euler steps, velocity first, as usual for (29). A step
/// diverges from K·h/τ = 2 on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Published {
    /// k_n > 0 of Eq. (31), per s and squared unit of the skill; 1 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub k_n: f64,
    /// k_z ≥ 0 of Eq. (32), "a tiny positive number", unit of k_n; 1e-3 by default.
    #[schemars(range(min = 0.0))]
    pub k_z: f64,
    /// α of Eq. (29), without unit, β = α/4; 25 by default. It cancels.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub alpha: f64,
}

impl Default for Published {
    fn default() -> Self {
        Self { k_n: 1.0, k_z: 1e-3, alpha: 25.0 }
    }
}

impl Published {
    /// Evaluates λ below Eq. (31) as printed.
    #[must_use]
    pub fn virtual_velocity(&self, duration_s: f64, at: &AxisSample, position: f64) -> f64 {
        // −z₁ + (h̄ + h̲)/2 = −(x^N − x^u) + M − x^u
        duration_s * at.skill.first - position + at.bounds.middle().position
    }

    /// Evaluates Δu^c of Eq. (32) as printed.
    #[must_use]
    pub fn additional_term(&self, duration_s: f64, at: &AxisSample, motion: PathState) -> f64 {
        let z1 = motion.position - at.skill.position;
        let z1_rate = motion.first - at.skill.first;
        let z2 = duration_s * motion.first - self.virtual_velocity(duration_s, at, motion.position);
        let width = at.bounds.width().position;
        let gain = self.k_z + 1.0 / (duration_s * width * width);
        0.25 * self.alpha * self.alpha * z1 + (self.alpha - 1.0) * duration_s * z1_rate - gain * z2 / self.k_n
    }

    // ẍ^N by (29), with f^u of (21) and therefore without the goal
    fn acceleration(&self, duration_s: f64, at: &AxisSample, motion: PathState) -> f64 {
        let z1 = motion.position - at.skill.position;
        let z1_rate = motion.first - at.skill.first;
        let attraction = self.alpha * (0.25 * self.alpha * z1 + duration_s * z1_rate);
        let term = self.additional_term(duration_s, at, motion);
        at.skill.second + (term - attraction) / (duration_s * duration_s)
    }
}

impl CorridorFilter for Published {
    fn begin(&self, task: &AxisTask, first: &AxisSample) -> (Box<dyn AxisLaw>, PathState) {
        let law = PublishedAxis { options: self.clone(), duration_s: task.duration_s };
        let motion = PathState { position: task.start, first: first.skill.first, second: 0.0 };
        let second = self.acceleration(task.duration_s, first, motion);
        (Box::new(law), PathState { second, ..motion })
    }

    fn validate(&self) -> Result<(), FieldError> {
        positive("k_n", self.k_n)?;
        not_negative("k_z", self.k_z)?;
        positive("alpha", self.alpha)
    }
}

#[derive(Debug)]
struct PublishedAxis {
    options: Published,
    duration_s: f64,
}

impl AxisLaw for PublishedAxis {
    fn step(&mut self, motion: PathState, to: &AxisSample, time_step_s: f64) -> PathState {
        let moved = semi_implicit(motion, time_step_s);
        PathState { second: self.options.acceleration(self.duration_s, to, moved), ..moved }
    }
}

/// Steps velocity, then position, under the acceleration of `motion` (semi-implicit Euler).
pub(super) fn semi_implicit(motion: PathState, time_step_s: f64) -> PathState {
    let first = motion.first + time_step_s * motion.second;
    PathState { position: motion.position + time_step_s * first, first, second: motion.second }
}
