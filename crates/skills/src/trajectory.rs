//! Trajectories: strictly increasing times and one row of coordinates per time, checked once.

mod smoothing;

use nalgebra::{DMatrix, DVector, RowDVector};

pub use smoothing::Ends;

use crate::error::SkillError;

/// Sampled motion: n times (s, strictly increasing) and n × d samples, rows are time.
///
/// Samples are finite, n ≥ 2 and d ≥ 1. Unit and frame of the samples are the owner's business.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    times_s: Vec<f64>,
    samples: DMatrix<f64>,
}

impl Trajectory {
    /// Checks and takes `times_s` (n, s) and `samples` (n × d, rows are time).
    ///
    /// # Errors
    /// If n < 2, d < 1, the numbers of rows differ, a value is not finite or the times do not increase strictly.
    pub fn new(times_s: Vec<f64>, samples: DMatrix<f64>) -> Result<Self, SkillError> {
        let operation = "check trajectory";
        if samples.nrows() < 2 {
            return Err(SkillError::RowCount { operation, found: samples.nrows(), expected: "at least 2".into() });
        }
        if samples.nrows() != times_s.len() {
            let expected = format!("{}, one per time", times_s.len());
            return Err(SkillError::RowCount { operation, found: samples.nrows(), expected });
        }
        if samples.ncols() == 0 {
            return Err(SkillError::Dimension { operation, found: 0, expected: 1 });
        }
        check_times(&times_s)?;
        check_finite(operation, &samples)?;
        Ok(Self { times_s, samples })
    }

    /// Checks and takes `samples` (n × d) recorded from t = 0 every `time_step_s` seconds.
    ///
    /// # Errors
    /// If the step is not a positive finite number, and as [`Trajectory::new`].
    pub fn uniform(time_step_s: f64, samples: DMatrix<f64>) -> Result<Self, SkillError> {
        if !(time_step_s > 0.0 && time_step_s.is_finite()) {
            return Err(SkillError::InvalidArgument {
                operation: "check trajectory",
                argument: "time_step_s",
                found: time_step_s,
                expected: "a positive finite number",
            });
        }
        Self::new((0..samples.nrows()).map(|row| row as f64 * time_step_s).collect(), samples)
    }

    /// Returns the number d of coordinates.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.samples.ncols()
    }

    /// Returns the number n of samples, at least 2.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a trajectory is never empty")]
    pub fn len(&self) -> usize {
        self.times_s.len()
    }

    /// Returns the n times, s.
    #[must_use]
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Returns the n × d samples, rows are time.
    #[must_use]
    pub fn samples(&self) -> &DMatrix<f64> {
        &self.samples
    }

    /// Returns the first time, s.
    #[must_use]
    pub fn start_time_s(&self) -> f64 {
        self.times_s[0]
    }

    /// Returns the last time, s.
    #[must_use]
    pub fn end_time_s(&self) -> f64 {
        self.times_s[self.len() - 1]
    }

    /// Returns the last time minus the first, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.end_time_s() - self.start_time_s()
    }

    /// Returns the first sample, d values.
    #[must_use]
    pub fn start(&self) -> DVector<f64> {
        self.samples.row(0).transpose()
    }

    /// Returns the last sample, d values.
    #[must_use]
    pub fn end(&self) -> DVector<f64> {
        self.samples.row(self.len() - 1).transpose()
    }

    /// Returns the sample of `row`, d values, or nothing past the last row.
    #[must_use]
    pub fn sample(&self, row: usize) -> Option<DVector<f64>> {
        (row < self.len()).then(|| self.samples.row(row).transpose())
    }

    /// Interpolates linearly at `time_s`; a time outside holds the nearer end (NaN the start).
    #[must_use]
    pub fn at(&self, time_s: f64) -> DVector<f64> {
        let Some((row, u)) = self.locate(time_s) else { return self.hold(time_s) };
        (self.samples.row(row) * (1.0 - u) + self.samples.row(row + 1) * u).transpose()
    }

    /// Interpolates at `time_s` by cubic Hermite pieces through the samples with the slopes of
    /// [`Trajectory::first_derivative`], hence with a continuous velocity; a time outside holds the nearer end.
    #[must_use]
    pub fn at_smooth(&self, time_s: f64) -> DVector<f64> {
        let Some((row, u)) = self.locate(time_s) else { return self.hold(time_s) };
        let step = self.times_s[row + 1] - self.times_s[row];
        let slope = |row| {
            RowDVector::from_fn(self.dimension(), |_, column| slope(&self.times_s, &self.samples, row, column) * step)
        };
        let (u2, u3) = (u * u, u * u * u);
        let from = self.samples.row(row) * (2.0 * u3 - 3.0 * u2 + 1.0) + slope(row) * (u3 - 2.0 * u2 + u);
        let to = self.samples.row(row + 1) * (3.0 * u2 - 2.0 * u3) + slope(row + 1) * (u3 - u2);
        (from + to).transpose()
    }

    /// Resamples to `count` rows, uniform in time, by [`Trajectory::at_smooth`]; the ends are kept exactly.
    ///
    /// # Errors
    /// If `count` < 2.
    pub fn resample(&self, count: usize) -> Result<Self, SkillError> {
        if count < 2 {
            let expected = "at least 2".into();
            return Err(SkillError::RowCount { operation: "resample trajectory", found: count, expected });
        }
        let last = count - 1;
        let time = |row: usize| match row {
            row if row == last => self.end_time_s(),
            row => self.start_time_s() + self.duration_s() * (row as f64 / last as f64),
        };
        let times_s: Vec<f64> = (0..count).map(time).collect();
        let mut samples = DMatrix::zeros(count, self.dimension());
        for (row, time_s) in times_s.iter().enumerate() {
            samples.row_mut(row).tr_copy_from(&self.at_smooth(*time_s));
        }
        Self::new(times_s, samples)
    }

    /// Differentiates by time: n × d, unit of the samples per second.
    ///
    /// Second-order accurate on any grid: central differences inside, the one-sided parabola at the ends (two samples:
    /// their slope). On a uniform grid these are (x_{k+1} − x_{k−1})/2h and (−3x_0 + 4x_1 − x_2)/2h.
    #[must_use]
    pub fn first_derivative(&self) -> DMatrix<f64> {
        differentiate(&self.times_s, &self.samples)
    }

    /// Differentiates twice by time, [`Trajectory::first_derivative`] applied twice: n × d, per second squared.
    #[must_use]
    pub fn second_derivative(&self) -> DMatrix<f64> {
        differentiate(&self.times_s, &self.first_derivative())
    }

    /// Returns the length of the polygon through the samples (Euclidean over all d coordinates), in their unit.
    #[must_use]
    pub fn path_length(&self) -> f64 {
        (1..self.len()).map(|row| (self.samples.row(row) - self.samples.row(row - 1)).norm()).sum()
    }

    /// Runs the motion backwards over the same span of time.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let span = self.start_time_s() + self.end_time_s();
        let last = self.len() - 1;
        let mut times_s: Vec<f64> = self.times_s.iter().rev().map(|time_s| span - time_s).collect();
        // exact ends, so that reversing twice keeps them
        times_s[0] = self.start_time_s();
        times_s[last] = self.end_time_s();
        let samples = DMatrix::from_fn(self.len(), self.dimension(), |row, column| self.samples[(last - row, column)]);
        Self { times_s, samples }
    }

    /// Appends `next`, its clock moved to begin at this end; the sample at the joint is this trajectory's.
    ///
    /// `largest_gap` is the greatest distance of the two ends at the joint that is accepted, in the unit of the samples.
    ///
    /// # Errors
    /// If the dimensions differ, the gap is larger, or a step of `next` vanishes in the rounding of the later clock.
    pub fn concatenate(&self, next: &Self, largest_gap: f64) -> Result<Self, SkillError> {
        if next.dimension() != self.dimension() {
            return Err(SkillError::Dimension {
                operation: "concatenate trajectories",
                found: next.dimension(),
                expected: self.dimension(),
            });
        }
        let gap = (next.start() - self.end()).norm();
        if gap.is_nan() || largest_gap.is_nan() || gap > largest_gap {
            return Err(SkillError::Gap { gap, largest_gap });
        }
        let shift_s = self.end_time_s() - next.start_time_s();
        let later = next.times_s.iter().skip(1).map(|time_s| time_s + shift_s);
        let times_s = self.times_s.iter().copied().chain(later).collect();
        let samples = DMatrix::from_fn(self.len() + next.len() - 1, self.dimension(), |row, column| {
            match row.checked_sub(self.len()) {
                None => self.samples[(row, column)],
                Some(row) => next.samples[(row + 1, column)],
            }
        });
        Self::new(times_s, samples)
    }

    // the segment a time lies in and the ratio within it, in [0, 1]; nothing outside
    fn locate(&self, time_s: f64) -> Option<(usize, f64)> {
        let after = self.times_s.partition_point(|time| *time <= time_s);
        if after == 0 || after == self.len() {
            return None;
        }
        let (from, to) = (self.times_s[after - 1], self.times_s[after]);
        Some((after - 1, (time_s - from) / (to - from)))
    }

    fn hold(&self, time_s: f64) -> DVector<f64> {
        if time_s >= self.end_time_s() { self.end() } else { self.start() }
    }
}

pub(crate) fn check_times(times_s: &[f64]) -> Result<(), SkillError> {
    for (row, time_s) in times_s.iter().copied().enumerate() {
        let previous_s = times_s[row.saturating_sub(1)];
        if !time_s.is_finite() || (row > 0 && time_s <= previous_s) {
            return Err(SkillError::TimesNotIncreasing { row, previous_s, time_s });
        }
    }
    Ok(())
}

pub(crate) fn check_finite(operation: &'static str, table: &DMatrix<f64>) -> Result<(), SkillError> {
    for (column, values) in table.column_iter().enumerate() {
        if let Some(row) = values.iter().position(|value| !value.is_finite()) {
            return Err(SkillError::NonFinite { operation, row, column, found: values[row] });
        }
    }
    Ok(())
}

/// Differentiates `samples` (n × d, n ≥ 2) by `times_s` as [`Trajectory::first_derivative`] tells.
pub(crate) fn differentiate(times_s: &[f64], samples: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(samples.nrows(), samples.ncols(), |row, column| slope(times_s, samples, row, column))
}

// derivative at `row` of the parabola through it and its neighbors (at an end: through the three outermost rows)
fn slope(times_s: &[f64], samples: &DMatrix<f64>, row: usize, column: usize) -> f64 {
    let last = times_s.len() - 1;
    let secant =
        |from: usize| (samples[(from + 1, column)] - samples[(from, column)]) / (times_s[from + 1] - times_s[from]);
    if last == 1 {
        return secant(0);
    }
    let middle = row.clamp(1, last - 1);
    let (before, after) = (times_s[middle] - times_s[middle - 1], times_s[middle + 1] - times_s[middle]);
    let (into, out) = (secant(middle - 1), secant(middle));
    let curvature = (out - into) / (before + after);
    match row {
        row if row < middle => into - curvature * before,
        row if row > middle => out + curvature * after,
        _ => into + curvature * before,
    }
}

#[cfg(test)]
#[path = "trajectory_tests.rs"]
mod tests;
