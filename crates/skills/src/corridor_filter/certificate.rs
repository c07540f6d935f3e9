//! The certificate of a motion in a corridor: its margins, at the samples and between them.

use nalgebra::DVector;

use super::axis::minus;
use crate::corridor::{Corridor, least_value, quintic, spans};
use crate::error::SkillError;
use crate::primitive::Rollout;
use crate::time_law::PathState;

/// Smallest distance of one coordinate from one bound, unit of the motion; negative outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// Smallest at the samples.
    pub at_samples: f64,
    /// Time of that sample, s.
    pub at_samples_time_s: f64,
    /// Lower bound of the smallest at all times of the motion, and tight to 1e-9 of the larger distance around it: see
    /// [`certify`].
    pub at_all_times: f64,
    /// Time at which that is taken on, s.
    pub at_all_times_time_s: f64,
}

/// What is certified of one coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisCertificate {
    /// Distance x^N − x^L from the lower bound.
    pub lower: Margin,
    /// Distance x^H − x^N from the upper bound.
    pub upper: Margin,
    /// Number of samples that are not strictly inside.
    pub samples_outside: usize,
    /// Greatest |ẍ^N| at the samples, unit of the motion per second squared.
    pub peak_acceleration: f64,
    /// Time of that sample, s.
    pub peak_acceleration_time_s: f64,
    /// |x^N − g| at the last sample, unit of the motion.
    pub goal_error: f64,
}

impl AxisCertificate {
    /// Tells whether the coordinate is certified to stay strictly inside at all times.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.lower.at_all_times > 0.0 && self.upper.at_all_times > 0.0
    }
}

/// What is certified of a motion in a corridor, whether or not it stayed inside.
#[derive(Debug, Clone, PartialEq)]
pub struct Certificate {
    /// One entry per coordinate.
    pub axes: Vec<AxisCertificate>,
}

impl Certificate {
    /// Tells whether every coordinate is certified to stay strictly inside at all times, also between the samples.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.axes.iter().all(AxisCertificate::holds)
    }

    /// Tells whether every coordinate is strictly inside at every sample; nothing is said of the times between.
    #[must_use]
    pub fn holds_at_samples(&self) -> bool {
        self.axes.iter().all(|axis| axis.samples_outside == 0)
    }

    /// Returns the number of pairs of sample and coordinate that are not strictly inside.
    #[must_use]
    pub fn samples_outside(&self) -> usize {
        self.axes.iter().map(|axis| axis.samples_outside).sum()
    }

    /// Returns the smallest margin at all times over coordinates and bounds; negative outside.
    #[must_use]
    pub fn smallest_margin(&self) -> f64 {
        let margins = self.axes.iter().flat_map(|axis| [axis.lower.at_all_times, axis.upper.at_all_times]);
        margins.fold(f64::INFINITY, f64::min)
    }

    /// Returns the greatest goal error over the coordinates.
    #[must_use]
    pub fn goal_error(&self) -> f64 {
        self.axes.iter().map(|axis| axis.goal_error).fold(0.0, f64::max)
    }

    /// Returns the greatest acceleration over the coordinates.
    #[must_use]
    pub fn peak_acceleration(&self) -> f64 {
        self.axes.iter().map(|axis| axis.peak_acceleration).fold(0.0, f64::max)
    }
}

/// Certifies `motion` in `corridor` (same clock, d coordinates) against the goal g (d values).
///
/// Between its samples the motion is taken for the quintic through their positions, velocities and accelerations: what a
/// tracker that continues all three follows. So are the bounds; their difference on the spans between the samples of
/// both is one quintic each, of which the least value is bounded from below by its Bernstein coefficients. This holds
/// up to rounding, and for that interpolation: it says nothing of a tracker with another one.
///
/// # Errors
/// If the numbers of coordinates differ.
pub fn certify(motion: &Rollout, corridor: &Corridor, goal: &DVector<f64>) -> Result<Certificate, SkillError> {
    let expected = motion.positions().dimension();
    for found in [corridor.dimension(), goal.len()] {
        if found != expected {
            return Err(SkillError::Dimension { operation: "certify motion", found, expected });
        }
    }
    let axes = (0..expected).map(|coordinate| axis(motion, corridor, coordinate, goal[coordinate])).collect();
    Ok(Certificate { axes })
}

fn axis(motion: &Rollout, corridor: &Corridor, coordinate: usize, goal: f64) -> AxisCertificate {
    let times_s = motion.positions().times_s();
    let begin_s = times_s[0];
    let unknown = Margin {
        at_samples: f64::INFINITY,
        at_samples_time_s: begin_s,
        at_all_times: f64::INFINITY,
        at_all_times_time_s: begin_s,
    };
    let mut found = AxisCertificate {
        lower: unknown,
        upper: unknown,
        samples_outside: 0,
        peak_acceleration: 0.0,
        peak_acceleration_time_s: begin_s,
        goal_error: 0.0,
    };
    for (row, time_s) in times_s.iter().copied().enumerate() {
        let (state, bounds) = (state(motion, row, coordinate), corridor.at(time_s, coordinate));
        found.lower.note_sample(state.position - bounds.lower.position, time_s);
        found.upper.note_sample(bounds.upper.position - state.position, time_s);
        found.samples_outside += usize::from(bounds.margin(state.position) <= 0.0);
        if state.second.abs() > found.peak_acceleration {
            (found.peak_acceleration, found.peak_acceleration_time_s) = (state.second.abs(), time_s);
        }
        found.goal_error = (state.position - goal).abs();
    }
    for row in 1..times_s.len() {
        between_samples(motion, corridor, coordinate, row, &mut found);
    }
    found
}

// the span from the sample before `row` to it
fn between_samples(motion: &Rollout, corridor: &Corridor, coordinate: usize, row: usize, found: &mut AxisCertificate) {
    let times_s = motion.positions().times_s();
    let (begin_s, step_s) = (times_s[row - 1], times_s[row] - times_s[row - 1]);
    let (before, after) = (state(motion, row - 1, coordinate), state(motion, row, coordinate));
    for (from_s, to_s) in spans(corridor.times_s(), begin_s, times_s[row]) {
        let at = |time_s: f64| quintic(before, after, step_s, (time_s - begin_s) / step_s);
        let (from, to) = (at(from_s), at(to_s));
        let (from_bounds, to_bounds) = corridor.ends_of_span(from_s, to_s, coordinate);
        let (below, above) = ([from_bounds.lower, to_bounds.lower], [from_bounds.upper, to_bounds.upper]);
        found.lower.note_span(minus(from, below[0]), minus(to, below[1]), from_s, to_s);
        found.upper.note_span(minus(above[0], from), minus(above[1], to), from_s, to_s);
    }
}

impl Margin {
    fn note_sample(&mut self, margin: f64, time_s: f64) {
        if margin < self.at_samples {
            (self.at_samples, self.at_samples_time_s) = (margin, time_s);
        }
    }

    fn note_span(&mut self, from: PathState, to: PathState, from_s: f64, to_s: f64) {
        if let Some((margin, after_s)) = least_value(from, to, to_s - from_s, self.at_all_times) {
            (self.at_all_times, self.at_all_times_time_s) = (margin, from_s + after_s);
        }
    }
}

/// Returns one coordinate of `motion` at a row.
pub(super) fn state(motion: &Rollout, row: usize, coordinate: usize) -> PathState {
    let at = (row, coordinate);
    PathState {
        position: motion.positions().samples()[at],
        first: motion.velocities()[at],
        second: motion.accelerations()[at],
    }
}

#[cfg(test)]
#[path = "certificate_tests.rs"]
mod tests;
