//! What is asked of a movement primitive, and what a rollout yields.

use nalgebra::{DMatrix, DVector};

use crate::error::SkillError;
use crate::trajectory::{Trajectory, check_finite};

/// Most steps one rollout may take, which bounds its memory: 1000 s at 1 kHz.
const MOST_STEPS: f64 = 1e6;
/// Part of a time step below which the duration counts as a whole number of steps.
const WHOLE_STEP: f64 = 1e-6;

/// Start, goal and timing of a rollout; d is the dimension of the primitive.
#[derive(Debug, Clone, PartialEq)]
pub struct RolloutRequest {
    /// Start x0: d values, unit and frame of the demonstrations.
    pub start: DVector<f64>,
    /// Goal g: d values, unit and frame of the demonstrations.
    pub goal: DVector<f64>,
    /// Duration T = τ of the motion, s.
    pub duration_s: f64,
    /// Time between samples, s; at most the duration. A shorter step lands on T if T is no multiple of it.
    pub time_step_s: f64,
    /// Velocity at the start: d values, unit of the demonstrations per second; at rest if absent.
    pub start_velocity: Option<DVector<f64>>,
    /// Time to go on after T while the motion settles at the goal, s.
    pub settle_s: f64,
}

impl RolloutRequest {
    /// Asks for a motion that starts at rest and ends at T.
    #[must_use]
    pub fn new(start: DVector<f64>, goal: DVector<f64>, duration_s: f64, time_step_s: f64) -> Self {
        Self { start, goal, duration_s, time_step_s, start_velocity: None, settle_s: 0.0 }
    }

    /// Checks the request against the `dimension` of a primitive.
    ///
    /// # Errors
    /// If a vector has another length or a value that is not finite, or a time is outside its range.
    pub fn validate(&self, dimension: usize) -> Result<(), SkillError> {
        check_vector("start", dimension, self.start.as_slice())?;
        check_vector("goal", dimension, self.goal.as_slice())?;
        if let Some(velocity) = &self.start_velocity {
            check_vector("start_velocity", dimension, velocity.as_slice())?;
        }
        let (duration_s, step_s) = (self.duration_s, self.time_step_s);
        check(duration_s.is_finite() && duration_s > 0.0, "duration_s", duration_s, "a positive finite number")?;
        check(step_s > 0.0 && step_s <= duration_s, "time_step_s", step_s, "more than 0 and at most the duration")?;
        let settles = self.settle_s.is_finite() && self.settle_s >= 0.0;
        check(settles, "settle_s", self.settle_s, "a finite number of at least 0")?;
        let few = (duration_s + self.settle_s) / step_s <= MOST_STEPS;
        check(few, "time_step_s", step_s, "at most 1000000 steps in a rollout")
    }

    /// Returns the steps of a rollout, s: `time_step_s` until T, one shorter step onto T if T is no multiple of it, then
    /// `time_step_s` again until the settling time has passed. Those of a request that [`RolloutRequest::validate`] refuses
    /// mean nothing, but are no more than two million.
    pub fn time_steps_s(&self) -> impl Iterator<Item = f64> + use<> {
        let step_s = self.time_step_s;
        let (whole, rest_s) = self.whole_steps();
        let settling = (self.settle_s / step_s - WHOLE_STEP).ceil().clamp(0.0, MOST_STEPS) as usize;
        std::iter::repeat_n(step_s, whole).chain(rest_s).chain(std::iter::repeat_n(step_s, settling))
    }

    /// Returns the times of the samples of a rollout, s: 0, one per whole step, T, and those of settling.
    #[must_use]
    pub fn times_s(&self) -> Vec<f64> {
        let (whole, rest_s) = self.whole_steps();
        let last = whole + usize::from(rest_s.is_some());
        let time = |row: usize| {
            if row < last {
                row as f64 * self.time_step_s
            } else {
                self.duration_s + (row - last) as f64 * self.time_step_s
            }
        };
        (0..=self.time_steps_s().count()).map(time).collect()
    }

    // the number of whole steps within T, and the shorter step that is left
    fn whole_steps(&self) -> (usize, Option<f64>) {
        let ratio = self.duration_s / self.time_step_s;
        let whole = (ratio + WHOLE_STEP).floor().min(MOST_STEPS);
        let rest_s = (ratio - whole > WHOLE_STEP).then_some(self.duration_s - whole * self.time_step_s);
        (whole as usize, rest_s)
    }
}

/// Positions, velocities and accelerations of a rolled-out primitive, n × d each, rows are time.
#[derive(Debug, Clone, PartialEq)]
pub struct Rollout {
    positions: Trajectory,
    velocities: DMatrix<f64>,
    accelerations: DMatrix<f64>,
}

impl Rollout {
    /// Checks and takes `positions` (n × d), `velocities` (n × d, per second) and `accelerations` (n × d, per second
    /// squared).
    ///
    /// # Errors
    /// If the shapes differ or a value is not finite.
    pub fn new(
        positions: Trajectory,
        velocities: DMatrix<f64>,
        accelerations: DMatrix<f64>,
    ) -> Result<Self, SkillError> {
        let operation = "check rollout";
        for table in [&velocities, &accelerations] {
            if table.nrows() != positions.len() {
                let expected = format!("{}, one per position", positions.len());
                return Err(SkillError::RowCount { operation, found: table.nrows(), expected });
            }
            if table.ncols() != positions.dimension() {
                let (found, expected) = (table.ncols(), positions.dimension());
                return Err(SkillError::Dimension { operation, found, expected });
            }
            check_finite(operation, table)?;
        }
        Ok(Self { positions, velocities, accelerations })
    }

    /// Returns the positions with their times, n × d, unit and frame of the request.
    #[must_use]
    pub fn positions(&self) -> &Trajectory {
        &self.positions
    }

    /// Returns the velocities of the dynamics (not differences), n × d, per second.
    #[must_use]
    pub fn velocities(&self) -> &DMatrix<f64> {
        &self.velocities
    }

    /// Returns the accelerations of the dynamics (not differences), n × d, per second squared.
    #[must_use]
    pub fn accelerations(&self) -> &DMatrix<f64> {
        &self.accelerations
    }

    /// Gives the positions away.
    #[must_use]
    pub fn into_positions(self) -> Trajectory {
        self.positions
    }
}

fn check(holds: bool, argument: &'static str, found: f64, expected: &'static str) -> Result<(), SkillError> {
    if holds {
        return Ok(());
    }
    Err(SkillError::InvalidArgument { operation: "roll out primitive", argument, found, expected })
}

/// Checks that a vector argument has `expected` finite values.
pub(super) fn check_vector(argument: &'static str, expected: usize, values: &[f64]) -> Result<(), SkillError> {
    if values.len() != expected {
        return Err(SkillError::Dimension { operation: "roll out primitive", found: values.len(), expected });
    }
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(()),
        Some(found) => check(false, argument, *found, "finite numbers"),
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{dmatrix, dvector};

    use super::*;

    fn request(duration_s: f64, time_step_s: f64, settle_s: f64) -> RolloutRequest {
        RolloutRequest { settle_s, ..RolloutRequest::new(dvector![0.0], dvector![1.0], duration_s, time_step_s) }
    }

    #[test]
    fn samples_land_on_the_duration_and_settle_after_it() {
        assert_eq!(request(1.0, 0.25, 0.0).times_s(), [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert_eq!(request(1.0, 0.375, 0.5).times_s(), [0.0, 0.375, 0.75, 1.0, 1.375, 1.75]);
        let steps: Vec<f64> = request(1.0, 0.375, 0.5).time_steps_s().collect();
        assert_eq!(steps, [0.375, 0.375, 0.25, 0.375, 0.375]);
    }

    #[test]
    fn a_step_that_divides_the_duration_but_for_rounding_leaves_no_sliver() {
        let times_s = request(0.3, 0.1, 0.0).times_s();
        assert_eq!((times_s.len(), times_s[3]), (4, 0.3));
    }

    #[test]
    fn times_outside_their_range_are_refused_by_name() {
        let named = |request: RolloutRequest| match request.validate(1) {
            Err(SkillError::InvalidArgument { argument, .. }) => argument,
            other => panic!("{other:?}"),
        };
        assert_eq!(named(request(0.0, 0.1, 0.0)), "duration_s");
        assert_eq!(named(request(f64::NAN, 0.1, 0.0)), "duration_s");
        assert_eq!(named(request(1.0, 2.0, 0.0)), "time_step_s");
        assert_eq!(named(request(1.0, f64::NAN, 0.0)), "time_step_s");
        assert_eq!(named(request(1.0, 1e-9, 0.0)), "time_step_s");
        assert_eq!(named(request(1.0, 0.1, f64::INFINITY)), "settle_s");
        let mut infinite = request(1.0, 0.1, 0.0);
        infinite.goal[0] = f64::INFINITY;
        assert_eq!(named(infinite), "goal");
    }

    #[test]
    fn times_of_a_request_that_is_none_are_no_more_than_two_million() {
        for none in [request(1.0, 0.0, 1.0), request(1.0, f64::NAN, 0.0), request(f64::INFINITY, 0.1, f64::INFINITY)] {
            assert!(none.time_steps_s().count() <= 2_000_001);
        }
    }

    #[test]
    fn vectors_of_another_dimension_are_refused() {
        assert!(matches!(request(1.0, 0.1, 0.0).validate(2), Err(SkillError::Dimension { found: 1, expected: 2, .. })));
    }

    #[test]
    fn tables_of_another_shape_or_not_finite_are_refused() {
        let positions = Trajectory::uniform(0.1, dmatrix![0.0; 1.0]).unwrap();
        let good = dmatrix![0.0; 0.0];
        assert!(Rollout::new(positions.clone(), good.clone(), good.clone()).is_ok());
        assert!(Rollout::new(positions.clone(), good.clone(), dmatrix![0.0]).is_err());
        assert!(Rollout::new(positions.clone(), dmatrix![0.0, 0.0; 0.0, 0.0], good.clone()).is_err());
        assert!(Rollout::new(positions, dmatrix![0.0; f64::NAN], good).is_err());
    }
}
