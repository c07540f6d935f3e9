//! Position and orientation under one phase: the pose primitive.
//!
//! The paper's primitive moves places only. The usual quaternion DMP ties orientation to the logarithm at the goal (A. Ude,
//! B. Nemec, T. Petrič and J. Morimoto, 2014, doi:10.1109/ICRA.2014.6907291; made linear by L. Koutras and Z. Doulgeri,
//! 2020), one tangent space for the whole motion: it jumps where the body is half a turn away from its goal, and takes
//! the short way for every turn of more than half. Here, as in the residual form of the DMP, orientation is a residual
//! about a turn that goes from start to goal the way round that was shown: q = e^ρ·q_b(t/T). The residual ρ is unwrapped
//! along the demonstration and small, so that its three coordinates are those of an ordinary DMP, linear and decoupled.

mod correction;
mod motion;
pub(crate) mod rotation;
mod saved;
mod trajectory;
mod turning;

use nalgebra::{DMatrix, Vector3};

pub use motion::{PoseMotion, PoseRequest, PoseRollout, PoseStepper, PoseVelocity};
pub use saved::SavedPose;
pub(crate) use trajectory::checked;
pub use trajectory::{PoseError, PoseTrajectory};
pub use turning::ShownTurn;

use super::{Dmp, DmpConfig, DmpForm};
use crate::error::SkillError;
use crate::field::FieldError;
use crate::trajectory::Trajectory;

/// Distance of residuals' ends from each other up to which demonstrations go the same way round, rad.
const SAME_WAY_RAD: f64 = 1e-6;

/// Change of a residual between two samples from which on it is a jump, rad: the body turns by half of it at most.
const LARGEST_JUMP_RAD: f64 = std::f64::consts::PI;

/// Dynamic movement primitive of a body's pose: x, y, z and the residual rotation vector ρ are the six coordinates of one
/// residual DMP, so that position and orientation share the phase.
///
/// Motions turn with demonstrations and request: turned or moved together, or with the axes of the body named anew, they
/// give the same motion turned, moved or renamed. Orientations stay rotations for every step, for nothing is integrated
/// on them.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseDmp {
    config: DmpConfig,
    dmp: Dmp,
    turn: ShownTurn,
    // where the residual ends, by whole turns away from zero
    unwound_rad: Vector3<f64>,
}

impl PoseDmp {
    /// Learns from one or more demonstrations in one frame; starts, goals, durations and sampling may differ.
    ///
    /// # Errors
    /// If `config` is invalid or its form is not the residual one, there is no demonstration, one strays from its way by a
    /// whole turn, the demonstrations turn round in different ways, or the samples do not determine the weights.
    pub fn learn(config: &DmpConfig, demonstrations: &[PoseTrajectory]) -> Result<Self, PoseError> {
        check_form(config)?;
        let turn = ShownTurn::of(demonstrations);
        let mut tables = Vec::with_capacity(demonstrations.len());
        let mut unwound = None;
        for (demonstration, shown) in demonstrations.iter().enumerate() {
            let first = shown.first().rotation;
            let residuals = turn.turning(first, shown.rotation() * first).residuals(shown);
            let jumps = |pair: &[Vector3<f64>]| match pair {
                [from, to] => (to - from).norm() > LARGEST_JUMP_RAD,
                _ => false,
            };
            if let Some(row) = residuals.windows(2).position(jumps) {
                return Err(PoseError::TurnsBack { demonstration, row: row + 1 });
            }
            let end = residuals.last().copied().unwrap_or_default();
            let apart_rad = (end - unwound.unwrap_or(end)).norm();
            if apart_rad > SAME_WAY_RAD {
                return Err(PoseError::OtherWayRound { demonstration, apart_rad });
            }
            unwound.get_or_insert(end);
            tables.push(table(shown, &residuals)?);
        }
        let dmp = Dmp::learn(config, &tables)?;
        Ok(Self { config: config.clone(), dmp, turn, unwound_rad: unwound.unwrap_or_default() })
    }

    /// Returns the DMP of x, y, z (m) and the residual rotation vector (rad).
    #[must_use]
    pub fn dmp(&self) -> &Dmp {
        &self.dmp
    }

    /// Returns the way round that was shown.
    #[must_use]
    pub fn turn(&self) -> &ShownTurn {
        &self.turn
    }

    /// Starts a motion that is stepped from outside, as inside a control loop; `time_step_s` of the request is only the
    /// step expected, `settle_s` is ignored.
    ///
    /// Of the two ways round to a goal the one nearer to the shown turn is taken.
    ///
    /// # Errors
    /// If a pose or velocity of the request is not finite, a quaternion is not of unit length, or a time is outside its
    /// range.
    pub fn stepper(&self, request: &PoseRequest) -> Result<PoseStepper, PoseError> {
        PoseStepper::new(self, request)
    }

    /// Rolls the primitive out to the requested start, goal and duration.
    ///
    /// # Errors
    /// As [`PoseDmp::stepper`].
    pub fn rollout(&self, request: &PoseRequest) -> Result<PoseRollout, PoseError> {
        let mut stepper = self.stepper(request)?;
        let timing = motion::coordinates(self, request);
        let times_s = timing.times_s();
        let mut motions = Vec::with_capacity(times_s.len());
        motions.push(*stepper.motion());
        for step_s in timing.time_steps_s() {
            stepper.step(step_s)?;
            motions.push(*stepper.motion());
        }
        Ok(PoseRollout { times_s, motions })
    }
}

// in the other forms the shape of the residual rotation would depend on start and goal of a rotation that has none
fn check_form(config: &DmpConfig) -> Result<(), SkillError> {
    config.validate()?;
    match config.form {
        DmpForm::Residual => Ok(()),
        DmpForm::Eq1Literal | DmpForm::Scaled => {
            Err(FieldError::new("form", format!("{:?}", config.form), "residual").into())
        }
    }
}

fn table(shown: &PoseTrajectory, residuals: &[Vector3<f64>]) -> Result<Trajectory, SkillError> {
    let table = DMatrix::from_fn(residuals.len(), 6, |row, column| match column {
        0..3 => shown.poses()[row].translation.vector[column],
        _ => residuals[row][column - 3],
    });
    Trajectory::new(shown.times_s().to_vec(), table)
}

#[cfg(test)]
#[path = "pose_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "changing_tests.rs"]
mod changing_tests;
