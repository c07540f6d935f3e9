//! A reconstruction of the constrained primitive that Eq. (32) abridges.
//!
//! The paper compares its law with an earlier one ("C-DMP") whose equations it does not repeat. What it names of it is
//! here: a reference point x^c, a state-dependent k_n and the derivative α̇₂. The rest is the tracking law with an
//! asymmetric time-varying barrier of K. P. Tee, B. Ren and S. S. Ge, "Control of nonlinear systems with time-varying
//! output constraints", Automatica 47(11), 2011, doi:10.1016/j.automatica.2011.08.044. It is not that earlier law, and
//! its cost is only like that of it.

use serde::{Deserialize, Serialize};

use super::axis::minus;
use super::published::semi_implicit;
use super::saturation::SmoothSaturation;
use super::{AxisLaw, AxisSample, AxisTask, CorridorFilter};
use crate::field::{FieldError, positive, within};
use crate::time_law::PathState;

/// Reconstructed original law: τ²ẍ^N = τα̇₂ − k₂z₂ − z₁/(k_n(k² − z₁²)), α₂ = τẋ^c − (k₁ + τκ̄)z₁, z₁ = x^N − x^c,
/// z₂ = τẋ^N − α₂.
///
/// k is k_b = x^H − x^c for z₁ > 0 and k_a = x^c − x^L else; κ̄ = √((k̇_a/k_a)² + (k̇_b/k_b)² + ε). x^c is the skill, drawn off
/// the bounds by the smooth saturation [`SmoothSaturation`]. In continuous time the barrier keeps z₁ in (−k_a, k_b);
/// integrated by semi-implicit Euler steps, nothing does. Outside the barrier term is dropped, so that the motion
/// comes back and is reported.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OriginalReconstruction {
    /// k₁ > 0, without unit; 10 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub k_1: f64,
    /// k₂ > 0, without unit; 10 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub k_2: f64,
    /// k_n > 0: weight of z₂² next to the barrier, per squared unit of the skill; 1 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub k_n: f64,
    /// ε > 0 that keeps κ̄ differentiable, per squared second; 1e-3 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub epsilon: f64,
    /// Margin m of the reference x^c as a part of the width, above 0 and below 0.5; 0.3 by default.
    #[schemars(range(min = 1e-6, max = 0.499))]
    pub margin: f64,
}

impl Default for OriginalReconstruction {
    fn default() -> Self {
        Self { k_1: 10.0, k_2: 10.0, k_n: 1.0, epsilon: 1e-3, margin: 0.3 }
    }
}

impl CorridorFilter for OriginalReconstruction {
    fn begin(&self, task: &AxisTask, first: &AxisSample) -> (Box<dyn AxisLaw>, PathState) {
        let goal =
            AxisSample { skill: PathState { position: task.goal, ..PathState::default() }, bounds: task.goal_bounds };
        let start = (task.start - first.bounds.lower.position) / first.bounds.width().position;
        let saturation = SmoothSaturation::fitted(self.margin, [start, goal.place().position]);
        let law = OriginalAxis { options: self.clone(), duration_s: task.duration_s, saturation };
        let motion = PathState { position: task.start, first: first.skill.first, second: 0.0 };
        let second = law.acceleration(first, motion);
        (Box::new(law), PathState { second, ..motion })
    }

    fn validate(&self) -> Result<(), FieldError> {
        positive("k_1", self.k_1)?;
        positive("k_2", self.k_2)?;
        positive("k_n", self.k_n)?;
        positive("epsilon", self.epsilon)?;
        within("margin", self.margin, 1e-6, 0.499)
    }
}

#[derive(Debug)]
struct OriginalAxis {
    options: OriginalReconstruction,
    duration_s: f64,
    saturation: SmoothSaturation,
}

impl AxisLaw for OriginalAxis {
    fn step(&mut self, motion: PathState, to: &AxisSample, time_step_s: f64) -> PathState {
        let moved = semi_implicit(motion, time_step_s);
        PathState { second: self.acceleration(to, moved), ..moved }
    }
}

impl OriginalAxis {
    fn acceleration(&self, at: &AxisSample, motion: PathState) -> f64 {
        let (tau, options) = (self.duration_s, &self.options);
        let reference = self.reference(at);
        let (below, above) = (minus(reference, at.bounds.lower), minus(at.bounds.upper, reference));
        let error = minus(motion, reference);
        let (kappa, kappa_rate) = self.kappa(below, above);
        let virtual_velocity = tau * reference.first - (options.k_1 + tau * kappa) * error.position;
        let virtual_rate =
            tau * reference.second - (options.k_1 + tau * kappa) * error.first - tau * kappa_rate * error.position;
        let z2 = tau * motion.first - virtual_velocity;
        let bound = if error.position > 0.0 { above.position } else { below.position };
        let clearance = bound * bound - error.position * error.position;
        let barrier = if clearance > 0.0 { error.position / (options.k_n * clearance) } else { 0.0 };
        (tau * virtual_rate - options.k_2 * z2 - barrier) / (tau * tau)
    }

    // x^c with two derivatives
    fn reference(&self, at: &AxisSample) -> PathState {
        let place = self.saturation.apply(at.place());
        let (lower, width) = (at.bounds.lower, at.bounds.width());
        PathState {
            position: lower.position + width.position * place.position,
            first: lower.first + width.first * place.position + width.position * place.first,
            second: lower.second
                + width.second * place.position
                + 2.0 * width.first * place.first
                + width.position * place.second,
        }
    }

    // κ̄ and its derivative by time
    fn kappa(&self, below: PathState, above: PathState) -> (f64, f64) {
        let growth = |k: PathState| {
            let rate = k.first / k.position;
            (rate, k.second / k.position - rate * rate)
        };
        let ((a, a_rate), (b, b_rate)) = (growth(below), growth(above));
        let kappa = (a * a + b * b + self.options.epsilon).sqrt();
        (kappa, (a * a_rate + b * b_rate) / kappa)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corridor::Bounds;

    const WAVE: f64 = 0.3;

    // a wide corridor that breathes about a skill at rest
    fn at(t: f64) -> AxisSample {
        let wave = |mean: f64, phase: f64| PathState {
            position: mean + WAVE * (t + phase).sin(),
            first: WAVE * (t + phase).cos(),
            second: -WAVE * (t + phase).sin(),
        };
        AxisSample { skill: wave(0.0, 2.0), bounds: Bounds { lower: wave(-1.0, 0.0), upper: wave(1.0, 1.0) } }
    }

    fn law() -> OriginalAxis {
        let saturation = SmoothSaturation::new(0.3, 0.075).unwrap();
        OriginalAxis { options: OriginalReconstruction::default(), duration_s: 1.5, saturation }
    }

    #[test]
    fn rates_of_reference_and_gain_are_their_difference_quotients() {
        let law = law();
        let sides = |t: f64| {
            let reference = law.reference(&at(t));
            (minus(reference, at(t).bounds.lower), minus(at(t).bounds.upper, reference))
        };
        let kappa = |t: f64| law.kappa(sides(t).0, sides(t).1);
        let step = 1e-5;
        for t in [0.1, 0.7, 1.9, 3.0, 4.4] {
            // derivatives of third order are of order ten
            let quotient = (kappa(t + step).0 - kappa(t - step).0) / (2.0 * step);
            assert!((kappa(t).1 - quotient).abs() < 1e-7, "{t}");
            let quotient = (sides(t + step).0.first - sides(t - step).0.first) / (2.0 * step);
            assert!((sides(t).0.second - quotient).abs() < 1e-7, "{t}");
        }
    }

    #[test]
    fn the_barrier_function_falls_along_the_law() {
        let (mut law, step) = (law(), 1e-4);
        let mut motion = PathState { position: 0.6, first: 0.0, second: 0.0 };
        motion.second = law.acceleration(&at(0.0), motion);
        let value = |law: &OriginalAxis, at: &AxisSample, motion: PathState| {
            let reference = law.reference(at);
            let (below, above) = (minus(reference, at.bounds.lower), minus(at.bounds.upper, reference));
            let error = minus(motion, reference);
            let kappa = law.kappa(below, above).0;
            let z2 = law.duration_s * (error.first + kappa * error.position) + law.options.k_1 * error.position;
            let k = if error.position > 0.0 { above.position } else { below.position };
            0.5 * (k * k / (k * k - error.position.powi(2))).ln() + 0.5 * law.options.k_n * z2 * z2
        };
        let mut before = value(&law, &at(0.0), motion);
        for row in 1..20_000 {
            let to = at(step * f64::from(row));
            motion = law.step(motion, &to, step);
            let now = value(&law, &to, motion);
            // an explicit step may add its own error, of the order of the squared step
            assert!(now <= before + 1e-6, "{row}: {before} {now}");
            before = now;
        }
        assert!(before < 1e-4, "{before}");
    }
}
