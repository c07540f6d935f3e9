//! Timed motions in the plane on a uniform grid, asked at any time.

use nalgebra::{Isometry2, Point2, Vector3};

use crate::error::SkillError;
use crate::primitive::Rollout;

/// Pose (x, y, angle), velocity and acceleration of something in the plane, world frame: m, rad, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanarMotion {
    /// x, y in m and angle in rad.
    pub position: Vector3<f64>,
    /// Velocity, m/s and rad/s.
    pub velocity: Vector3<f64>,
    /// Acceleration, m/s² and rad/s².
    pub acceleration: Vector3<f64>,
}

impl PlanarMotion {
    /// At rest at a pose.
    #[must_use]
    pub fn at_rest(position: Vector3<f64>) -> Self {
        Self { position, ..Self::default() }
    }

    /// The pose.
    #[must_use]
    pub fn pose(&self) -> Isometry2<f64> {
        Isometry2::new(self.position.xy(), self.position.z)
    }

    /// The place, without the angle.
    #[must_use]
    pub fn point(&self) -> Point2<f64> {
        Point2::from(self.position.xy())
    }
}

/// A timed motion on a uniform grid, starting at time zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    time_step_s: f64,
    motions: Vec<PlanarMotion>,
}

impl Track {
    /// A track of motions `time_step_s` apart.
    ///
    /// # Errors
    /// [`SkillError::RowCount`] without any motion, [`SkillError::InvalidArgument`] if the step is not positive,
    /// [`SkillError::NonFinite`] if a number is not finite.
    pub fn new(time_step_s: f64, motions: Vec<PlanarMotion>) -> Result<Self, SkillError> {
        const OPERATION: &str = "build track";
        if motions.is_empty() {
            return Err(SkillError::RowCount { operation: OPERATION, found: 0, expected: "at least 1".into() });
        }
        if !(time_step_s.is_finite() && time_step_s > 0.0) {
            let expected = "a finite number greater than 0";
            return Err(SkillError::InvalidArgument {
                operation: OPERATION,
                argument: "time_step_s",
                found: time_step_s,
                expected,
            });
        }
        for (row, motion) in motions.iter().enumerate() {
            let numbers = motion.position.iter().chain(&motion.velocity).chain(&motion.acceleration);
            if let Some((column, found)) = numbers.enumerate().find(|(_, number)| !number.is_finite()) {
                return Err(SkillError::NonFinite { operation: OPERATION, row, column, found: *found });
            }
        }
        Ok(Self { time_step_s, motions })
    }

    /// A track of places (first two coordinates of a rollout) with a fixed angle.
    ///
    /// The rollout has one row every `time_step_s`: its duration is a whole number of steps.
    ///
    /// # Errors
    /// As [`Track::new`]; [`SkillError::Dimension`] if the rollout has fewer than two coordinates.
    pub fn from_rollout(rollout: &Rollout, time_step_s: f64, angle_rad: f64) -> Result<Self, SkillError> {
        let (positions, velocities, accelerations) =
            (rollout.positions().samples(), rollout.velocities(), rollout.accelerations());
        if positions.ncols() < 2 {
            return Err(SkillError::Dimension { operation: "build track", found: positions.ncols(), expected: 2 });
        }
        let motion = |row: usize| PlanarMotion {
            position: Vector3::new(positions[(row, 0)], positions[(row, 1)], angle_rad),
            velocity: Vector3::new(velocities[(row, 0)], velocities[(row, 1)], 0.0),
            acceleration: Vector3::new(accelerations[(row, 0)], accelerations[(row, 1)], 0.0),
        };
        Self::new(time_step_s, (0..positions.nrows()).map(motion).collect())
    }

    /// Time from the first to the last motion, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.time_step_s * (self.motions.len() - 1) as f64
    }

    /// The motions.
    #[must_use]
    pub fn motions(&self) -> &[PlanarMotion] {
        &self.motions
    }

    /// Time between two motions, s.
    #[must_use]
    pub fn time_step_s(&self) -> f64 {
        self.time_step_s
    }

    /// The first motion.
    #[must_use]
    pub fn start(&self) -> PlanarMotion {
        self.motions.first().copied().unwrap_or_default()
    }

    /// The last motion.
    #[must_use]
    pub fn end(&self) -> PlanarMotion {
        self.motions.last().copied().unwrap_or_default()
    }

    /// The motion at a time: cubic between the grid's places and velocities, linear in the acceleration; at rest outside,
    /// and at a time that is no number where it starts.
    #[must_use]
    pub fn at(&self, time_s: f64) -> PlanarMotion {
        let steps = time_s / self.time_step_s;
        if steps.is_nan() || steps <= 0.0 {
            return if steps < 0.0 { PlanarMotion::at_rest(self.start().position) } else { self.start() };
        }
        let index = steps.floor() as usize;
        let [from, to, ..] = self.motions.get(index..).unwrap_or_default() else {
            let at_end = steps <= (self.motions.len() - 1) as f64;
            return if at_end { self.end() } else { PlanarMotion::at_rest(self.end().position) };
        };
        let (r, h) = (steps - index as f64, self.time_step_s);
        let rise = to.position - from.position;
        let position = from.position
            + rise * (r * r * (3.0 - 2.0 * r))
            + (from.velocity * (r * (1.0 - r) * (1.0 - r)) - to.velocity * (r * r * (1.0 - r))) * h;
        let velocity = rise * (6.0 * r * (1.0 - r) / h)
            + from.velocity * ((1.0 - r) * (1.0 - 3.0 * r))
            + to.velocity * (r * (3.0 * r - 2.0));
        PlanarMotion { position, velocity, acceleration: from.acceleration.lerp(&to.acceleration, r) }
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::time_law::{minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative};

    /// One meter along x in one second, minimum jerk.
    fn track(offset: f64) -> Track {
        let motion = |k: usize| {
            let r = k as f64 / 100.0;
            PlanarMotion {
                position: Vector3::new(offset + minimum_jerk(r), 0.0, 0.0),
                velocity: Vector3::new(minimum_jerk_first_derivative(r), 0.0, 0.0),
                acceleration: Vector3::new(minimum_jerk_second_derivative(r), 0.0, 0.0),
            }
        };
        Track::new(0.01, (0..=100).map(motion).collect()).unwrap()
    }

    #[test]
    fn a_track_between_its_samples_is_the_motion_it_sampled() {
        for time in [0.123, 0.5, 0.877] {
            let motion = track(0.0).at(time);
            // cubic interpolation of a quintic on a grid of 10 ms
            assert_relative_eq!(motion.position.x, minimum_jerk(time), epsilon = 1e-7);
            assert_relative_eq!(motion.velocity.x, minimum_jerk_first_derivative(time), epsilon = 1e-4);
            assert_relative_eq!(motion.acceleration.x, minimum_jerk_second_derivative(time), epsilon = 1e-2);
        }
    }

    #[test]
    fn a_track_rests_before_and_after() {
        assert_eq!(track(0.0).at(-1.0), PlanarMotion::at_rest(Vector3::zeros()));
        assert_eq!(track(0.0).at(5.0), PlanarMotion::at_rest(track(0.0).end().position));
    }

    #[test]
    fn a_track_is_asked_at_any_time_without_a_panic() {
        let end = PlanarMotion::at_rest(track(0.0).end().position);
        for time in [1.0, 1.1, 1e30, f64::INFINITY] {
            assert_eq!(track(0.0).at(time), end);
        }
        for time in [0.0, -1e30, f64::NEG_INFINITY, f64::NAN] {
            assert_eq!(track(0.0).at(time), track(0.0).start());
        }
    }

    #[test]
    fn a_track_that_ends_in_motion_moves_until_its_very_end() {
        let moving =
            |x: f64| PlanarMotion { velocity: Vector3::x(), ..PlanarMotion::at_rest(Vector3::new(x, 0.0, 0.0)) };
        let track = Track::new(0.5, vec![moving(0.0), moving(0.5)]).unwrap();
        assert_eq!(track.at(0.5), moving(0.5));
        assert_eq!(track.at(0.6), PlanarMotion::at_rest(moving(0.5).position));
    }

    #[test]
    fn tracks_of_nothing_or_of_no_numbers_are_refused() {
        assert!(matches!(Track::new(0.1, vec![]), Err(SkillError::RowCount { found: 0, .. })));
        let still = PlanarMotion::default();
        for step in [0.0, -0.1, f64::NAN, f64::INFINITY] {
            assert!(matches!(Track::new(step, vec![still]), Err(SkillError::InvalidArgument { .. })));
        }
        let broken = PlanarMotion { velocity: Vector3::new(0.0, f64::NAN, 0.0), ..still };
        assert!(matches!(Track::new(0.1, vec![still, broken]), Err(SkillError::NonFinite { row: 1, column: 4, .. })));
    }
}
