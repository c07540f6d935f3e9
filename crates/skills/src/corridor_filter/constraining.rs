//! Constraining a whole skill: every coordinate through a filter, and the certificate of the result.

use nalgebra::{DMatrix, DVector};

use super::certificate::state;
use super::{
    AxisFilter, AxisSample, AxisTask, Certificate, CorridorFilterConfig, FilterError, additional_term, certify,
    skill_forcing,
};
use crate::corridor::Corridor;
use crate::error::SkillError;
use crate::primitive::{Rollout, RolloutRequest};
use crate::time_law::PathState;
use crate::trajectory::Trajectory;

/// What a constrained motion is to do; d is the dimension of the skill.
#[derive(Debug, Clone, PartialEq)]
pub struct FilterRequest {
    /// Start x^N(0): d values, unit and frame of the skill; the skill's own start if absent.
    pub start: Option<DVector<f64>>,
    /// Goal g: d values, unit and frame of the skill.
    pub goal: DVector<f64>,
    /// Time constant τ of Eq. (29), s: the duration of the skill without its settling.
    pub duration_s: f64,
}

impl FilterRequest {
    /// Asks for the goal and the duration that the skill was rolled out to, from its own start.
    #[must_use]
    pub fn of(request: &RolloutRequest) -> Self {
        Self { start: None, goal: request.goal.clone(), duration_s: request.duration_s }
    }
}

/// Skill constrained to a corridor.
#[derive(Debug, Clone, PartialEq)]
pub struct Constrained {
    /// The motion x^N, on the times of the skill.
    pub rollout: Rollout,
    /// What is certified of it. Laws without a guarantee may well have left the corridor: ask [`Certificate::holds`].
    pub certificate: Certificate,
}

impl Constrained {
    /// Evaluates the additional term Δu^c of Eq. (29) at every sample, n × d: what would make the primitive of `skill`
    /// (same request and sampling) move like this. `alpha` is its α, β = α/4.
    ///
    /// # Errors
    /// If the skill has another shape.
    pub fn additional_term(
        &self,
        skill: &Rollout,
        request: &FilterRequest,
        alpha: f64,
    ) -> Result<DMatrix<f64>, SkillError> {
        let operation = "evaluate additional term";
        let (rows, dimension) = self.rollout.positions().samples().shape();
        let (found_rows, found) = skill.positions().samples().shape();
        if found_rows != rows {
            return Err(SkillError::RowCount { operation, found: found_rows, expected: rows.to_string() });
        }
        for found in [found, request.goal.len()] {
            if found != dimension {
                return Err(SkillError::Dimension { operation, found, expected: dimension });
            }
        }
        Ok(DMatrix::from_fn(rows, dimension, |row, k| {
            let (goal, tau) = (request.goal[k], request.duration_s);
            let forcing = skill_forcing(alpha, tau, goal, state(skill, row, k));
            additional_term(alpha, tau, goal, forcing, state(&self.rollout, row, k))
        }))
    }
}

/// Constrains the generalized skill x^u (`skill`) to `corridor` (same clock and dimension d), Eqs. (29) and (30), coordinate
/// by coordinate on the samples of the skill.
///
/// # Errors
/// If an option or the request is invalid, dimensions differ, the corridor closes within the time of the skill (also
/// between samples), the start is not inside it, or the law diverges.
pub fn constrain(
    config: &CorridorFilterConfig,
    skill: &Rollout,
    corridor: &Corridor,
    request: &FilterRequest,
) -> Result<Constrained, FilterError> {
    let (rows, dimension) = skill.positions().samples().shape();
    let lengths = [Some(corridor.dimension()), Some(request.goal.len()), request.start.as_ref().map(DVector::len)];
    for found in lengths.into_iter().flatten() {
        if found != dimension {
            return Err(SkillError::Dimension { operation: "constrain skill", found, expected: dimension }.into());
        }
    }
    check_open(skill, corridor)?;
    let mut tables = [(); 3].map(|()| DMatrix::zeros(rows, dimension));
    for coordinate in 0..dimension {
        constrain_axis(config, skill, corridor, request, coordinate, &mut tables)?;
    }
    let [positions, velocities, accelerations] = tables;
    let positions = Trajectory::new(skill.positions().times_s().to_vec(), positions)?;
    let rollout = Rollout::new(positions, velocities, accelerations)?;
    let certificate = certify(&rollout, corridor, &request.goal)?;
    Ok(Constrained { rollout, certificate })
}

fn constrain_axis(
    config: &CorridorFilterConfig,
    skill: &Rollout,
    corridor: &Corridor,
    request: &FilterRequest,
    coordinate: usize,
    tables: &mut [DMatrix<f64>; 3],
) -> Result<(), FilterError> {
    let times_s = skill.positions().times_s();
    let sample =
        |row: usize| AxisSample { skill: state(skill, row, coordinate), bounds: corridor.at(times_s[row], coordinate) };
    let first = sample(0);
    let task = AxisTask {
        coordinate,
        start: request.start.as_ref().map_or(first.skill.position, |start| start[coordinate]),
        goal: request.goal[coordinate],
        goal_bounds: corridor.at(skill.positions().end_time_s(), coordinate),
        duration_s: request.duration_s,
    };
    let mut record = |row: usize, motion: PathState| {
        for (table, value) in tables.iter_mut().zip([motion.position, motion.first, motion.second]) {
            table[(row, coordinate)] = value;
        }
    };
    let mut axis = AxisFilter::begin(config, &task, &first)?;
    record(0, axis.motion());
    for row in 1..times_s.len() {
        record(row, axis.step(&sample(row), times_s[row] - times_s[row - 1])?);
    }
    Ok(())
}

// also between the samples of both
fn check_open(skill: &Rollout, corridor: &Corridor) -> Result<(), FilterError> {
    let (begin_s, end_s) = (skill.positions().start_time_s(), skill.positions().end_time_s());
    for coordinate in 0..corridor.dimension() {
        let (width, time_s) = corridor.least_width(begin_s, end_s, coordinate);
        if width <= 0.0 {
            return Err(FilterError::Closed { coordinate, time_s, width });
        }
    }
    Ok(())
}
