//! The reference distribution: mean and covariance of the demonstrations' shapes at instants uniform in time.
//!
//! Departs from the article, which gets them by Gaussian mixture regression: here demonstrations are aligned by time over
//! duration and mean and covariance taken at each instant, without a mixture to initialize and iterate. Coordinates are
//! treated apart; of each, value and rate vary together, so that the ways in which demonstrations differ are learned too.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::config::KernelizedConfig;
use crate::error::SkillError;
use crate::primitive::dmp::common_dimension;
use crate::time_law::{MinimumJerkTransfer, PathState};
use crate::trajectory::Trajectory;

/// Part of a coordinate's range below which its shape counts as noise on a minimum-jerk transfer.
const LEAST_SHAPE: f64 = 1e-3;

/// Reference distribution of one coordinate's residual about the transfer between its ends, at N instants.
///
/// Values are in units of `scale`, rates in the same unit per length scale of the kernel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Root mean square of the shown residuals, unit of the demonstrations.
    pub scale: f64,
    /// Mean of value and rate.
    pub means: Vec<[f64; 2]>,
    /// Variance of the value, covariance of value and rate, variance of the rate.
    pub covariances: Vec<[f64; 3]>,
}

/// Gathers the reference distribution of each coordinate.
pub(super) fn references(
    config: &KernelizedConfig,
    demonstrations: &[Trajectory],
) -> Result<Vec<Reference>, SkillError> {
    let dimension = common_dimension(demonstrations)?;
    let shapes = demonstrations.iter().map(|shown| Shape::of(config, shown)).collect::<Result<Vec<_>, _>>()?;
    let references: Vec<Reference> = (0..dimension).map(|k| reference(config, &shapes, k)).collect();
    match references.iter().find(|reference| !reference.scale.is_finite()) {
        None => Ok(references),
        Some(Reference { scale, .. }) => Err(SkillError::InvalidArgument {
            operation: "learn primitive",
            argument: "size of the demonstrations",
            found: *scale,
            expected: "samples whose squares do not overflow",
        }),
    }
}

/// Progress of reference `index`.
pub(super) fn progress(config: &KernelizedConfig, index: usize) -> f64 {
    index as f64 / (config.references - 1) as f64
}

/// Part of the duration within which a velocity at an end is taken up by the transfer.
const END_HORIZON: f64 = 0.25;

/// Transfer of one coordinate over progress: from a start in motion to a goal, in motion only where a demonstration was.
///
/// x0 + (g − x0)·mj(u) + v0·H·h(u/H) − v1·H·h((1 − u)/H) with h(r) = r − 6r³ + 8r⁴ − 3r⁵ on [0, 1]: the minimum-jerk transfer,
/// and what is least in jerk to bring a velocity at either end to rest on the spot within H, a quarter of the duration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Transfer {
    straight: MinimumJerkTransfer,
    take_up: MinimumJerkTransfer,
    run_out: MinimumJerkTransfer,
}

impl Transfer {
    /// Plans from `start` to `goal` with the given rates by progress at either end.
    pub(super) fn new(start: f64, goal: f64, start_rate: f64, goal_rate: f64) -> Self {
        let at = |position| PathState { position, ..PathState::default() };
        let moving = |first| PathState { first, ..PathState::default() };
        Self {
            straight: MinimumJerkTransfer::new(0.0, at(start), goal, 1.0),
            take_up: MinimumJerkTransfer::new(0.0, moving(start_rate), 0.0, END_HORIZON),
            run_out: MinimumJerkTransfer::new(0.0, moving(goal_rate), 0.0, END_HORIZON),
        }
    }

    /// Evaluates the transfer with its derivatives by progress.
    pub(super) fn at(&self, progress: f64) -> PathState {
        let (straight, up, out) =
            (self.straight.at(progress), self.take_up.at(progress), self.run_out.at(1.0 - progress));
        PathState {
            position: straight.position + up.position - out.position,
            first: straight.first + up.first + out.first,
            second: straight.second + up.second - out.second,
        }
    }
}

// residual of a demonstration and its rate by progress at the references, N × d each
struct Shape {
    values: DMatrix<f64>,
    rates: DMatrix<f64>,
    /// Greatest less smallest sample of each coordinate.
    ranges: DVector<f64>,
}

impl Shape {
    fn of(config: &KernelizedConfig, shown: &Trajectory) -> Result<Self, SkillError> {
        let (start, goal) = (shown.start(), shown.end());
        let (from_s, duration_s) = (shown.start_time_s(), shown.duration_s());
        let along: Vec<f64> = shown.times_s().iter().map(|time_s| (time_s - from_s) / duration_s).collect();
        let rates = shown.first_derivative() * duration_s;
        let last = shown.len() - 1;
        let transfers: Vec<_> =
            (0..shown.dimension()).map(|k| Transfer::new(start[k], goal[k], rates[(0, k)], rates[(last, k)])).collect();
        let residual = DMatrix::from_fn(shown.len(), shown.dimension(), |row, k| {
            shown.samples()[(row, k)] - transfers[k].at(along[row]).position
        });
        let residual = Trajectory::new(along.clone(), residual)?;
        let rate = Trajectory::new(along, residual.first_derivative())?;
        let sampled = |of: &Trajectory| {
            let rows = (0..config.references).map(|index| of.at_smooth(progress(config, index)).transpose());
            DMatrix::from_rows(&rows.collect::<Vec<_>>())
        };
        let ranges = shown.samples().column_iter().map(|column| column.max() - column.min());
        let ranges = DVector::from_iterator(shown.dimension(), ranges);
        Ok(Self { values: sampled(&residual), rates: sampled(&rate), ranges })
    }
}

fn reference(config: &KernelizedConfig, shapes: &[Shape], k: usize) -> Reference {
    let count = shapes.len() as f64;
    let squares: f64 = shapes.iter().map(|shape| shape.values.column(k).norm_squared()).sum();
    let range = shapes.iter().map(|shape| shape.ranges[k]).fold(0.0, f64::max);
    let shown = (squares / (count * config.references as f64)).sqrt().max(LEAST_SHAPE * range);
    let scale = if shown > f64::MIN_POSITIVE { shown } else { 1.0 };
    let least = config.deviation * config.deviation;
    let at = |shape: &Shape, row: usize| {
        [shape.values[(row, k)] / scale, shape.rates[(row, k)] * config.length_scale / scale]
    };
    let mean = |row: usize| {
        let sum = shapes.iter().map(|shape| at(shape, row)).fold([0.0; 2], |sum, [x, v]| [sum[0] + x, sum[1] + v]);
        sum.map(|sum| sum / count)
    };
    let means: Vec<[f64; 2]> = (0..config.references).map(mean).collect();
    let covariance = |row: usize| {
        let mut sum = [0.0; 3];
        for [x, v] in shapes.iter().map(|shape| at(shape, row)) {
            let (x, v) = (x - means[row][0], v - means[row][1]);
            sum = [sum[0] + x * x, sum[1] + x * v, sum[2] + v * v];
        }
        let [xx, xv, vv] = sum.map(|sum| sum / (count - 1.0).max(1.0));
        [xx + least, xv, vv + least]
    };
    let covariances = (0..config.references).map(covariance).collect();
    Reference { scale, means, covariances }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::time_law::minimum_jerk;

    /// Error of differences over a hundredth of the duration.
    const DIFFERENCE: f64 = 1e-2;

    fn bump(height: f64, duration_s: f64) -> Trajectory {
        let at = |row: usize| {
            let r = row as f64 / 200.0;
            3.0 + 2.0 * minimum_jerk(r) + height * 16.0 * (r * (1.0 - r)).powi(2)
        };
        Trajectory::uniform(duration_s / 200.0, DMatrix::from_fn(201, 1, |row, _| at(row))).unwrap()
    }

    #[test]
    fn mean_and_covariance_are_those_of_the_shapes_at_equal_progress() {
        let config = KernelizedConfig { references: 21, ..KernelizedConfig::default() };
        let all = references(&config, &[bump(1.0, 2.0), bump(3.0, 5.0)]).unwrap();
        let Reference { scale, means, covariances } = &all[0];
        // heights 1 and 3 at half time: mean 2, variance 2
        assert_relative_eq!(means[10][0] * scale, 2.0, epsilon = 1e-9);
        assert_relative_eq!((covariances[10][0] - 1e-6) * scale * scale, 2.0, epsilon = 1e-9);
        // rates of 16(r − r²)² at r = 1/4: 16·2·(3/16)·(1/2) = 3 per height
        assert_relative_eq!(means[5][1] * scale / config.length_scale, 6.0, epsilon = DIFFERENCE);
        let variance = covariances[5][2] * (scale / config.length_scale).powi(2);
        assert_relative_eq!(variance, 18.0, epsilon = 10.0 * DIFFERENCE);
    }

    #[test]
    fn a_standing_coordinate_has_the_unit_as_its_scale() {
        let standing = Trajectory::uniform(0.5, DMatrix::repeat(3, 1, 4.0)).unwrap();
        assert_eq!(references(&KernelizedConfig::default(), &[standing]).unwrap()[0].scale, 1.0);
    }

    #[test]
    fn a_transfer_has_the_places_and_rates_of_its_ends() {
        let transfer = Transfer::new(2.0, 5.0, 7.0, -3.0);
        let (start, goal) = (transfer.at(0.0), transfer.at(1.0));
        assert_eq!((start.position, start.first, start.second), (2.0, 7.0, 0.0));
        assert_eq!((goal.position, goal.first, goal.second), (5.0, -3.0, 0.0));
        // at half time velocities at the ends have long been brought to rest
        assert_eq!(transfer.at(0.5), Transfer::new(2.0, 5.0, 0.0, 0.0).at(0.5));
        let h = 1e-6;
        for progress in [0.1, 0.4, 0.9] {
            let [before, here, after] = [progress - h, progress, progress + h].map(|progress| transfer.at(progress));
            assert_relative_eq!((after.position - before.position) / (2.0 * h), here.first, epsilon = 1e-7);
            assert_relative_eq!((after.first - before.first) / (2.0 * h), here.second, epsilon = 1e-5);
        }
    }

    #[test]
    fn the_shape_of_a_demonstration_in_motion_at_its_ends_is_at_rest_there() {
        let moving = Trajectory::uniform(0.01, DMatrix::from_fn(101, 1, |row, _| row as f64)).unwrap();
        let [reference] = &references(&KernelizedConfig::default(), &[moving]).unwrap()[..] else {
            panic!("one coordinate")
        };
        for index in [0, 49] {
            assert!(reference.means[index].iter().all(|mean| mean.abs() < DIFFERENCE), "{:?}", reference.means[index]);
        }
    }
}
