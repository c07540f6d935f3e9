//! The default law: a constrained primitive in the logit of the place in the corridor.
//!
//! Takes the place of Eqs. (31) and (32), which neither keep the motion inside nor lead to the skill.

use serde::{Deserialize, Serialize};

use super::saturation::SmoothSaturation;
use super::{AxisLaw, AxisSample, AxisTask, CorridorFilter};
use crate::corridor::Bounds;
use crate::field::{FieldError, positive, within};
use crate::time_law::PathState;

/// Greatest |y|, beyond which the distance from a bound, W·e^{−30}, is lost in rounding.
const LARGEST_LOGIT: f64 = 30.0;
/// Exponent beyond which e^{−a} and its products with powers of a are zero.
const LARGEST_EXPONENT: f64 = 700.0;

/// Logit law: x^N = x^L + W·σ(y_r + e), y_r = logit(S_{d,m}((x^u − x^L)/W)), τ²ë + ατė + (α²/4)e = 0.
///
/// The motion is in no equation integrated in x^N: y is finite, so x^N lies strictly inside for every step and for
/// every corridor, be it jumping (x^N then jumps along). Where the skill keeps a distance of mW from the bounds, and once
/// the deviation e of another start has decayed like (1 + αt/2τ)e^{−αt/2τ}, x^N is the skill. Away from there it is the
/// skill saturated to (dW, W − dW), d = m/4. x^N is C² if the skill and the bounds are.
///
/// m is `margin`, or 9/10 of the distance of start and goal from the bounds if they lie closer, for the whole motion: one
/// end close to a bound lets the motion go closer everywhere. A goal outside the corridor is not reached.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Logit {
    /// Largest margin m as a part of the width, above 0 and below 0.5; 0.3 by default. A smaller one stays with the skill
    /// longer and turns away from the bounds more sharply: 0.15 takes about twice the peak acceleration.
    #[schemars(range(min = 1e-6, max = 0.499))]
    pub margin: f64,
    /// α of the deviation's decay, without unit; 25 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub alpha: f64,
    /// Whether the dynamics of y_r are fed forward (default). Without, y follows y_r like the primitive of Eq. (1) does
    /// its goal: gentler, but late by about 4τ/α.
    pub feed_forward: bool,
}

impl Default for Logit {
    fn default() -> Self {
        Self { margin: 0.3, alpha: 25.0, feed_forward: true }
    }
}

impl CorridorFilter for Logit {
    fn begin(&self, task: &AxisTask, first: &AxisSample) -> (Box<dyn AxisLaw>, PathState) {
        let place = |position: f64, bounds: &Bounds| (position - bounds.lower.position) / bounds.width().position;
        let start = place(task.start, &first.bounds);
        let ends = [start, place(task.goal, &task.goal_bounds)];
        let saturation = SmoothSaturation::fitted(self.margin, ends);
        let reference = logit(saturation.apply(first.place()));
        // the skill's own start needs no deviation, not even a rounding
        let deviation = if task.start == first.skill.position && saturation.is_identity_at(start) {
            0.0
        } else {
            (start / (1.0 - start)).ln() - reference.position
        };
        let state = if self.feed_forward {
            [deviation, 0.0]
        } else {
            [reference.position + deviation, task.duration_s * reference.first]
        };
        let law = LogitAxis {
            saturation,
            alpha: self.alpha,
            feed_forward: self.feed_forward,
            duration_s: task.duration_s,
            decay: Decay::over(0.0, self.alpha),
            reference,
            state,
        };
        let motion = law.motion(first);
        (Box::new(law), PathState { position: task.start, ..motion })
    }

    fn validate(&self) -> Result<(), FieldError> {
        within("margin", self.margin, 1e-6, 0.499)?;
        positive("alpha", self.alpha)
    }
}

#[derive(Debug)]
struct LogitAxis {
    saturation: SmoothSaturation,
    alpha: f64,
    feed_forward: bool,
    duration_s: f64,
    decay: Decay,
    // y_r at the present time
    reference: PathState,
    // (e, τė), without feed-forward (y, τẏ)
    state: [f64; 2],
}

impl AxisLaw for LogitAxis {
    fn step(&mut self, _motion: PathState, to: &AxisSample, time_step_s: f64) -> PathState {
        let ratio = time_step_s / self.duration_s;
        if ratio != self.decay.ratio {
            self.decay = Decay::over(ratio, self.alpha);
        }
        let next = logit(self.saturation.apply(to.place()));
        self.state = if self.feed_forward {
            self.decay.apply(self.state)
        } else {
            // exact for a reference that is linear over the step: behind a ramp of slope b per τ, y rests 4b/α late
            let slope = (next.position - self.reference.position) / ratio;
            let behind = 4.0 * slope / self.alpha;
            let [y, rate] = self.state;
            let [y, rate] = self.decay.apply([y - self.reference.position + behind, rate - slope]);
            [y + next.position - behind, rate + slope]
        };
        self.reference = next;
        self.motion(to)
    }
}

impl LogitAxis {
    fn motion(&self, at: &AxisSample) -> PathState {
        let tau = self.duration_s;
        if self.feed_forward && self.state == [0.0, 0.0] && self.saturation.is_identity_at(at.place().position) {
            return at.skill;
        }
        let [value, rate] = self.state;
        let target = if self.feed_forward { 0.0 } else { self.reference.position };
        let second = -self.alpha * (0.25 * self.alpha * (value - target) + rate) / (tau * tau);
        let y = if self.feed_forward {
            PathState {
                position: self.reference.position + value,
                first: self.reference.first + rate / tau,
                second: self.reference.second + second,
            }
        } else {
            PathState { position: value, first: rate / tau, second }
        };
        in_corridor(&at.bounds, y)
    }
}

/// Maps (e, τė) over a step: Φ = e^{−a}[[1 + a, h/τ], [−(α²/4)h/τ, 1 − a]], a = αh/(2τ).
#[derive(Debug, Clone, Copy)]
struct Decay {
    ratio: f64,
    map: [[f64; 2]; 2],
}

impl Decay {
    fn over(ratio: f64, alpha: f64) -> Self {
        let a = 0.5 * alpha * ratio;
        if a > LARGEST_EXPONENT {
            return Self { ratio, map: [[0.0; 2]; 2] };
        }
        let decay = (-a).exp();
        let map = [[decay * (1.0 + a), decay * ratio], [-decay * 0.25 * alpha * alpha * ratio, decay * (1.0 - a)]];
        Self { ratio, map }
    }

    fn apply(&self, [value, rate]: [f64; 2]) -> [f64; 2] {
        self.map.map(|[of_value, of_rate]| of_value * value + of_rate * rate)
    }
}

/// Evaluates y = log(p/(1 − p)) with its derivatives, 0 < p < 1.
fn logit(place: PathState) -> PathState {
    let p = place.position;
    let spread = p * (1.0 - p);
    let first = place.first / spread;
    PathState { position: (p / (1.0 - p)).ln(), first, second: place.second / spread - first * first * (1.0 - 2.0 * p) }
}

/// Evaluates x = x^L + W·σ(y) with its derivatives, strictly inside also where rounding would reach a bound.
fn in_corridor(bounds: &Bounds, y: PathState) -> PathState {
    let (lower, width) = (bounds.lower, bounds.width());
    let sigma = 1.0 / (1.0 + (-y.position.clamp(-LARGEST_LOGIT, LARGEST_LOGIT)).exp());
    let slope = sigma * (1.0 - sigma);
    let first = slope * y.first;
    let second = slope * y.second + slope * (1.0 - 2.0 * sigma) * y.first * y.first;
    let position = lower.position + width.position * sigma;
    PathState {
        position: position.max(lower.position.next_up()).min(bounds.upper.position.next_down()),
        first: lower.first + width.first * sigma + width.position * first,
        second: lower.second + width.second * sigma + 2.0 * width.first * first + width.position * second,
    }
}

#[cfg(test)]
#[path = "logit_tests.rs"]
mod tests;
