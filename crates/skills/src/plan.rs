//! Plans: chains of timed actions that say where the tool should be and where the object is expected.

use nalgebra::{Isometry2, Point2, Vector2, Vector3};

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

    /// The motion at a time: cubic between the grid's places and velocities, linear in the acceleration; at rest outside.
    #[must_use]
    pub fn at(&self, time_s: f64) -> PlanarMotion {
        let steps = time_s / self.time_step_s;
        if steps.is_nan() || steps <= 0.0 {
            return if steps < 0.0 { PlanarMotion::at_rest(self.start().position) } else { self.start() };
        }
        let index = steps.floor() as usize;
        let (Some(from), Some(to)) = (self.motions.get(index), self.motions.get(index + 1)) else {
            return PlanarMotion::at_rest(self.end().position);
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

/// What an action does with the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ActionKind {
    /// The tool moves the object (object-operating, O2).
    ObjectOperating(Push),
    /// The tool goes from one contact to another without moving the object (tool-flipping, TF).
    ToolFlipping,
}

/// How an object-operating action pushes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Index of the contact surface in the tool's list.
    pub surface: usize,
    /// Where the object's center begins, world frame.
    pub from_world: Point2<f64>,
    /// Where the object's center ends, world frame.
    pub to_world: Point2<f64>,
}

impl Push {
    /// Unit direction of the push; `None` if it leads nowhere.
    #[must_use]
    pub fn direction_world(&self) -> Option<Vector2<f64>> {
        (self.to_world - self.from_world).try_normalize(f64::EPSILON)
    }
}

/// One link of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// Name, as recordings and reports call it.
    pub name: String,
    /// What it does with the object.
    pub kind: ActionKind,
    /// Where the tool should be, world frame.
    pub tool: Track,
    /// Where the object is expected, world frame.
    pub object: Track,
}

/// A chain of actions, each beginning where and when the one before ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    actions: Vec<Action>,
    starts_s: Vec<f64>,
}

/// Consecutive actions meet within this distance, m, and angle, rad.
const JOINT_TOLERANCE: f64 = 1e-4;

impl Plan {
    /// Chains actions.
    ///
    /// # Errors
    /// [`SkillError::Gap`] if one action does not begin where the one before ends, [`SkillError::RowCount`] without any.
    pub fn new(actions: Vec<Action>) -> Result<Self, SkillError> {
        if actions.is_empty() {
            return Err(SkillError::RowCount { operation: "chain actions", found: 0, expected: "at least 1".into() });
        }
        for (before, after) in actions.iter().zip(actions.iter().skip(1)) {
            for (end, start) in [(before.tool.end(), after.tool.start()), (before.object.end(), after.object.start())] {
                let gap = (end.position - start.position).norm();
                if gap > JOINT_TOLERANCE {
                    return Err(SkillError::Gap { gap, largest_gap: JOINT_TOLERANCE });
                }
            }
        }
        let mut time_s = 0.0;
        let starts_s = actions
            .iter()
            .map(|action| {
                let start = time_s;
                time_s += action.tool.duration_s();
                start
            })
            .collect();
        Ok(Self { actions, starts_s })
    }

    /// The actions in their order.
    #[must_use]
    pub fn actions(&self) -> &[Action] {
        &self.actions
    }

    /// Time of the whole plan, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.actions.iter().map(|action| action.tool.duration_s()).sum()
    }

    /// Index of the action that is due at a time, and the time since it began, s.
    #[must_use]
    pub fn due_at(&self, time_s: f64) -> (usize, f64) {
        let index = self.starts_s.partition_point(|start| *start <= time_s).saturating_sub(1);
        (index, time_s - self.starts_s.get(index).copied().unwrap_or(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_law::{minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative};
    use approx::assert_relative_eq;

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

    fn action(offset: f64) -> Action {
        Action { name: "move".into(), kind: ActionKind::ToolFlipping, tool: track(offset), object: track(offset) }
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
    fn a_chain_with_a_gap_is_refused() {
        assert!(Plan::new(vec![action(0.0), action(1.0)]).is_ok());
        assert!(matches!(Plan::new(vec![action(0.0), action(1.1)]), Err(SkillError::Gap { .. })));
    }

    #[test]
    fn the_action_that_is_due_is_found_by_time() {
        let plan = Plan::new(vec![action(0.0), action(1.0)]).unwrap();
        assert_eq!(plan.due_at(0.5), (0, 0.5));
        assert_eq!(plan.due_at(1.25), (1, 0.25));
        assert_eq!(plan.due_at(9.0), (1, 8.0));
    }
}
