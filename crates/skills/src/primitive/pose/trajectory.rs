//! Timed poses, checked once, and why poses are refused.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use thiserror::Error;

use crate::error::SkillError;
use crate::trajectory::check_times;

/// Largest turn between two samples, rad: beyond a half turn the way round would be a guess.
const LARGEST_STEP_RAD: f64 = std::f64::consts::FRAC_PI_2;
/// Error of a quaternion's norm up to which it counts as rounded and is normalized.
const NORM_ERROR: f64 = 1e-6;

/// States why poses were refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PoseError {
    /// Refused as trajectories of coordinates are.
    #[error(transparent)]
    Skill(#[from] SkillError),
    /// A quaternion is not one of a rotation.
    #[error("check pose {row}: the norm of its quaternion is {norm}; expected 1; normalize it")]
    NotUnit {
        /// Row of the pose, from 0; of a request 0 is the start and 1 the goal.
        row: usize,
        /// The norm found.
        norm: f64,
    },
    /// Two samples are too far apart to tell which way the body turned.
    #[error(
        "check poses: the body turns by {turn_rad:.3} rad up to row {row}; expected at most {largest_rad:.3} rad between \
         two rows; record more often"
    )]
    FastTurn {
        /// Row after the turn, from 0.
        row: usize,
        /// Angle between the rows, rad.
        turn_rad: f64,
        /// Largest angle accepted, rad.
        largest_rad: f64,
    },
    /// A demonstration is a whole turn away from the turn it is told from, where a residual has no direction.
    #[error(
        "learn pose primitive: demonstration {demonstration} is a whole turn beside the way from its start to its goal \
         at row {row}; expected less; cut it where it turns back"
    )]
    TurnsBack {
        /// Index of the demonstration, from 0.
        demonstration: usize,
        /// Row at which the residual is no longer continuous, from 0.
        row: usize,
    },
    /// Demonstrations go round in different ways.
    #[error(
        "learn pose primitive: demonstration {demonstration} ends {apart_rad:.3} rad of whole turns apart from \
         demonstration 0; expected turns the same way round; learn them apart"
    )]
    OtherWayRound {
        /// Index of the demonstration, from 0.
        demonstration: usize,
        /// Length of the difference of the rotation vectors that both unwind to, rad.
        apart_rad: f64,
    },
}

/// Recorded motion of a body: n times (s, strictly increasing) and n poses in one frame, which is the owner's business.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseTrajectory {
    times_s: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
}

impl PoseTrajectory {
    /// Checks and takes `times_s` (n, s) and `poses` (n, translation in m); a quaternion and its negative are one pose.
    ///
    /// # Errors
    /// If n < 2, the numbers differ, the times do not increase strictly, a value is not finite, a quaternion is not of
    /// unit length, or the body turns by more than a quarter turn between two rows.
    pub fn new(times_s: Vec<f64>, poses: Vec<Isometry3<f64>>) -> Result<Self, PoseError> {
        let operation = "check poses";
        if poses.len() < 2 {
            let expected = "at least 2".into();
            return Err(SkillError::RowCount { operation, found: poses.len(), expected }.into());
        }
        if poses.len() != times_s.len() {
            let expected = format!("{}, one per time", times_s.len());
            return Err(SkillError::RowCount { operation, found: poses.len(), expected }.into());
        }
        check_times(&times_s)?;
        let checked = poses.iter().enumerate().map(|(row, pose)| checked(row, pose));
        let poses = checked.collect::<Result<Vec<_>, _>>()?;
        for (row, pair) in poses.windows(2).enumerate() {
            let turn_rad = pair.iter().map(|pose| pose.rotation).reduce(|from, to| to * from.inverse());
            let turn_rad = turn_rad.map_or(0.0, |turn| turn.angle());
            if turn_rad > LARGEST_STEP_RAD {
                return Err(PoseError::FastTurn { row: row + 1, turn_rad, largest_rad: LARGEST_STEP_RAD });
            }
        }
        Ok(Self { times_s, poses })
    }

    /// Returns the n times, s.
    #[must_use]
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Returns the n poses.
    #[must_use]
    pub fn poses(&self) -> &[Isometry3<f64>] {
        &self.poses
    }

    /// Returns the last time minus the first, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.times_s[self.times_s.len() - 1] - self.times_s[0]
    }

    /// Sums the turns from sample to sample, rad: ∫ω dt in the frame of the poses. About a fixed axis it is the angle
    /// turned through, whole turns included.
    #[must_use]
    pub fn turn_rad(&self) -> Vector3<f64> {
        let steps = self.poses.iter().zip(self.poses.iter().skip(1));
        steps.map(|(from, to)| (to.rotation * from.rotation.inverse()).scaled_axis()).sum()
    }

    pub(super) fn first(&self) -> &Isometry3<f64> {
        &self.poses[0]
    }

    /// Rotation that leads from the first pose to the last one.
    pub(super) fn rotation(&self) -> UnitQuaternion<f64> {
        self.poses[self.poses.len() - 1].rotation * self.poses[0].rotation.inverse()
    }
}

/// Checks one pose and makes its quaternion exactly unit; one that is keeps its bits.
pub(crate) fn checked(row: usize, pose: &Isometry3<f64>) -> Result<Isometry3<f64>, PoseError> {
    let (vector, quaternion) = (pose.translation.vector, pose.rotation.into_inner());
    if let Some((column, found)) =
        vector.iter().chain(quaternion.coords.iter()).enumerate().find(|(_, value)| !value.is_finite())
    {
        return Err(SkillError::NonFinite { operation: "check poses", row, column, found: *found }.into());
    }
    let norm = quaternion.norm();
    if (norm - 1.0).abs() > NORM_ERROR {
        return Err(PoseError::NotUnit { row, norm });
    }
    let rounded = (norm - 1.0).abs() <= 4.0 * f64::EPSILON;
    let rotation = if rounded { pose.rotation } else { UnitQuaternion::new_normalize(quaternion) };
    Ok(Isometry3::from_parts(pose.translation, rotation))
}
