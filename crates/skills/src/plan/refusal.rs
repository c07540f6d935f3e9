//! Why a plan is no strict chain.

use std::fmt;

use super::condition::Check;
use super::continuity::{Body, Joint, Jump};
use super::verification::ActionReport;
use super::{Action, ChainTolerances};
use crate::error::SkillError;

/// What jumps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The place, m.
    Position,
    /// The angle, rad.
    Angle,
    /// The velocity, m/s.
    Velocity,
    /// The angular velocity, rad/s.
    AngularVelocity,
}

/// Why a plan is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ChainError {
    /// Two actions do not meet.
    #[error(
        "verify chain: the {quantity} of the {body} jumps by {found} {unit} from '{before}' to '{after}' at {time_s:.3} s; \
         expected at most {limit} {unit}; begin '{after}' as '{before}' ends",
        unit = quantity.unit()
    )]
    Joint {
        /// Name of the action that ends.
        before: String,
        /// Name of the action that begins.
        after: String,
        /// Time of the plan, s.
        time_s: f64,
        /// Who jumps.
        body: Body,
        /// What jumps.
        quantity: Quantity,
        /// By how much.
        found: f64,
        /// The largest jump accepted.
        limit: f64,
    },
    /// An action is broken inside: places, velocities and accelerations of its track do not belong together.
    #[error(
        "verify chain: the {quantity} of the {body} jumps by {found} {unit} inside '{action}' at {time_s:.3} s; expected at \
         most {limit} {unit}; give velocities and accelerations that are the slopes of the places, or a finer time step",
        unit = quantity.unit()
    )]
    Inside {
        /// Name of the action.
        action: String,
        /// Time of the plan, s.
        time_s: f64,
        /// Who jumps.
        body: Body,
        /// What jumps.
        quantity: Quantity,
        /// By how much.
        found: f64,
        /// The largest jump accepted.
        limit: f64,
    },
    /// An action takes no time.
    #[error("verify chain: '{action}' has one motion; expected at least 2, so that time goes on; leave the action out")]
    NoDuration {
        /// Name of the action.
        action: String,
    },
    /// An action lies on another grid than the first.
    #[error(
        "verify chain: the motions of '{action}' are {found_s} s apart; expected {expected_s} s as in the first action; \
         plan all actions with one time step"
    )]
    Grid {
        /// Name of the action.
        action: String,
        /// Time step found, s.
        found_s: f64,
        /// Time step of the first action, s.
        expected_s: f64,
    },
    /// A push names a surface that the tool does not have.
    #[error(
        "verify chain: '{action}' pushes with surface {surface} (from 0); the tool '{tool}' has {surfaces}; verify with \
         the tool that the plan was made for"
    )]
    Surface {
        /// Name of the action.
        action: String,
        /// Index of the surface.
        surface: usize,
        /// Name of the tool.
        tool: String,
        /// Number of surfaces that the tool has.
        surfaces: usize,
    },
    /// A pre- or post-condition, or what must hold throughout, is violated.
    #[error(
        "verify chain: {} '{action}' ({:.3} s) {} is {} {unit}; expected at most {} {unit}; {}",
        .check.moment, .check.time_s, .check.condition, .check.found, .check.limit, .check.condition.remedy(),
        unit = .check.condition.unit()
    )]
    Condition {
        /// Name of the action.
        action: String,
        /// The check that failed.
        check: Box<Check>,
    },
    /// Tolerances or setting cannot be used.
    #[error(transparent)]
    Skill(#[from] SkillError),
}

impl Quantity {
    /// Unit of a jump.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Position => "m",
            Self::Angle => "rad",
            Self::Velocity => "m/s",
            Self::AngularVelocity => "rad/s",
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Position => "place",
            Self::Angle => "angle",
            Self::Velocity => "velocity",
            Self::AngularVelocity => "angular velocity",
        })
    }
}

impl fmt::Display for Body {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Tool => "tool",
            Self::Object => "object",
        })
    }
}

/// The first number of a jump that is larger than accepted, and its limit.
fn excess(jump: &Jump, tolerances: &ChainTolerances) -> Option<(Quantity, f64, f64)> {
    let numbers = [
        (Quantity::Position, jump.position_m, tolerances.position_m),
        (Quantity::Angle, jump.angle_rad, tolerances.angle_rad),
        (Quantity::Velocity, jump.velocity_m_per_s, tolerances.velocity_m_per_s),
        (Quantity::AngularVelocity, jump.angular_velocity_rad_per_s, tolerances.angular_velocity_rad_per_s),
    ];
    numbers.into_iter().find(|(_, found, limit)| found.is_nan() || found > limit)
}

impl Joint {
    pub(super) fn check(&self, tolerances: &ChainTolerances) -> Result<(), ChainError> {
        for (body, jump) in [(Body::Tool, &self.tool), (Body::Object, &self.object)] {
            if let Some((quantity, found, limit)) = excess(jump, tolerances) {
                let (before, after) = (self.before.clone(), self.after.clone());
                return Err(ChainError::Joint { before, after, time_s: self.time_s, body, quantity, found, limit });
            }
        }
        Ok(())
    }
}

impl Action {
    /// Checks that no jump inside the action is larger than accepted.
    pub(super) fn check_inside(&self, report: &ActionReport, tolerances: &ChainTolerances) -> Result<(), ChainError> {
        for (body, track, largest) in
            [(Body::Tool, &self.tool, &report.tool), (Body::Object, &self.object, &report.object)]
        {
            if excess(largest, tolerances).is_none() {
                continue;
            }
            for row in 1..track.motions().len() {
                if let Some((quantity, found, limit)) = excess(&track.jump_into(row), tolerances) {
                    let (action, time_s) = (self.name.clone(), report.begins_s + row as f64 * track.time_step_s());
                    return Err(ChainError::Inside { action, time_s, body, quantity, found, limit });
                }
            }
        }
        Ok(())
    }
}
