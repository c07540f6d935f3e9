//! Running sums over one cut.

use crate::cutting::mechanics::CutStep;

/// An edge that has gone back by this much has turned, m: more than arm and food give way under the cutting force.
const TURNED_M: f64 = 0.004;

/// What a cut adds up step by step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub force_peak_n: f64,
    pub pressing_s: f64,
    pub strokes: usize,
    impulse_n_s: f64,
    slid_m: f64,
    pushed_m: f64,
    stroke: StrokeCounter,
}

/// Counts turns of an edge along itself: goings back by more than [`TURNED_M`], not what trembles.
#[derive(Clone, Copy, Debug, Default)]
struct StrokeCounter {
    /// Way along the edge, m, with its ends since the last turn.
    way_m: f64,
    least_m: f64,
    most_m: f64,
    /// Direction of the stroke; zero before its first [`TURNED_M`].
    direction: f64,
}

impl StrokeCounter {
    /// Adds a way along the edge, m, and says whether the edge has turned by it.
    fn turns(&mut self, way_m: f64) -> bool {
        self.way_m += way_m;
        (self.least_m, self.most_m) = (self.least_m.min(self.way_m), self.most_m.max(self.way_m));
        let went = match (self.way_m - self.least_m > TURNED_M, self.most_m - self.way_m > TURNED_M) {
            (true, _) if self.direction <= 0.0 => 1.0,
            (_, true) if self.direction >= 0.0 => -1.0,
            _ => return false,
        };
        let turned = self.direction != 0.0;
        (self.direction, self.least_m, self.most_m) = (went, self.way_m, self.way_m);
        turned
    }
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
        self.strokes += usize::from(self.stroke.turns(slide_m_per_s * dt));
    }

    /// The knife comes back into the cut.
    pub fn resume(&mut self) {
        self.stroke = StrokeCounter::default();
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

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 0.001;

    /// Turns of an edge that goes along a way given over time for two seconds.
    fn turns(way_m: impl Fn(f64) -> f64) -> usize {
        let mut counter = StrokeCounter::default();
        let step = |k: i32| way_m(f64::from(k) * DT_S) - way_m(f64::from(k - 1) * DT_S);
        (1..=2000).filter(|k| counter.turns(step(*k))).count()
    }

    #[test]
    fn a_saw_turns_at_the_end_of_each_stroke() {
        // two seconds of 1 Hz: ends at 0.25, 0.75, 1.25 and 1.75 s
        assert_eq!(turns(|time_s| 0.02 * (std::f64::consts::TAU * time_s).sin()), 4);
        assert_eq!(turns(|time_s| 0.02 * time_s), 0);
    }

    #[test]
    fn trembling_and_giving_way_are_no_turns() {
        assert_eq!(turns(|time_s| 0.001 * (500.0 * time_s).sin()), 0);
        assert_eq!(turns(|time_s| 0.02 * time_s + 0.0015 * (60.0 * time_s).sin()), 0);
    }
}
