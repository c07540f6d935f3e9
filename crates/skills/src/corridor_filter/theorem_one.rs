//! The law of Theorem 1, corrected: the barrier of Eq. (31) with the gain and the moving bounds that its proof needs.

use serde::{Deserialize, Serialize};

use super::barrier::{clearance, lyapunov};
use super::published::semi_implicit;
use super::{AxisLaw, AxisSample, AxisTask, CorridorFilter};
use crate::corridor::Bounds;
use crate::field::{FieldError, not_negative, positive};
use crate::time_law::PathState;

/// Largest |η| = |atanh ζ|: the distance from a bound, W·e^{−2η}, is then lost in rounding.
const LARGEST_ETA: f64 = 15.0;
/// Part of η to which an implicit step is solved, and most iterations for it (bisection alone needs 50).
const SOLVED: f64 = 1e-13;
const MOST_ITERATIONS: usize = 80;

/// How the law of Theorem 1 is integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integration {
    /// In η = atanh ζ, ζ = 2(x − M)/W, by implicit steps: inside for every step (default).
    #[default]
    Transformed,
    /// By semi-implicit Euler steps of x and v: stable only while h·(k_z + 1/(4k_λτD))/(k_nτ) < 2, and D has no lower
    /// bound. Outside, where the barrier is not defined, only k_z damps, so that the motion comes back and is reported.
    Explicit,
}

/// Corrected law of Theorem 1: τv̇^N = τλ̇ − (k_z + 1/(4k_λτD))·z₂/k_n with z₂ = v^N − λ, D = (x^H − x)(x − x^L) and
/// λ = τ(Ṁ + (x − M)Ẇ/W) − k_λ(x − M).
///
/// Then V̇^c = −(k_λ/(τD))·((x − M) − z₂/(2k_λ))² − k_z·z₂² ≤ 0 for V^c of Eq. (31): in continuous time the bounds are never
/// reached. Printed are k_λ = 1, 1/(τW²) for 1/(4k_λτD), which is the smaller of both, and no derivative of the bounds.
///
/// Like the printed law it leads to the middle M of the corridor. It does not even see the skill: −k_λz₁ and (h̄ + h̲)/2
/// in λ leave M alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TheoremOne {
    /// How the law is integrated.
    pub integration: Integration,
    /// k_λ > 0, without unit: the speed of the approach to the middle, e^{−k_λ·t/τ}; 10 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub k_lambda: f64,
    /// k_n > 0 of Eq. (31), per s and squared unit of the skill; 1 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub k_n: f64,
    /// k_z ≥ 0 of Eq. (32), unit of k_n; 10 by default. z₂ decays like e^{−(k_z + 1/(4k_λτD))t/(k_nτ)}: with the paper's "tiny
    /// positive number", a large k_λ makes the law slower, not faster.
    #[schemars(range(min = 0.0))]
    pub k_z: f64,
}

impl Default for TheoremOne {
    fn default() -> Self {
        Self { integration: Integration::Transformed, k_lambda: 10.0, k_n: 1.0, k_z: 10.0 }
    }
}

impl TheoremOne {
    /// Evaluates λ at `position`.
    #[must_use]
    pub fn virtual_velocity(&self, duration_s: f64, bounds: &Bounds, position: f64) -> f64 {
        let (middle, width) = (bounds.middle(), bounds.width());
        let offset = position - middle.position;
        duration_s * (middle.first + offset * width.first / width.position) - self.k_lambda * offset
    }

    /// Evaluates λ̇ along the motion.
    #[must_use]
    pub fn virtual_velocity_rate(&self, duration_s: f64, bounds: &Bounds, motion: PathState) -> f64 {
        let (middle, width) = (bounds.middle(), bounds.width());
        let (offset, offset_rate) = (motion.position - middle.position, motion.first - middle.first);
        let growth = width.first / width.position;
        let growth_rate = width.second / width.position - growth * growth;
        duration_s * (middle.second + offset_rate * growth + offset * growth_rate) - self.k_lambda * offset_rate
    }

    /// Evaluates z₂ = τẋ^N − λ.
    #[must_use]
    pub fn z2(&self, duration_s: f64, bounds: &Bounds, motion: PathState) -> f64 {
        duration_s * motion.first - self.virtual_velocity(duration_s, bounds, motion.position)
    }

    /// Evaluates ẍ^N = v̇^N/τ of the law.
    #[must_use]
    pub fn acceleration(&self, duration_s: f64, bounds: &Bounds, motion: PathState) -> f64 {
        let clearance = clearance(bounds, motion.position);
        let barrier = if clearance > 0.0 { 0.25 / (self.k_lambda * duration_s * clearance) } else { 0.0 };
        let damping = (self.k_z + barrier) * self.z2(duration_s, bounds, motion) / self.k_n;
        let rate = self.virtual_velocity_rate(duration_s, bounds, motion);
        (duration_s * rate - damping) / (duration_s * duration_s)
    }

    /// Evaluates V^c of Eq. (31); +∞ on the bounds and outside.
    #[must_use]
    pub fn lyapunov(&self, duration_s: f64, bounds: &Bounds, motion: PathState) -> f64 {
        lyapunov(bounds, motion.position, self.k_n, duration_s, self.z2(duration_s, bounds, motion))
    }

    /// Evaluates V̇^c along the law, never above 0 inside the bounds.
    #[must_use]
    pub fn lyapunov_rate(&self, duration_s: f64, bounds: &Bounds, motion: PathState) -> f64 {
        let z2 = self.z2(duration_s, bounds, motion);
        let offset = motion.position - bounds.middle().position - 0.5 * z2 / self.k_lambda;
        let clearance = clearance(bounds, motion.position);
        -self.k_lambda / (duration_s * clearance) * offset * offset - self.k_z * z2 * z2
    }
}

impl CorridorFilter for TheoremOne {
    fn begin(&self, task: &AxisTask, first: &AxisSample) -> (Box<dyn AxisLaw>, PathState) {
        let motion = PathState { position: task.start, first: first.skill.first, second: 0.0 };
        let second = self.acceleration(task.duration_s, &first.bounds, motion);
        let law: Box<dyn AxisLaw> = match self.integration {
            Integration::Explicit => Box::new(ExplicitAxis { law: self.clone(), duration_s: task.duration_s }),
            Integration::Transformed => {
                let (middle, width) = (first.bounds.middle().position, first.bounds.width().position);
                let eta = (2.0 * (task.start - middle) / width).atanh().clamp(-LARGEST_ETA, LARGEST_ETA);
                let z2 = self.z2(task.duration_s, &first.bounds, motion);
                Box::new(TransformedAxis { law: self.clone(), duration_s: task.duration_s, eta, z2 })
            }
        };
        (law, PathState { second, ..motion })
    }

    fn validate(&self) -> Result<(), FieldError> {
        positive("k_lambda", self.k_lambda)?;
        positive("k_n", self.k_n)?;
        not_negative("k_z", self.k_z)
    }
}

#[derive(Debug)]
struct ExplicitAxis {
    law: TheoremOne,
    duration_s: f64,
}

impl AxisLaw for ExplicitAxis {
    fn step(&mut self, motion: PathState, to: &AxisSample, time_step_s: f64) -> PathState {
        let moved = semi_implicit(motion, time_step_s);
        PathState { second: self.law.acceleration(self.duration_s, &to.bounds, moved), ..moved }
    }
}

#[derive(Debug)]
struct TransformedAxis {
    law: TheoremOne,
    duration_s: f64,
    eta: f64,
    z2: f64,
}

impl AxisLaw for TransformedAxis {
    fn step(&mut self, _motion: PathState, to: &AxisSample, time_step_s: f64) -> PathState {
        let (tau, bounds) = (self.duration_s, &to.bounds);
        let (middle, width) = (bounds.middle().position, bounds.width().position);
        let step = ImplicitStep::new(&self.law, self.eta, self.z2, time_step_s / tau, width, tau);
        self.eta = step.solve();
        self.z2 = step.z2(self.eta);
        let inside = middle + 0.5 * width * self.eta.tanh();
        let position = inside.max(bounds.lower.position.next_up()).min(bounds.upper.position.next_down());
        let first = (self.law.virtual_velocity(tau, bounds, position) + self.z2) / tau;
        let moved = PathState { position, first, second: 0.0 };
        PathState { second: self.law.acceleration(tau, bounds, moved), ..moved }
    }
}

/// One step of τη̇ = (2z₂/W)·cosh²η − (k_λ/2)·sinh 2η, implicit in η, with z₂ decaying by the gain at its end.
///
/// η⁺ − η = (h/τ)·((2z₂(η⁺)/W)·cosh²η⁺ − (k_λ/2)·sinh 2η⁺), z₂(η⁺) = z₂·e^{−(h/τ)(k_z + cosh²η⁺/(k_λτW²))/k_n}. The decay bounds
/// z₂·cosh²η⁺ for every η⁺, so that there is a solution for every step: the right side is finite before η is large.
struct ImplicitStep {
    eta: f64,
    z2: f64,
    // h/τ
    ratio: f64,
    // 2/W, k_λ, and the factors of the decay's exponent
    scale: f64,
    k_lambda: f64,
    damping: f64,
    barrier: f64,
}

impl ImplicitStep {
    fn new(law: &TheoremOne, eta: f64, z2: f64, ratio: f64, width: f64, tau: f64) -> Self {
        let barrier = ratio / (law.k_n * law.k_lambda * tau * width * width);
        let damping = ratio * law.k_z / law.k_n;
        Self { eta, z2, ratio, scale: 2.0 / width, k_lambda: law.k_lambda, damping, barrier }
    }

    fn z2(&self, eta: f64) -> f64 {
        let cosh = eta.cosh();
        self.z2 * (-self.damping - self.barrier * cosh * cosh).exp()
    }

    // what the equation is short of at η, and its slope
    fn defect(&self, eta: f64) -> (f64, f64) {
        let (double_sinh, double_cosh) = ((2.0 * eta).sinh(), (2.0 * eta).cosh());
        let square = 0.5 * (double_cosh + 1.0);
        let push = self.scale * self.z2(eta);
        let drive = push * square - 0.5 * self.k_lambda * double_sinh;
        let slope = push * double_sinh * (1.0 - self.barrier * square) - self.k_lambda * double_cosh;
        (eta - self.eta - self.ratio * drive, 1.0 - self.ratio * slope)
    }

    // Newton's method, kept between ends of opposite sign by bisection
    fn solve(&self) -> f64 {
        let mut eta = self.eta;
        let (mut low, mut high) = if self.defect(eta).0 < 0.0 { (eta, LARGEST_ETA) } else { (-LARGEST_ETA, eta) };
        for _ in 0..MOST_ITERATIONS {
            let (defect, slope) = self.defect(eta);
            if defect < 0.0 {
                low = eta;
            } else {
                high = eta;
            }
            let newton = eta - defect / slope;
            if (newton - eta).abs() <= SOLVED * (1.0 + eta.abs()) {
                return newton.clamp(-LARGEST_ETA, LARGEST_ETA);
            }
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if next == eta {
                break;
            }
            eta = next;
        }
        eta
    }
}

#[cfg(test)]
#[path = "theorem_one_tests.rs"]
mod tests;
