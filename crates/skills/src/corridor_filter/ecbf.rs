//! The baseline with the lowest accelerations: an exponential control barrier function for each bound.
//!
//! Not in the paper. Source: Q. Nguyen and K. Sreenath, "Exponential control barrier functions for enforcing high
//! relative-degree safety-critical constraints", American Control Conference 2016, doi:10.1109/ACC.2016.7524935.

use serde::{Deserialize, Serialize};

use super::{AxisLaw, AxisSample, AxisTask, CorridorFilter};
use crate::corridor::Bounds;
use crate::field::{FieldError, positive};
use crate::time_law::PathState;

/// Distance from the bounds that the position row keeps, as a part of the width.
const INSET: f64 = 1e-3;
/// Largest bandwidth × step of the nominal tracking, below which its explicit steps do not ring.
const NOMINAL_RATIO: f64 = 0.5;

/// How the conditions are put to a sampled motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EcbfForm {
    /// ψ⁺ ≥ (1 − c₂h)ψ of the next sample, and the next position inside, which has priority (default).
    #[default]
    Sampled,
    /// The conditions of continuous time at the present sample, and an explicit Euler step.
    Plain,
}

/// Barrier filter: ẍ^N = the acceleration nearest to ẍ^u + (α/τ)(ẋ^u − ẋ^N) + (α²/4τ²)(x^u − x^N) with
/// ḧ + (c₁ + c₂)ḣ + c₁c₂h ≥ 0 for h = x − x^L and h = x^H − x.
///
/// In continuous time it keeps inside from any start with ψ = ḣ + c₁h ≥ 0, if Ẅ + (c₁ + c₂)Ẇ + c₁c₂W ≥ 0. The rates are
/// lowered to c₁ ≤ 2/h and c₂ ≤ 1/h for the sampled form with step h.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Ecbf {
    /// How the conditions are put to a sampled motion.
    pub form: EcbfForm,
    /// c₁ > 0, per s; 20 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub rate_1: f64,
    /// c₂ > 0, per s; 20 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub rate_2: f64,
    /// α of the nominal tracking, without unit; 25 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub alpha: f64,
}

impl Default for Ecbf {
    fn default() -> Self {
        Self { form: EcbfForm::Sampled, rate_1: 20.0, rate_2: 20.0, alpha: 25.0 }
    }
}

impl Ecbf {
    /// Evaluates the least and the greatest acceleration that both conditions of continuous time admit; crossed where
    /// they conflict.
    #[must_use]
    pub fn admitted(&self, bounds: &Bounds, motion: PathState) -> [f64; 2] {
        let (sum, product) = (self.rate_1 + self.rate_2, self.rate_1 * self.rate_2);
        [bounds.lower, bounds.upper].map(|bound| {
            bound.second - sum * (motion.first - bound.first) - product * (motion.position - bound.position)
        })
    }

    // acceleration that tracks the skill at bandwidth ω
    fn nominal(&self, skill: PathState, motion: PathState, bandwidth: f64) -> f64 {
        let (error, rate) = (skill.position - motion.position, skill.first - motion.first);
        skill.second + bandwidth * (2.0 * rate + bandwidth * error)
    }
}

impl CorridorFilter for Ecbf {
    fn begin(&self, task: &AxisTask, first: &AxisSample) -> (Box<dyn AxisLaw>, PathState) {
        let law = EcbfAxis { options: self.clone(), bandwidth: 0.5 * self.alpha / task.duration_s, present: *first };
        let motion = PathState { position: task.start, first: first.skill.first, second: 0.0 };
        let second = law.plain(motion);
        (Box::new(law), PathState { second, ..motion })
    }

    fn validate(&self) -> Result<(), FieldError> {
        positive("rate_1", self.rate_1)?;
        positive("rate_2", self.rate_2)?;
        positive("alpha", self.alpha)
    }
}

#[derive(Debug)]
struct EcbfAxis {
    options: Ecbf,
    bandwidth: f64,
    present: AxisSample,
}

impl AxisLaw for EcbfAxis {
    fn step(&mut self, motion: PathState, to: &AxisSample, time_step_s: f64) -> PathState {
        let moved = match self.options.form {
            EcbfForm::Sampled => {
                let second = self.sampled(motion, &to.bounds, time_step_s);
                let first = motion.first + time_step_s * second;
                PathState { position: motion.position + time_step_s * first, first, second }
            }
            EcbfForm::Plain => PathState {
                position: motion.position + time_step_s * motion.first,
                first: motion.first + time_step_s * motion.second,
                second: 0.0,
            },
        };
        self.present = *to;
        match self.options.form {
            EcbfForm::Sampled => moved,
            EcbfForm::Plain => PathState { second: self.plain(moved), ..moved },
        }
    }
}

impl EcbfAxis {
    fn plain(&self, motion: PathState) -> f64 {
        let [least, greatest] = self.options.admitted(&self.present.bounds, motion);
        self.options.nominal(self.present.skill, motion, self.bandwidth).max(least).min(greatest)
    }

    // acceleration over the step, which ends at the next bounds
    fn sampled(&self, motion: PathState, next: &Bounds, h: f64) -> f64 {
        let nominal = self.options.nominal(self.present.skill, motion, self.bandwidth.min(NOMINAL_RATIO / h));
        let (c1, c2) = (self.options.rate_1.min(2.0 / h), self.options.rate_2.min(1.0 / h));
        let coasting = motion.position + h * motion.first;
        // ψ⁺ = (v + ha − x̄̇⁺) + c₁(x + hv + h²a − x̄⁺) for the bound x̄, solved for a
        let condition = |now: PathState, next: PathState| {
            let psi = motion.first - now.first + c1 * (motion.position - now.position);
            let free = motion.first - next.first + c1 * (coasting - next.position);
            ((1.0 - c2 * h) * psi - free) / (h + c1 * h * h)
        };
        let present = &self.present.bounds;
        let (least, greatest) = (condition(present.lower, next.lower), condition(present.upper, next.upper));
        let inset = INSET * next.width().position;
        let row = |place: f64| (place - coasting) / (h * h);
        let (lowest, highest) = (row(next.lower.position + inset), row(next.upper.position - inset));
        nominal.max(least).min(greatest).max(lowest).min(highest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_skill_far_from_the_bounds_is_left_alone() {
        let filter = Ecbf::default();
        let skill = PathState { position: 0.0, first: 0.1, second: -0.3 };
        let first = AxisSample { skill, bounds: Bounds::still(-1.0, 1.0) };
        let task = AxisTask { coordinate: 0, start: 0.0, goal: 0.0, goal_bounds: first.bounds, duration_s: 1.0 };
        let (_, motion) = filter.begin(&task, &first);
        assert_eq!(motion, skill);
    }

    #[test]
    fn a_motion_on_the_bound_may_not_accelerate_across() {
        let at_bound = PathState { position: 1.0, ..PathState::default() };
        let [least, greatest] = Ecbf::default().admitted(&Bounds::still(-1.0, 1.0), at_bound);
        assert_eq!((least, greatest), (-800.0, 0.0));
    }
}
