//! From demonstrations to samples of the forcing term, Eq. (5), in time over duration.
//!
//! Departs from the paper: derivatives are taken by t/τ, so that demonstrations of any duration share their samples;
//! a sample weighs by the part of the duration it stands for, so that each demonstration counts the same however densely
//! or unevenly it was recorded.

use nalgebra::{DMatrix, DVector};

use super::attractor::Attractor;
use super::config::DmpForm;
use crate::canonical::CanonicalSystem;
use crate::error::SkillError;
use crate::regression::ForcingSamples;
use crate::time_law::minimum_jerk;
use crate::trajectory::{Trajectory, check_finite, differentiate};

/// Part of a demonstration's peak speed up to which it counts as ending at rest; above the error of one-sided differences
/// of a minimum-jerk motion from 20 samples on.
const REST: f64 = 0.05;
/// Part of a coordinate's range that goal and start must lie apart for a scaled forcing term.
const SMALLEST_DISPLACEMENT: f64 = 1e-3;

/// Checks that there are demonstrations, all of one dimension, and returns that dimension.
pub(in crate::primitive) fn common_dimension(demonstrations: &[Trajectory]) -> Result<usize, SkillError> {
    let expected = demonstrations.first().ok_or(SkillError::NoDemonstrations)?.dimension();
    for (demonstration, trajectory) in demonstrations.iter().enumerate() {
        let found = trajectory.dimension();
        if found != expected {
            return Err(SkillError::DemonstrationDimension { demonstration, found, expected });
        }
    }
    Ok(expected)
}

// one weight per demonstration, at least one of them above zero
fn check_weights(weights: &[f64], demonstrations: usize) -> Result<(), SkillError> {
    let refused = |argument, found, expected| {
        Err(SkillError::InvalidArgument { operation: "learn primitive", argument, found, expected })
    };
    if weights.len() != demonstrations {
        return refused("number of weights", weights.len() as f64, "one per demonstration");
    }
    if let Some(found) = weights.iter().find(|weight| !(weight.is_finite() && **weight >= 0.0)) {
        return refused("weight", *found, "a finite number of at least 0");
    }
    if weights.iter().all(|weight| *weight == 0.0) {
        return refused("sum of weights", 0.0, "more than 0");
    }
    Ok(())
}

/// Gathers the forcing samples of all demonstrations, unscaled, each weighing as its demonstration and as the time it
/// stands for.
pub(super) fn forcing_samples(
    form: DmpForm,
    attractor: Attractor,
    canonical: CanonicalSystem,
    demonstrations: &[Trajectory],
    weights: &[f64],
) -> Result<ForcingSamples, SkillError> {
    let rows = demonstrations.iter().map(Trajectory::len).sum();
    let dimension = common_dimension(demonstrations)?;
    check_weights(weights, demonstrations.len())?;
    let mut samples = ForcingSamples {
        phases: DVector::zeros(rows),
        targets: DMatrix::zeros(rows, dimension),
        weights: DVector::zeros(rows),
    };
    let mut first = 0;
    for (trajectory, weight) in demonstrations.iter().zip(weights) {
        let progress = progress(trajectory);
        let count = progress.len();
        samples
            .phases
            .rows_mut(first, count)
            .copy_from_slice(&progress.iter().map(|progress| canonical.phase(*progress)).collect::<Vec<_>>());
        samples.weights.rows_mut(first, count).copy_from(&(DVector::from_vec(spacing(&progress)) * *weight));
        samples.targets.rows_mut(first, count).copy_from(&targets(form, attractor, &progress, trajectory));
        first += count;
    }
    check_finite("learn primitive", &samples.targets)?;
    Ok(samples)
}

/// Divides the targets of one coordinate by the displacement of their demonstration and weighs them by its square, which
/// leaves the sum of squares of Eq. (4) that of the undivided targets.
///
/// # Errors
/// If a demonstration displaces the coordinate by too little.
pub(super) fn scale_by_displacement(
    samples: &ForcingSamples,
    coordinate: usize,
    demonstrations: &[Trajectory],
) -> Result<ForcingSamples, SkillError> {
    let mut scaled = ForcingSamples {
        phases: samples.phases.clone(),
        targets: samples.targets.columns(coordinate, 1).into_owned(),
        weights: samples.weights.clone(),
    };
    let mut first = 0;
    for (demonstration, trajectory) in demonstrations.iter().enumerate() {
        let values = trajectory.samples().column(coordinate);
        let displacement = values[values.len() - 1] - values[0];
        let smallest = SMALLEST_DISPLACEMENT * (values.max() - values.min());
        let rows = trajectory.len();
        // one that is left out need not be scaled
        if samples.weights.rows(first, rows).amax() > 0.0 {
            if displacement.abs() <= smallest {
                return Err(SkillError::NoDisplacement { demonstration, coordinate, displacement, smallest });
            }
            scaled.targets.rows_mut(first, rows).scale_mut(displacement.recip());
            scaled.weights.rows_mut(first, rows).scale_mut(displacement * displacement);
        }
        first += rows;
    }
    Ok(scaled)
}

/// Returns the speed at the end, and whether the demonstration comes to rest there.
pub(super) fn end_speed(demonstration: &Trajectory) -> (f64, bool) {
    let velocity = demonstration.first_derivative();
    let speeds = velocity.row_iter().map(|row| row.norm());
    let (end, peak) = speeds.fold((0.0, 0.0f64), |(_, peak), speed| (speed, peak.max(speed)));
    (end, end <= REST * peak)
}

fn progress(trajectory: &Trajectory) -> Vec<f64> {
    let (start_s, duration_s) = (trajectory.start_time_s(), trajectory.duration_s());
    trajectory.times_s().iter().map(|time_s| (time_s - start_s) / duration_s).collect()
}

// the part of the motion each sample stands for; an end stands for a whole interval, so that a uniform grid weighs evenly
fn spacing(progress: &[f64]) -> Vec<f64> {
    let last = progress.len() - 1;
    let width = |row: usize| match row {
        0 => progress[1] - progress[0],
        row if row == last => progress[last] - progress[last - 1],
        row => 0.5 * (progress[row + 1] - progress[row - 1]),
    };
    (0..=last).map(width).collect()
}

// Eq. (5) with derivatives by progress: f = u'' + α(βu + u'), u the distance from what the attractor is tied to
fn targets(form: DmpForm, attractor: Attractor, progress: &[f64], trajectory: &Trajectory) -> DMatrix<f64> {
    let (start, goal) = (trajectory.start(), trajectory.end());
    let reached = |row: usize| match form {
        DmpForm::Residual => minimum_jerk(progress[row]),
        DmpForm::Eq1Literal | DmpForm::Scaled => 1.0,
    };
    let offset = DMatrix::from_fn(progress.len(), trajectory.dimension(), |row, k| {
        trajectory.samples()[(row, k)] - (start[k] + (goal[k] - start[k]) * reached(row))
    });
    let rate = differentiate(progress, &offset);
    let acceleration = differentiate(progress, &rate);
    offset.zip_zip_map(&rate, &acceleration, |u, v, acceleration| attractor.forcing_target(u, v, acceleration))
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::dmatrix;

    use super::*;

    /// A few roundings.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn a_straight_line_needs_the_forcing_term_of_equation_5() {
        // x = t, τ = T = 2, g = 2: v = τẋ = 2, τv̇ = 0, f = −α(β(g − x) − v)
        let line = Trajectory::uniform(0.5, DMatrix::from_fn(5, 1, |row, _| 0.5 * row as f64)).unwrap();
        let samples =
            forcing_samples(DmpForm::Eq1Literal, Attractor::new(4.0), CanonicalSystem::new(1.0), &[line], &[1.0])
                .unwrap();
        for row in 0..5 {
            let x = 0.5 * row as f64;
            assert_relative_eq!(samples.targets[(row, 0)], -4.0 * ((2.0 - x) - 2.0), epsilon = ROUNDING);
            assert_relative_eq!(samples.phases[row], (-x / 2.0).exp(), max_relative = ROUNDING);
        }
    }

    #[test]
    fn samples_weigh_by_the_time_they_stand_for() {
        assert_eq!(spacing(&[0.0, 0.25, 0.5, 1.0]), [0.25, 0.25, 0.375, 0.5]);
    }

    #[test]
    fn a_minimum_jerk_motion_rests_and_its_first_half_does_not() {
        let samples = DMatrix::from_fn(41, 1, |row, _| minimum_jerk(row as f64 / 40.0));
        let whole = Trajectory::uniform(0.05, samples.clone()).unwrap();
        let half = Trajectory::uniform(0.05, samples.rows(0, 21).into_owned()).unwrap();
        assert!(end_speed(&whole).1);
        let (speed, rests) = end_speed(&half);
        assert!(!rests);
        // 1.875/T at half time, to the error of a one-sided parabola over steps of T/40
        assert_relative_eq!(speed, 1.875 / 2.0, max_relative = 0.02);
    }

    #[test]
    fn a_standing_demonstration_rests() {
        let standing = Trajectory::uniform(0.1, dmatrix![1.0; 1.0; 1.0]).unwrap();
        assert_eq!(end_speed(&standing), (0.0, true));
    }
}
