//! Chains of named actions, each a track of the tool, that meet in pose, velocity and acceleration.

use serde::Serialize;

use super::motion::{SpatialJump, SpatialMotion};
use super::refusal::SpatialError;
use super::track::SpatialTrack;
use super::verification::check_jump;

/// What an action is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ActionPhase {
    /// Goes to where the work begins.
    Approach,
    /// Cuts.
    Cut,
    /// Leaves the work.
    Withdraw,
    /// Goes from one place of work to the next.
    Travel,
    /// Tilts up to where a container begins to flow.
    Tilt,
    /// Tilts on while it flows.
    Pour,
    /// Rests.
    Hold,
    /// Goes back.
    Return,
    /// All of these at once, as a motion that is not divided into actions.
    Whole,
}

/// One link of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialAction {
    /// Name, as recordings and reports call it.
    pub name: String,
    /// What it is for.
    pub phase: ActionPhase,
    /// Where the tool should be, world frame.
    pub track: SpatialTrack,
}

impl SpatialAction {
    /// Names a track.
    pub fn new(name: impl Into<String>, phase: ActionPhase, track: SpatialTrack) -> Self {
        Self { name: name.into(), phase, track }
    }
}

/// A chain of actions, each beginning where, when and as the one before ends.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialPlan {
    actions: Vec<SpatialAction>,
    starts_s: Vec<f64>,
}

/// Jumps accepted where two actions meet: rounding, but of the acceleration, where a stop of a learned motion is left with
/// what its fit leaves.
const LARGEST_JUMP: SpatialJump = SpatialJump {
    position_m: 1e-7,
    angle_rad: 1e-6,
    velocity_m_per_s: 1e-6,
    angular_velocity_rad_per_s: 1e-6,
    acceleration_m_per_s2: 1e-3,
    angular_acceleration_rad_per_s2: 1e-2,
};

impl SpatialPlan {
    /// Chains actions that meet in pose, velocity and acceleration.
    ///
    /// # Errors
    /// [`SpatialError::NoActions`], or [`SpatialError::Joint`] if two actions differ where they meet by more than
    /// 0.1 µm, 1 µrad, 1 µm/s, 1 µrad/s, 1 mm/s² or 10 mrad/s².
    pub fn new(actions: Vec<SpatialAction>) -> Result<Self, SpatialError> {
        if actions.is_empty() {
            return Err(SpatialError::NoActions);
        }
        let mut time_s = 0.0;
        let mut starts_s = Vec::with_capacity(actions.len());
        for action in &actions {
            starts_s.push(time_s);
            time_s += action.track.duration_s();
        }
        let plan = Self { actions, starts_s };
        plan.joints().iter().try_for_each(|joint| check_jump(joint, &LARGEST_JUMP))?;
        Ok(plan)
    }

    /// The actions in their order.
    #[must_use]
    pub fn actions(&self) -> &[SpatialAction] {
        &self.actions
    }

    /// Times at which the actions begin, s.
    #[must_use]
    pub fn starts_s(&self) -> &[f64] {
        &self.starts_s
    }

    /// Time of the whole plan, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        let last = self.actions.last().map_or(0.0, |action| action.track.duration_s());
        self.starts_s.last().map_or(0.0, |start_s| start_s + last)
    }

    /// Index of the action that is due at a time of the plan, and the time since it began, s.
    #[must_use]
    pub fn due_at(&self, time_s: f64) -> (usize, f64) {
        let index = self.starts_s.partition_point(|start| *start <= time_s).saturating_sub(1);
        (index, time_s - self.starts_s.get(index).copied().unwrap_or(0.0))
    }

    /// Pose, velocity and acceleration of the tool at a time of the plan, s; before and after it at rest at its ends.
    #[must_use]
    pub fn at(&self, time_s: f64) -> SpatialMotion {
        let (index, since_s) = self.due_at(time_s);
        match self.actions.get(index) {
            // what rounding puts past the end of the last action is not at rest yet
            Some(action) if since_s <= action.track.duration_s() * (1.0 + f64::EPSILON) => {
                action.track.at(since_s.min(action.track.duration_s()))
            }
            Some(action) => SpatialMotion::at_rest(action.track.end().pose),
            None => SpatialMotion::at_rest(nalgebra::Isometry3::identity()),
        }
    }
}
