//! Conservative smoothing of sampled bounds, with kinks and jumps, to a twice differentiable corridor inside them.
//!
//! The paper takes bounds as sets of points. Maps and filters hand their second derivatives on to the motion, so kinks
//! would become jumps of acceleration.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::{Bounds, Corridor};
use crate::error::SkillError;
use crate::field::{FieldError, positive, within};
use crate::time_law::{PathState, minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative};
use crate::trajectory::{check_finite, check_times};

/// Part of the window below which two knots are one.
const SAME_KNOT: f64 = 1e-9;

/// Options of the smoothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SmoothingConfig {
    /// Half-width h of the window, s: a jump of a bound becomes a minimum-jerk step of duration 2h that ends before the
    /// jump (begins after it, where the corridor opens). 0.05 s by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub half_window_s: f64,
    /// Least width over the median width, 0 to 0.5, without unit; 0.1 by default. 0 refuses a corridor that closes.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub least_width: f64,
}

impl Default for SmoothingConfig {
    fn default() -> Self {
        Self { half_window_s: 0.05, least_width: 0.1 }
    }
}

impl SmoothingConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("half_window_s", self.half_window_s)?;
        within("least_width", self.least_width, 0.0, 0.5)
    }
}

/// Smooth corridor, and where it is wider than what it was made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Smoothed {
    /// The corridor: C² at all times, at rest 2h before the first and after the last sample.
    pub corridor: Corridor,
    /// Spans in which the least width acts, by coordinate, then time: only there may a bound lie outside the given one.
    pub floored: Vec<FlooredSpan>,
}

/// Span of time in which a corridor was widened to the least width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlooredSpan {
    /// Index of the coordinate, from 0.
    pub coordinate: usize,
    /// Begin of the span, s.
    pub begin_s: f64,
    /// End of the span, s.
    pub end_s: f64,
}

/// Smooths bounds sampled at `times_s` (n ≥ 2, s, strictly increasing), `lower` and `upper` n × d, to a C² corridor that
/// lies inside them at every time outside [`Smoothed::floored`].
///
/// x^L(t) = ∫ k(s) max{l(t′): |t′ − t + s| ≤ h} ds with the kernel k = d/ds mj((s + h)/2h): no window that the kernel
/// averages leaves t itself out, so the average of their maxima is no less than l(t). Between two samples the tighter of
/// both counts, which covers straight lines as well as jumps. The result is a sum of minimum-jerk steps; the corridor has
/// a sample at each of their joints and meets it exactly. Upper bounds alike, with minima.
///
/// Where the maxima leave less than W_min = `least_width` × the median of the given widths, both bounds are moved to
/// W_min about their middle before the averaging.
///
/// # Errors
/// If an option is invalid, shapes differ, a value is not finite, the times do not increase, the median of the widths is
/// not above 0, or the corridor closes while `least_width` is 0.
pub fn smooth(
    config: &SmoothingConfig,
    times_s: &[f64],
    lower: &DMatrix<f64>,
    upper: &DMatrix<f64>,
) -> Result<Smoothed, SkillError> {
    config.validate()?;
    check_tables(times_s, lower, upper)?;
    let h = config.half_window_s;
    let mut floored = Vec::new();
    let mut steps = Vec::with_capacity(lower.ncols());
    for coordinate in 0..lower.ncols() {
        let mut low = Steps::extreme(times_s, lower.column(coordinate).as_slice(), h, f64::max);
        let mut high = Steps::extreme(times_s, upper.column(coordinate).as_slice(), h, f64::min);
        let median = median((0..times_s.len()).map(|row| upper[(row, coordinate)] - lower[(row, coordinate)]));
        if median <= 0.0 {
            return Err(refused("width", median, "an upper bound above the lower one for most of the time"));
        }
        floor(&mut low, &mut high, config.least_width * median, coordinate, &mut floored);
        steps.push((low, high));
    }
    let bounds = |time_s, coordinate: usize| {
        let (low, high) = &steps[coordinate];
        Bounds { lower: low.averaged(time_s), upper: high.averaged(time_s) }
    };
    Ok(Smoothed { corridor: Corridor::sampled(knots(times_s, h), lower.ncols(), bounds)?, floored })
}

/// Function that is constant between `breaks`; one value more than there are breaks.
struct Steps {
    breaks: Vec<f64>,
    values: Vec<f64>,
    half_window_s: f64,
}

impl Steps {
    /// Takes the extreme of all samples that count within ±h of a time.
    fn extreme(times_s: &[f64], samples: &[f64], h: f64, worse: fn(f64, f64) -> f64) -> Self {
        let mut breaks: Vec<f64> = times_s.iter().flat_map(|time_s| [time_s - h, time_s + h]).collect();
        breaks.sort_by(f64::total_cmp);
        let last = times_s.len() - 1;
        let over = |from_s: f64, to_s: f64| {
            // from the sample before the window to the one after it: between two samples the tighter counts
            let begin = times_s.partition_point(|time_s| *time_s <= from_s).saturating_sub(1);
            let end = times_s.partition_point(|time_s| *time_s < to_s).min(last);
            samples[begin..=end].iter().copied().fold(samples[begin], worse)
        };
        let inner = breaks.windows(2).map(|pair| {
            let middle = 0.5 * (pair[0] + pair[1]);
            over(middle - h, middle + h)
        });
        let values = std::iter::once(samples[0]).chain(inner).chain(std::iter::once(samples[last])).collect();
        Self { breaks, values, half_window_s: h }
    }

    /// Averages by the kernel: each step becomes a minimum-jerk one.
    fn averaged(&self, time_s: f64) -> PathState {
        let h = self.half_window_s;
        let past = self.breaks.partition_point(|at| *at <= time_s - h);
        let mut state = PathState { position: self.values[past], ..PathState::default() };
        for (index, at) in self.breaks.iter().enumerate().skip(past).take_while(|(_, at)| **at < time_s + h) {
            let (jump, ratio) = (self.values[index + 1] - self.values[index], 0.5 * (time_s - at + h) / h);
            state.position += jump * minimum_jerk(ratio);
            state.first += jump * minimum_jerk_first_derivative(ratio) / (2.0 * h);
            state.second += jump * minimum_jerk_second_derivative(ratio) / (4.0 * h * h);
        }
        state
    }
}

/// Widens both bounds about their middle where they leave less than `least`, and notes the spans in which this shows.
fn floor(low: &mut Steps, high: &mut Steps, least: f64, coordinate: usize, floored: &mut Vec<FlooredSpan>) {
    let h = low.half_window_s;
    let mut open: Option<FlooredSpan> = None;
    for (index, (lower, upper)) in low.values.iter_mut().zip(&mut high.values).enumerate() {
        if *upper - *lower >= least {
            continue;
        }
        let middle = 0.5 * (*lower + *upper);
        (*lower, *upper) = (middle - 0.5 * least, middle + 0.5 * least);
        let begin_s = index.checked_sub(1).map_or(f64::NEG_INFINITY, |before| low.breaks[before] - h);
        let end_s = low.breaks.get(index).map_or(f64::INFINITY, |after| after + h);
        match &mut open {
            Some(span) if begin_s <= span.end_s => span.end_s = end_s,
            _ => floored.extend(open.replace(FlooredSpan { coordinate, begin_s, end_s })),
        }
    }
    floored.extend(open);
}

/// Returns the joints of the averaged steps, in order: a step at t ± h begins and ends h from it.
fn knots(times_s: &[f64], h: f64) -> Vec<f64> {
    let mut knots: Vec<f64> = times_s.iter().flat_map(|time_s| [time_s - 2.0 * h, *time_s, time_s + 2.0 * h]).collect();
    knots.sort_by(f64::total_cmp);
    knots.dedup_by(|later, kept| *later - *kept < SAME_KNOT * h);
    knots
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

fn check_tables(times_s: &[f64], lower: &DMatrix<f64>, upper: &DMatrix<f64>) -> Result<(), SkillError> {
    let operation = "smooth bounds";
    if times_s.len() < 2 {
        return Err(SkillError::RowCount { operation, found: times_s.len(), expected: "at least 2".into() });
    }
    check_times(times_s)?;
    for table in [lower, upper] {
        if table.nrows() != times_s.len() {
            let expected = format!("{}, one per time", times_s.len());
            return Err(SkillError::RowCount { operation, found: table.nrows(), expected });
        }
        check_finite(operation, table)?;
    }
    if lower.ncols() == 0 || upper.ncols() != lower.ncols() {
        let (found, expected) = (upper.ncols(), lower.ncols().max(1));
        return Err(SkillError::Dimension { operation, found, expected });
    }
    Ok(())
}

fn refused(argument: &'static str, found: f64, expected: &'static str) -> SkillError {
    SkillError::InvalidArgument { operation: "smooth bounds", argument, found, expected }
}

#[cfg(test)]
#[path = "smoothing_tests.rs"]
mod tests;
