//! From demonstrations past obstacles to samples of F, n and φ, Eqs. (8) and (10).

use nalgebra::{DMatrix, DVector};

use super::IdentificationData;
use super::data::OPERATION;
use crate::coupling::Hoffmann;
use crate::error::SkillError;
use crate::primitive::{Dmp, DmpConfig, DmpForm};
use crate::time_law::{minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative};
use crate::trajectory::Trajectory;

/// Demonstration past one obstacle or none.
#[derive(Debug, Clone, PartialEq)]
pub struct ObstructedDemonstration {
    /// Motion shown, n × d with d ≥ 2, in the frame of the obstacle.
    pub trajectory: Trajectory,
    /// Position of the obstacle, d values in the unit and frame of the motion (fewer: a post, see [`Hoffmann`]); none if
    /// the motion was free.
    pub obstacle: Option<Vec<f64>>,
    /// Goal g of Eq. (8), d values in the unit and frame of the motion; by default the end of the motion. Tell it where the
    /// turn left the motion short of its goal: an error of the goal counts αβ times in F.
    pub goal: Option<Vec<f64>>,
}

/// Gathers F by Eq. (8), n and φ along all `demonstrations`, in their order; `primitive` was validated.
pub(super) fn gather(
    primitive: &DmpConfig,
    demonstrations: &[ObstructedDemonstration],
    trajectories: &[Trajectory],
) -> Result<IdentificationData, SkillError> {
    let mut samples = Dmp::forcing_samples(primitive, trajectories, &vec![1.0; trajectories.len()])?;
    let (rows, dimension) = samples.targets.shape();
    if dimension < 2 {
        return Err(SkillError::Dimension { operation: OPERATION, found: dimension, expected: 2 });
    }
    let mut directions = DMatrix::zeros(rows, dimension);
    let mut angles = DVector::zeros(rows);
    let mut first = 0;
    for (index, shown) in demonstrations.iter().enumerate() {
        let count = shown.trajectory.len();
        if let Some(obstacle) = &shown.obstacle {
            check_point(index, obstacle, 2, dimension)?;
            let (along, turned) = features_along(&shown.trajectory, obstacle);
            directions.rows_mut(first, count).copy_from(&along);
            angles.rows_mut(first, count).copy_from(&turned);
        }
        if let Some(goal) = &shown.goal {
            check_point(index, goal, dimension, dimension)?;
            let mut targets = samples.targets.rows_mut(first, count);
            targets += change_of_goal(primitive, &shown.trajectory, goal);
        }
        first += count;
    }
    IdentificationData::new(samples, directions, angles)
}

fn check_point(row: usize, point: &[f64], least: usize, dimension: usize) -> Result<(), SkillError> {
    if !(least..=dimension).contains(&point.len()) {
        return Err(SkillError::Dimension { operation: OPERATION, found: point.len(), expected: dimension });
    }
    match point.iter().enumerate().find(|(_, value)| !value.is_finite()) {
        None => Ok(()),
        Some((column, found)) => Err(SkillError::NonFinite { operation: OPERATION, row, column, found: *found }),
    }
}

// n and φ along a demonstration, with v = τẋ and τ its duration
fn features_along(trajectory: &Trajectory, obstacle: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
    // columns are samples, so that each is a slice
    let positions = trajectory.samples().transpose();
    let velocities = trajectory.first_derivative().transpose() * trajectory.duration_s();
    let mut directions = DMatrix::zeros(positions.nrows(), positions.ncols());
    let mut angles = DVector::zeros(positions.ncols());
    let columns = positions.column_iter().zip(velocities.column_iter()).zip(directions.column_iter_mut());
    for (((position, velocity), mut direction), angle) in columns.zip(angles.iter_mut()) {
        *angle = Hoffmann::features(position.as_slice(), velocity.as_slice(), obstacle, direction.as_mut_slice());
    }
    (directions.transpose(), angles)
}

// F for `goal` less F for the end of the motion: the response of the attractor to the difference of the two baselines
fn change_of_goal(primitive: &DmpConfig, trajectory: &Trajectory, goal: &[f64]) -> DMatrix<f64> {
    let (start_s, duration_s) = (trajectory.start_time_s(), trajectory.duration_s());
    let (alpha, stiffness) = (primitive.alpha, 0.25 * primitive.alpha * primitive.alpha);
    let response = |time_s: f64| {
        let r = (time_s - start_s) / duration_s;
        match primitive.form {
            DmpForm::Residual => {
                let (position, first) = (minimum_jerk(r), minimum_jerk_first_derivative(r));
                minimum_jerk_second_derivative(r) + alpha * first + stiffness * position
            }
            DmpForm::Eq1Literal | DmpForm::Scaled => stiffness,
        }
    };
    let responses =
        DVector::from_iterator(trajectory.len(), trajectory.times_s().iter().map(|time_s| response(*time_s)));
    let missed = trajectory.end() - DVector::from_column_slice(goal);
    responses * missed.transpose()
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    /// Error of second differences of mj over steps of a hundredth: h²/3·max |mj⁗| = 1e-4/3·360.
    const DIFFERENCES: f64 = 0.02;
    /// A few roundings, magnified by second differences.
    const ROUNDING: f64 = 1e-9;

    // F of Eq. (8) along x = r for the goal 2, α = 4, with the baseline and its derivatives
    fn by_hand(r: f64, baseline: [f64; 3]) -> f64 {
        -baseline[2] + 4.0 * (1.0 - baseline[1]) + 4.0 * (r - baseline[0])
    }

    #[test]
    fn a_line_that_stops_halfway_is_driven_to_the_goal_that_was_told() {
        let literal = |_: f64| [2.0, 0.0, 0.0];
        let residual = |r: f64| {
            let derivatives = [minimum_jerk_first_derivative(r), minimum_jerk_second_derivative(r)];
            [2.0 * minimum_jerk(r), 2.0 * derivatives[0], 2.0 * derivatives[1]]
        };
        let table = DMatrix::from_fn(101, 2, |row, k| if k == 0 { row as f64 / 100.0 } else { 0.0 });
        let line = Trajectory::uniform(0.03, table).unwrap();
        let shown = ObstructedDemonstration { trajectory: line.clone(), obstacle: None, goal: Some(vec![2.0, 0.0]) };
        let targets = |form: DmpForm| {
            let config = DmpConfig { form, alpha: 4.0, ..DmpConfig::default() };
            gather(&config, std::slice::from_ref(&shown), std::slice::from_ref(&line)).unwrap().targets().clone()
        };
        let (in_residual, in_literal) = (targets(DmpForm::Residual), targets(DmpForm::Eq1Literal));
        for row in 5..=95 {
            let r = row as f64 / 100.0;
            assert_relative_eq!(in_literal[(row, 0)], by_hand(r, literal(r)), epsilon = ROUNDING);
            assert_relative_eq!(in_residual[(row, 0)], by_hand(r, residual(r)), epsilon = DIFFERENCES);
        }
    }
}
