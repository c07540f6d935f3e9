//! Running an action of a plan slower or faster along the same way.

use super::{Plan, PlanarMotion, Track};
use crate::error::SkillError;
use crate::field::{FieldError, within};

/// Factors beyond these are slips, and would make tracks of any size.
const FACTORS: [f64; 2] = [1e-3, 1e3];
/// What moves slower than this at a joint rests there, m/s and rad/s.
const REST: f64 = 1e-6;

impl Track {
    /// Stretches the time by `factor` along the same way, x′(t) = x(t/k), on the same grid: the duration is rounded to
    /// whole steps (at least one), and k is what that leaves of the factor.
    ///
    /// # Errors
    /// [`SkillError::InvalidConfig`] if the factor (field `factor`) is not from 0.001 to 1000.
    pub fn retimed(&self, factor: f64) -> Result<Self, SkillError> {
        within("factor", factor, FACTORS[0], FACTORS[1])?;
        let steps = self.motions().len() - 1;
        if steps == 0 {
            return Ok(self.clone());
        }
        let stretched = (steps as f64 * factor).round().max(1.0) as usize;
        let k = stretched as f64 / steps as f64;
        let motion = |row: usize| {
            // the last row is the end itself, whatever the rounding of its time
            let at = if row == stretched { self.end() } else { self.at(row as f64 * self.time_step_s() / k) };
            PlanarMotion { position: at.position, velocity: at.velocity / k, acceleration: at.acceleration / (k * k) }
        };
        Self::new(self.time_step_s(), (0..=stretched).map(motion).collect())
    }
}

impl Plan {
    /// Stretches the duration of the action of index `action` by `factor` (slower above 1); tool and object keep their ways.
    ///
    /// The action must begin and end at rest where it meets others: only then does the chain keep its velocities.
    ///
    /// # Errors
    /// [`SkillError::InvalidConfig`] if there is no such action (field `action`), it meets another one in motion (field
    /// `velocity`) or the factor is not from 0.001 to 1000.
    pub fn retimed(&self, action: usize, factor: f64) -> Result<Self, SkillError> {
        let mut actions = self.actions.clone();
        let last = actions.len() - 1;
        let Some(slowed) = actions.get_mut(action) else {
            return Err(FieldError::new("action", action, format!("an index from 0 to {last}")).into());
        };
        for track in [&slowed.tool, &slowed.object] {
            let joints = [(action > 0).then(|| track.start()), (action < last).then(|| track.end())];
            let fastest = joints.iter().flatten().map(|motion| motion.velocity.norm()).fold(0.0, f64::max);
            if fastest > REST {
                let found = format!("{fastest} m/s at a joint of '{}'", slowed.name);
                return Err(FieldError::new("velocity", found, "rest where actions meet").into());
            }
        }
        slowed.tool = slowed.tool.retimed(factor)?;
        slowed.object = slowed.object.retimed(factor)?;
        Self::new(actions)
    }
}
