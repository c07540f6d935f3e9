//! A tilt that is steered online: it follows a wanted rate along the way of the plan, with continuous acceleration.

use super::planning::{PourPlan, Tilting};
use crate::spatial::{SpatialError, SpatialMotion, SpatialTrack};
use crate::time_law::{MinimumJerkTransfer, PathState};

/// Natural frequency of the critically damped filter of the rate, rad/s: a new rate is reached to 98 % in 0.4 s, and a change of
/// 0.8 rad/s accelerates by at most 4.4 rad/s².
const FREQUENCY_RAD_PER_S: f64 = 15.0;

/// Steers the tilt of a planned pour from where the flow may begin: see [`PourPlan::steered`].
#[derive(Debug, Clone)]
pub struct TiltSteering<'a> {
    tilting: &'a Tilting,
    /// Tilt with rate and acceleration, rad.
    tilt: PathState,
}

impl PourPlan {
    /// Steering of the tilt, and the time of the plan at which it takes over, s: when the flow may begin, where the plan
    /// rests. `None` for the plain primitive, whose way nothing is known of.
    #[must_use]
    pub fn steered(&self) -> Option<(f64, TiltSteering<'_>)> {
        let tilting = self.tilting.as_ref()?;
        let tilt = PathState { position: tilting.path.flows_from * tilting.path.end_rad, ..PathState::default() };
        Some((self.report.flows_from_s, TiltSteering { tilting, tilt }))
    }
}

impl TiltSteering<'_> {
    /// Goes on for `time_step_s` toward the rate `wanted_rad_per_s`, which is kept within the plan's largest rate; in time
    /// before the ends of the way it comes to rest. Allocates nothing; numbers that are not finite count as 0.
    pub fn step(&mut self, time_step_s: f64, wanted_rad_per_s: f64) {
        if !(time_step_s.is_finite() && time_step_s > 0.0) {
            return;
        }
        let largest = self.tilting.rate_rad_per_s;
        let wanted = if wanted_rad_per_s.is_finite() { wanted_rad_per_s.clamp(-largest, largest) } else { 0.0 };
        let rests_at = self.rests_at();
        let [low, high] = [self.tilting.path.flows_from * self.end_rad(), self.end_rad()];
        let barred = (rests_at >= high && wanted > 0.0) || (rests_at <= low && wanted < 0.0);
        let wanted = if barred { 0.0 } else { wanted };
        let PathState { position, first, second } = self.tilt;
        let jerk = FREQUENCY_RAD_PER_S * (FREQUENCY_RAD_PER_S * (wanted - first) - 2.0 * second);
        let second = second + jerk * time_step_s;
        let first = first + second * time_step_s;
        self.tilt = PathState { position: position + first * time_step_s, first, second };
    }

    /// Where it comes to rest if rest is wanted from now on, rad: the integral of the filter's decay.
    fn rests_at(&self) -> f64 {
        let PathState { position, first, second } = self.tilt;
        position + (2.0 * first + second / FREQUENCY_RAD_PER_S) / FREQUENCY_RAD_PER_S
    }

    /// Tilt of the cup, rad.
    #[must_use]
    pub fn tilt_rad(&self) -> f64 {
        self.tilt.position
    }

    /// Greatest tilt of the plan, rad.
    #[must_use]
    pub fn end_rad(&self) -> f64 {
        self.tilting.path.end_rad
    }

    /// Motion of the cup, `world_from_cup`.
    #[must_use]
    pub fn motion(&self) -> SpatialMotion {
        self.tilting.path.motion(self.part()).seen_from(&self.tilting.world_from_pour)
    }

    /// Track that tilts the cup back along the way it came, from here, with its velocity and acceleration, to upright
    /// beside the mouth.
    ///
    /// # Errors
    /// [`SpatialError`] only if the state is not finite.
    pub fn back(&self) -> Result<SpatialTrack, SpatialError> {
        self.tilting.back_from(self.part())
    }

    /// State of the part of the tilt that is done.
    fn part(&self) -> PathState {
        let by = 1.0 / self.end_rad();
        let PathState { position, first, second } = self.tilt;
        PathState { position: position * by, first: first * by, second: second * by }
    }
}

impl Tilting {
    /// Tilts back from a state of the part of the tilt.
    pub(super) fn back_from(&self, part: PathState) -> Result<SpatialTrack, SpatialError> {
        let duration_s = self.path.duration_s(0.0, part.position, self.rate_rad_per_s);
        let back = MinimumJerkTransfer::new(0.0, part, 0.0, duration_s);
        self.path.track(&self.world_from_pour, duration_s, |time_s| back.at(time_s))
    }
}
