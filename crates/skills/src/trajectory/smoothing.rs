//! Freeing a recording of its noise: derivatives, which primitives are learned from, amplify it.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::Trajectory;
use crate::error::SkillError;

/// Standard deviations after which the kernel ends.
const REACH: f64 = 4.0;

/// What a motion is taken to do before its first and after its last sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ends {
    /// It comes back as it went, so that it begins and ends at rest: right for what was shown from rest to rest, of which
    /// noise would else be learned as a speed at the ends.
    #[default]
    Resting,
    /// It goes on as it came, turned about the end: both ends stay where they are, and straight motion is kept.
    Moving,
}

impl Trajectory {
    /// Smooths by a Gaussian of the standard deviation σ = `standard_deviation_s` (> 0, s), on the same times.
    ///
    /// Motion of frequency f is kept up to the part e^{−(2πfσ)²/2}: 0.1 s halves what swings at 1.9 Hz, which leaves the
    /// voluntary motion of a hand and takes its tremor and most noise of a sensor. A sample weighs by the time it stands
    /// for.
    ///
    /// # Errors
    /// If the standard deviation is not a positive finite number.
    pub fn smoothed(&self, standard_deviation_s: f64, ends: Ends) -> Result<Self, SkillError> {
        if !(standard_deviation_s > 0.0 && standard_deviation_s.is_finite()) {
            return Err(SkillError::InvalidArgument {
                operation: "smooth trajectory",
                argument: "standard_deviation_s",
                found: standard_deviation_s,
                expected: "a positive finite number",
            });
        }
        let mut samples = DMatrix::zeros(self.len(), self.dimension());
        for row in 0..self.len() {
            let kernel = Kernel { center_s: self.times_s[row], standard_deviation_s };
            let mut mean = vec![0.0; self.dimension()];
            let total = self.average(&kernel, ends, &mut mean);
            for (column, sum) in mean.iter().enumerate() {
                samples[(row, column)] = sum / total;
            }
        }
        if ends == Ends::Moving {
            // there the mirrored halves cancel but for rounding
            let last = self.len() - 1;
            samples.set_row(0, &self.samples.row(0));
            samples.set_row(last, &self.samples.row(last));
        }
        Self::new(self.times_s.clone(), samples)
    }

    // adds up the weighted samples, those mirrored at both ends too, into `sum`; returns the sum of the weights
    fn average(&self, kernel: &Kernel, ends: Ends, sum: &mut [f64]) -> f64 {
        let last = self.len() - 1;
        let mut total = 0.0;
        for mirror in [None, Some(0), Some(last)] {
            let at_s = |row: usize| mirror.map_or(self.times_s[row], |end| 2.0 * self.times_s[end] - self.times_s[row]);
            let (from_s, to_s) = kernel.span_s();
            // the samples within the reach; mirrored ones lie in a span that is mirrored alike
            let (low_s, high_s) = match mirror {
                None => (from_s, to_s),
                Some(end) => (2.0 * self.times_s[end] - to_s, 2.0 * self.times_s[end] - from_s),
            };
            let begin = self.times_s.partition_point(|time_s| *time_s < low_s);
            let end = self.times_s.partition_point(|time_s| *time_s <= high_s);
            for row in begin..end {
                // the end itself is there once
                if mirror == Some(row) {
                    continue;
                }
                let weight = kernel.at(at_s(row)) * self.time_of(row);
                total += weight;
                for (column, sum) in sum.iter_mut().enumerate() {
                    let value = self.samples[(row, column)];
                    *sum += weight
                        * match (mirror, ends) {
                            (Some(end), Ends::Moving) => 2.0 * self.samples[(end, column)] - value,
                            _ => value,
                        };
                }
            }
        }
        total
    }

    // the time a sample stands for, s; the motion goes on beyond the ends
    fn time_of(&self, row: usize) -> f64 {
        let last = self.len() - 1;
        match row {
            0 => self.times_s[1] - self.times_s[0],
            row if row == last => self.times_s[last] - self.times_s[last - 1],
            _ => 0.5 * (self.times_s[row + 1] - self.times_s[row - 1]),
        }
    }
}

struct Kernel {
    center_s: f64,
    standard_deviation_s: f64,
}

impl Kernel {
    fn span_s(&self) -> (f64, f64) {
        let reach_s = REACH * self.standard_deviation_s;
        (self.center_s - reach_s, self.center_s + reach_s)
    }

    // lowered to nothing at its end, so that it matters to no one whether rounding puts a sample inside or outside
    fn at(&self, time_s: f64) -> f64 {
        let gaussian = |deviations: f64| (-0.5 * deviations * deviations).exp();
        (gaussian((time_s - self.center_s) / self.standard_deviation_s) - gaussian(REACH)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::*;

    /// A kernel that ends at four standard deviations, lowered to nothing there, is narrower by some thousandths.
    const CUT: f64 = 5e-3;
    /// A few hundred roundings.
    const ROUNDING: f64 = 1e-12;

    fn sampled(step_s: f64, count: usize, at: impl Fn(f64) -> f64) -> Trajectory {
        Trajectory::uniform(step_s, DMatrix::from_fn(count, 1, |row, _| at(row as f64 * step_s))).unwrap()
    }

    #[test]
    fn a_swing_is_damped_as_the_gaussian_says_and_not_shifted() {
        for (frequency_hz, deviation_s) in [(0.5, 0.1), (1.9, 0.1), (5.0, 0.05)] {
            let swing = |time_s: f64| (TAU * frequency_hz * time_s).sin();
            let smooth = sampled(0.002, 2001, swing).smoothed(deviation_s, Ends::Resting).unwrap();
            let share = (-0.5 * (TAU * frequency_hz * deviation_s).powi(2)).exp();
            for row in [900, 1000, 1111] {
                let expected = share * swing(0.002 * row as f64);
                assert!((smooth.samples()[(row, 0)] - expected).abs() < CUT, "{frequency_hz} Hz at row {row}");
            }
        }
    }

    #[test]
    fn resting_ends_come_to_rest_and_moving_ones_stay_where_they_are() {
        let straight = sampled(0.01, 301, |time_s| 0.2 * time_s);
        let moving = straight.smoothed(0.1, Ends::Moving).unwrap();
        assert_relative_eq!(moving.samples(), straight.samples(), epsilon = ROUNDING);
        assert_eq!((moving.start(), moving.end()), (straight.start(), straight.end()));
        let resting = straight.smoothed(0.1, Ends::Resting).unwrap();
        let speeds = resting.first_derivative();
        // 0.2 m/s within the first and last hundredth of a second from rest: less than a tenth is left
        assert!(speeds[(0, 0)].abs() < 0.02 && speeds[(300, 0)].abs() < 0.02, "{speeds}");
        assert_relative_eq!(speeds[(150, 0)], 0.2, max_relative = CUT);
        // half a Gaussian lies on each side of the end: the mean of 0.2·|t| is 0.2·σ·√(2/π)
        assert_relative_eq!(resting.start()[0], 0.02 * (2.0 / std::f64::consts::PI).sqrt(), max_relative = 1e-2);
    }

    // white noise of variance 1 at steps h keeps h/(2√π·σ) of it
    #[test]
    fn white_noise_loses_the_share_of_variance_that_the_kernel_averages() {
        let mut state = 7_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let noise = DMatrix::from_fn(20_000, 1, |_, _| uniform() * 3f64.sqrt());
        let smooth = Trajectory::uniform(0.01, noise).unwrap().smoothed(0.1, Ends::Resting).unwrap();
        let variance = smooth.samples().norm_squared() / 20_000.0;
        let expected = 0.01 / (2.0 * std::f64::consts::PI.sqrt() * 0.1);
        // some 560 independent stretches of 2√π·σ: the variance of them is known to 6 %, taken three times
        assert!((variance / expected - 1.0).abs() < 0.18, "{variance} instead of {expected}");
    }

    #[test]
    fn a_width_that_is_none_is_refused() {
        let straight = sampled(0.01, 3, |time_s| time_s);
        for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(straight.smoothed(width, Ends::default()).is_err(), "{width}");
        }
    }

    proptest! {
        #[test]
        fn a_constant_is_kept_on_any_times_and_nothing_leaves_the_range(
            steps in prop::collection::vec(1e-3f64..0.3, 1..40), values in prop::collection::vec(-1.0f64..1.0, 41),
            deviation_s in 1e-3f64..1.0,
        ) {
            let mut times_s = vec![0.0];
            times_s.extend(steps.iter().scan(0.0, |time_s, step| { *time_s += step; Some(*time_s) }));
            let count = times_s.len();
            let constant = Trajectory::new(times_s.clone(), DMatrix::repeat(count, 1, 0.7)).unwrap();
            for ends in [Ends::Resting, Ends::Moving] {
                let smooth = constant.smoothed(deviation_s, ends).unwrap();
                prop_assert!((smooth.samples().add_scalar(-0.7)).amax() < ROUNDING);
            }
            let rough = Trajectory::new(times_s, DMatrix::from_fn(count, 1, |row, _| values[row])).unwrap();
            let smooth = rough.smoothed(deviation_s, Ends::Resting).unwrap();
            prop_assert!(smooth.samples().max() <= rough.samples().max() + ROUNDING);
            prop_assert!(smooth.samples().min() >= rough.samples().min() - ROUNDING);
        }
    }
}
