//! Corridors: a lower and an upper bound of each coordinate over time, twice differentiable.
//!
//! The paper gives bounds as sets of points, x^L and x^H. The filters and maps need their first two derivatives, so a
//! corridor is sampled with them and interpolated by quintic pieces.

mod quintic;
pub mod smoothing;

use nalgebra::DMatrix;

pub(crate) use quintic::{least_value, quintic};

use crate::error::SkillError;
use crate::time_law::PathState;
use crate::trajectory::{check_finite, check_times};

/// Both bounds of one coordinate at one time, with their derivatives by time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Lower bound x^L.
    pub lower: PathState,
    /// Upper bound x^H.
    pub upper: PathState,
}

impl Bounds {
    /// Bounds that stand still.
    #[must_use]
    pub fn still(lower: f64, upper: f64) -> Self {
        let at = |position| PathState { position, ..PathState::default() };
        Self { lower: at(lower), upper: at(upper) }
    }

    /// Returns the width W = x^H − x^L with its derivatives.
    #[must_use]
    pub fn width(&self) -> PathState {
        self.combined(-1.0, 1.0)
    }

    /// Returns the middle M = (x^L + x^H)/2 with its derivatives.
    #[must_use]
    pub fn middle(&self) -> PathState {
        self.combined(0.5, 0.5)
    }

    /// Returns the smaller distance of `position` from the two bounds; negative outside.
    #[must_use]
    pub fn margin(&self, position: f64) -> f64 {
        (position - self.lower.position).min(self.upper.position - position)
    }

    fn combined(&self, lower: f64, upper: f64) -> PathState {
        let (low, high) = (self.lower, self.upper);
        PathState {
            position: lower * low.position + upper * high.position,
            first: lower * low.first + upper * high.first,
            second: lower * low.second + upper * high.second,
        }
    }
}

/// Corridor of d coordinates over time: C² between its samples, at rest at its ends' bounds outside them.
#[derive(Debug, Clone, PartialEq)]
pub struct Corridor {
    times_s: Vec<f64>,
    // n × d each: value, first and second derivative by time
    lower: [DMatrix<f64>; 3],
    upper: [DMatrix<f64>; 3],
}

impl Corridor {
    /// Samples `bounds(time_s, coordinate)` at the given times (n ≥ 2, s, strictly increasing) for `dimension`
    /// coordinates.
    ///
    /// # Errors
    /// If there are fewer than two times, they do not increase strictly, the dimension is 0, a value is not finite, or a
    /// lower bound is not below its upper bound.
    pub fn sampled(
        times_s: Vec<f64>,
        dimension: usize,
        bounds: impl Fn(f64, usize) -> Bounds,
    ) -> Result<Self, SkillError> {
        let operation = "build corridor";
        if times_s.len() < 2 {
            return Err(SkillError::RowCount { operation, found: times_s.len(), expected: "at least 2".into() });
        }
        if dimension == 0 {
            return Err(SkillError::Dimension { operation, found: 0, expected: 1 });
        }
        check_times(&times_s)?;
        let table = || [(); 3].map(|()| DMatrix::zeros(times_s.len(), dimension));
        let (mut lower, mut upper) = (table(), table());
        for (row, time_s) in times_s.iter().enumerate() {
            for coordinate in 0..dimension {
                let at = bounds(*time_s, coordinate);
                write(&mut lower, row, coordinate, at.lower);
                write(&mut upper, row, coordinate, at.upper);
                let width = at.width().position;
                if width.is_finite() && width <= 0.0 {
                    let (argument, expected) = ("width", "an upper bound above the lower one at every sample");
                    return Err(SkillError::InvalidArgument { operation, argument, found: width, expected });
                }
            }
        }
        for table in lower.iter().chain(&upper) {
            check_finite(operation, table)?;
        }
        Ok(Self { times_s, lower, upper })
    }

    /// Bounds that stand still: `lower` and `upper`, d values each.
    ///
    /// # Errors
    /// As [`Corridor::sampled`], or if the lengths differ.
    pub fn still(lower: &[f64], upper: &[f64]) -> Result<Self, SkillError> {
        if lower.len() != upper.len() {
            let (found, expected) = (upper.len(), lower.len());
            return Err(SkillError::Dimension { operation: "build corridor", found, expected });
        }
        Self::sampled(vec![0.0, 1.0], lower.len(), |_, k| Bounds::still(lower[k], upper[k]))
    }

    /// Returns the number d of coordinates.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.lower[0].ncols()
    }

    /// Returns the times of the samples, s.
    #[must_use]
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Returns the bounds of `coordinate` (< d) at `time_s`: quintic between samples (value, velocity and acceleration
    /// continuous); outside the sampled times, and for NaN, the nearer end at rest.
    #[must_use]
    pub fn at(&self, time_s: f64, coordinate: usize) -> Bounds {
        let last = self.times_s.len() - 1;
        let held = |row: usize| {
            let at =
                |table: &[DMatrix<f64>; 3]| PathState { position: table[0][(row, coordinate)], ..PathState::default() };
            Bounds { lower: at(&self.lower), upper: at(&self.upper) }
        };
        if time_s > self.times_s[last] {
            return held(last);
        }
        if time_s.is_nan() || time_s < self.times_s[0] {
            return held(0);
        }
        let row = self.times_s.partition_point(|sample| *sample <= time_s).saturating_sub(1).min(last - 1);
        let (begin_s, step_s) = (self.times_s[row], self.times_s[row + 1] - self.times_s[row]);
        let piece = |table: &[DMatrix<f64>; 3]| {
            quintic(read(table, row, coordinate), read(table, row + 1, coordinate), step_s, (time_s - begin_s) / step_s)
        };
        Bounds { lower: piece(&self.lower), upper: piece(&self.upper) }
    }

    /// Returns the bounds at both ends of a span within which they are quintics: one without a sample inside it.
    ///
    /// At the first and last sample the bounds of the span's side are meant: at rest outside, moving inside.
    pub(crate) fn ends_of_span(&self, begin_s: f64, end_s: f64, coordinate: usize) -> (Bounds, Bounds) {
        let (first_s, last_s) = (self.times_s[0], self.times_s[self.times_s.len() - 1]);
        let outside = begin_s >= last_s || end_s <= first_s;
        if outside {
            let at = self.at(0.5 * (begin_s + end_s), coordinate);
            return (at, at);
        }
        (self.at(begin_s, coordinate), self.at(end_s, coordinate))
    }

    /// Finds the least width of `coordinate` (< d) within `[begin_s, end_s]`, also between the samples: a lower bound
    /// of it, tight to 1e-9 of the bounds, and its time.
    #[must_use]
    pub fn least_width(&self, begin_s: f64, end_s: f64, coordinate: usize) -> (f64, f64) {
        let mut least = (f64::INFINITY, begin_s);
        for (from_s, to_s) in spans(&self.times_s, begin_s, end_s) {
            let (from, to) = self.ends_of_span(from_s, to_s, coordinate);
            let found = least_value(from.width(), to.width(), to_s - from_s, least.0);
            if let Some((width, after_s)) = found {
                least = (width, from_s + after_s);
            }
        }
        least
    }
}

/// Divides `[begin_s, end_s]` at those of `knots` (strictly increasing) that lie inside it.
pub(crate) fn spans(knots: &[f64], begin_s: f64, end_s: f64) -> impl Iterator<Item = (f64, f64)> {
    let inner = knots.iter().copied().skip(knots.partition_point(|knot| *knot <= begin_s));
    let ends = inner.take_while(move |knot| *knot < end_s).chain(std::iter::once(end_s));
    ends.scan(begin_s, |from_s, to_s| Some((std::mem::replace(from_s, to_s), to_s)))
}

fn write(table: &mut [DMatrix<f64>; 3], row: usize, coordinate: usize, state: PathState) {
    for (derivative, value) in table.iter_mut().zip([state.position, state.first, state.second]) {
        derivative[(row, coordinate)] = value;
    }
}

fn read(table: &[DMatrix<f64>; 3], row: usize, coordinate: usize) -> PathState {
    let [position, first, second] = [0, 1, 2].map(|derivative| table[derivative][(row, coordinate)]);
    PathState { position, first, second }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    /// A few roundings of numbers of order one, twice divided by a step of a tenth.
    const ROUNDING: f64 = 1e-10;

    // a quintic is its own interpolant
    fn wave(t: f64) -> PathState {
        PathState {
            position: 1.0 + t - 2.0 * t.powi(3) + t.powi(5),
            first: 1.0 - 6.0 * t * t + 5.0 * t.powi(4),
            second: -12.0 * t + 20.0 * t.powi(3),
        }
    }

    fn corridor() -> Corridor {
        let still = PathState { position: -1.0, ..PathState::default() };
        let times = (0..=10).map(|row| 0.1 * f64::from(row)).collect();
        Corridor::sampled(times, 1, |time_s, _| Bounds { lower: still, upper: wave(time_s) }).unwrap()
    }

    #[test]
    fn a_quintic_bound_is_met_between_its_samples() {
        for time_s in [0.0, 0.03, 0.1, 0.55, 0.999, 1.0] {
            let (found, expected) = (corridor().at(time_s, 0).upper, wave(time_s));
            assert_relative_eq!(found.position, expected.position, epsilon = ROUNDING);
            assert_relative_eq!(found.first, expected.first, epsilon = ROUNDING);
            assert_relative_eq!(found.second, expected.second, epsilon = ROUNDING);
        }
    }

    #[test]
    fn bounds_rest_outside_the_samples() {
        assert_eq!(corridor().at(7.0, 0), Bounds::still(-1.0, wave(1.0).position));
        assert_eq!(corridor().at(-1.0, 0), Bounds::still(-1.0, 1.0));
        assert_eq!(corridor().at(f64::NAN, 0), Bounds::still(-1.0, 1.0));
    }

    #[test]
    fn margin_width_and_middle_of_still_bounds() {
        let bounds = Bounds::still(-1.0, 3.0);
        assert_eq!((bounds.width().position, bounds.middle().position), (4.0, 1.0));
        assert_eq!((bounds.margin(0.0), bounds.margin(3.5)), (1.0, -0.5));
    }

    #[test]
    fn the_least_width_is_found_between_the_samples() {
        // mid-way the upper bound sinks by 2^-5·10 = 0.3125 of its velocity of one: W = 1 − 5/16 there
        let falling = |first| PathState { position: 1.0, first, second: 0.0 };
        let still = PathState::default();
        let corridor = Corridor::sampled(vec![0.0, 1.0], 1, |time_s, _| Bounds {
            lower: still,
            upper: falling(if time_s < 0.5 { -1.0 } else { 1.0 }),
        });
        let (width, time_s) = corridor.unwrap().least_width(-1.0, 2.0, 0);
        assert_relative_eq!(width, 1.0 - 5.0 / 16.0, epsilon = 1e-8);
        // the minimum is flat: its time is known to the root of the tolerance only
        assert_relative_eq!(time_s, 0.5, epsilon = 1e-4);
    }

    #[test]
    fn a_span_is_divided_at_the_knots_inside_it() {
        let divided: Vec<_> = spans(&[0.0, 1.0, 2.0, 3.0], 0.5, 2.0).collect();
        assert_eq!(divided, [(0.5, 1.0), (1.0, 2.0)]);
        assert_eq!(spans(&[0.0], 0.0, 1.0).collect::<Vec<_>>(), [(0.0, 1.0)]);
    }

    #[test]
    fn crossed_bounds_and_numbers_that_are_none_are_refused() {
        assert!(matches!(Corridor::still(&[0.0], &[0.0]), Err(SkillError::InvalidArgument { argument: "width", .. })));
        assert!(matches!(Corridor::still(&[0.0], &[f64::NAN]), Err(SkillError::NonFinite { .. })));
        assert!(matches!(Corridor::still(&[0.0], &[]), Err(SkillError::Dimension { .. })));
        assert!(matches!(Corridor::still(&[], &[]), Err(SkillError::Dimension { .. })));
    }
}
