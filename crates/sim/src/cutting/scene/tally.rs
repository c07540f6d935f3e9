//! Running sums over one cut.

use crate::cutting::mechanics::CutStep;

/// Slower than this, an edge does not slide to either side, m/s.
const SLIDING_M_PER_S: f64 = 0.002;

/// What a cut adds up step by step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub force_peak_n: f64,
    pub pressing_s: f64,
    pub strokes: usize,
    impulse_n_s: f64,
    slid_m: f64,
    pushed_m: f64,
    direction: f64,
}

impl Tally {
    /// Adds one step with the size of the force on the knife and the speed of the edge along itself.
    pub fn add(&mut self, step: &CutStep, force_n: f64, slide_m_per_s: f64, dt: f64) {
        self.force_peak_n = self.force_peak_n.max(force_n);
        if step.width_m <= 0.0 {
            return;
        }
        self.strokes = self.strokes.max(1);
        self.pressing_s += dt;
        self.impulse_n_s += force_n * dt;
        let advance = step.advance_m_per_s.max(0.0);
        self.pushed_m += advance * dt;
        self.slid_m += step.slice_push_ratio.abs() * advance * dt;
        if slide_m_per_s.abs() > SLIDING_M_PER_S {
            if self.direction * slide_m_per_s < 0.0 {
                self.strokes += 1;
            }
            self.direction = slide_m_per_s.signum();
        }
    }

    /// The knife comes back into the cut.
    pub fn resume(&mut self) {
        self.direction = 0.0;
        self.strokes += 1;
    }

    /// Mean force while the edge pressed, N.
    pub fn force_mean_n(&self) -> f64 {
        if self.pressing_s > 0.0 { self.impulse_n_s / self.pressing_s } else { 0.0 }
    }

    /// Way along the edge by way into the food.
    pub fn slice_push_ratio(&self) -> f64 {
        if self.pushed_m > 0.0 { self.slid_m / self.pushed_m } else { 0.0 }
    }
}
