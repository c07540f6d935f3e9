//! What is asked of a pose primitive, and the motion in progress that it yields, with goal and duration free to change.

use nalgebra::{DVector, Isometry3, Translation3, UnitQuaternion, Vector3};

use super::PoseDmp;
use super::correction::{AngularMotion, Correction};
use super::rotation::angular_motion;
use super::trajectory::{PoseError, checked};
use super::turning::Turning;
use crate::error::SkillError;
use crate::primitive::{DmpStepper, RolloutRequest};

/// Linear and angular velocity, both in the frame of the poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseVelocity {
    /// Velocity of the body's origin, m/s.
    pub linear_m_per_s: Vector3<f64>,
    /// Angular velocity, rad/s.
    pub angular_rad_per_s: Vector3<f64>,
}

/// Start, goal and timing of a motion of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseRequest {
    /// Pose to start from, frame of the demonstrations, m.
    pub start: Isometry3<f64>,
    /// Pose to end at, frame of the demonstrations, m.
    pub goal: Isometry3<f64>,
    /// Duration T = τ of the motion, s.
    pub duration_s: f64,
    /// Time between samples, s; at most the duration.
    pub time_step_s: f64,
    /// Velocity at the start; at rest if absent.
    pub start_velocity: Option<PoseVelocity>,
    /// Time to go on after T while the motion settles at the goal, s.
    pub settle_s: f64,
}

impl PoseRequest {
    /// Asks for a motion that starts at rest and ends at T.
    #[must_use]
    pub fn new(start: Isometry3<f64>, goal: Isometry3<f64>, duration_s: f64, time_step_s: f64) -> Self {
        Self { start, goal, duration_s, time_step_s, start_velocity: None, settle_s: 0.0 }
    }
}

/// State of a moving body, all in the frame of the poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseMotion {
    /// Pose, m.
    pub pose: Isometry3<f64>,
    /// Velocity of the body's origin, m/s.
    pub linear_velocity_m_per_s: Vector3<f64>,
    /// Angular velocity, rad/s.
    pub angular_velocity_rad_per_s: Vector3<f64>,
    /// Acceleration of the body's origin, m/s².
    pub linear_acceleration_m_per_s2: Vector3<f64>,
    /// Angular acceleration, rad/s².
    pub angular_acceleration_rad_per_s2: Vector3<f64>,
}

/// Sampled motion of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseRollout {
    /// Times of the samples, s.
    pub times_s: Vec<f64>,
    /// States at these times.
    pub motions: Vec<PoseMotion>,
}

/// Motion of a [`PoseDmp`] in progress; stepping and changes allocate nothing, and the same steps give the same bits as a
/// rollout.
#[derive(Debug, Clone)]
pub struct PoseStepper {
    // x, y, z and the residual rotation vector, under one phase
    coordinates: DmpStepper,
    turning: Turning,
    // where the turn and the residual lead together, and what a change of goal or duration adds to them
    planned_end: UnitQuaternion<f64>,
    correction: Option<Correction>,
    goal: Isometry3<f64>,
    motion: PoseMotion,
}

impl PoseStepper {
    pub(super) fn new(primitive: &PoseDmp, request: &PoseRequest) -> Result<Self, PoseError> {
        let (start, goal) = (checked(0, &request.start)?, checked(1, &request.goal)?);
        let coordinates = primitive.dmp.stepper(&coordinates(primitive, request))?;
        let turning = primitive.turn.turning(start.rotation, goal.rotation);
        let motion = state(&coordinates, &turning, None);
        let mut stepper = Self { coordinates, turning, planned_end: goal.rotation, correction: None, goal, motion };
        // a whole start is not a rounding away from what was asked
        stepper.motion.pose.rotation = start.rotation;
        Ok(stepper)
    }

    /// Advances by `time_step_s` (> 0, s).
    ///
    /// # Errors
    /// If the step is not between 1e-12 and 1e6 durations.
    pub fn step(&mut self, time_step_s: f64) -> Result<(), SkillError> {
        self.coordinates.step(time_step_s)?;
        self.publish();
        Ok(())
    }

    /// Changes the goal to `goal` (frame of the demonstrations, m) from now on.
    ///
    /// Pose, velocities and accelerations stay continuous, as those of [`DmpStepper::change_goal`] do. Orientation is led
    /// to the new goal by a turn of its own, q = e^θ·e^ρ·q_b: a minimum-jerk transfer of θ from its present state over what
    /// is left of the duration, at least a quarter of it. The change, not the whole motion, goes the short way round.
    ///
    /// # Errors
    /// If the goal is not finite or its quaternion is not of unit length (told as row 1, as that of a request).
    pub fn change_goal(&mut self, goal: &Isometry3<f64>) -> Result<(), PoseError> {
        let goal = checked(1, goal)?;
        let mut six = [0.0; 6];
        six.copy_from_slice(self.coordinates.goal().as_slice());
        six[..3].copy_from_slice(goal.translation.vector.as_slice());
        self.coordinates.change_goal(&six)?;
        self.goal = goal;
        self.correct(&self.correction_by_progress());
        self.publish();
        Ok(())
    }

    /// Changes the duration T = τ to `duration_s` (> 0, s) from now on: what is left of the motion, a part 1 − t/τ of it,
    /// takes that part of the new duration.
    ///
    /// Pose and velocities stay continuous, the accelerations step, as those of [`DmpStepper::change_duration`] do.
    ///
    /// # Errors
    /// If the duration is not a positive finite number.
    pub fn change_duration(&mut self, duration_s: f64) -> Result<(), SkillError> {
        let (tau, correction) = (self.coordinates.duration_s(), self.correction_by_progress());
        let residual = residual(&self.coordinates);
        let turning = planned_turn(&self.turning, self.coordinates.progress());
        self.coordinates.change_duration(duration_s)?;
        // the turn alone would change its speed at once: what it loses or gains is the correction's to begin with
        let planned = |tau: f64| residual.before(&turning.by_time(tau));
        let correction = correction.by_time(tau);
        let corrected = correction.completing(&correction.before(&planned(tau)), &planned(duration_s));
        self.correct(&corrected.by_progress(duration_s));
        self.publish();
        Ok(())
    }

    /// Returns the present state.
    #[must_use]
    pub fn motion(&self) -> &PoseMotion {
        &self.motion
    }

    /// Returns the goal, frame of the demonstrations, m.
    #[must_use]
    pub fn goal(&self) -> &Isometry3<f64> {
        &self.goal
    }

    /// Returns the duration T = τ, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.coordinates.duration_s()
    }

    /// Returns t/τ, without unit: 0 at the start, 1 at the end of the motion, more while it settles.
    #[must_use]
    pub fn progress(&self) -> f64 {
        self.coordinates.progress()
    }

    /// Returns the time since the motion started, s.
    #[must_use]
    pub fn elapsed_s(&self) -> f64 {
        self.coordinates.elapsed_s()
    }

    fn publish(&mut self) {
        self.motion = state(&self.coordinates, &self.turning, self.correction.as_ref());
    }

    fn correction_by_progress(&self) -> AngularMotion {
        self.correction.map_or_else(AngularMotion::still, |correction| correction.at(self.coordinates.progress()))
    }

    // leads the correction from `present` (by progress) to what turns the planned end to the goal
    fn correct(&mut self, present: &AngularMotion) {
        let end = self.goal.rotation * self.planned_end.inverse();
        self.correction = Some(Correction::new(self.coordinates.progress(), present, &end));
    }
}

/// The request of the six coordinates: places as they are, the residual rotation from zero to where it unwinds to.
pub(super) fn coordinates(primitive: &PoseDmp, request: &PoseRequest) -> RolloutRequest {
    let six = |upper: &Vector3<f64>, lower: &Vector3<f64>| {
        DVector::from_iterator(6, upper.iter().chain(lower.iter()).copied())
    };
    RolloutRequest {
        start: six(&request.start.translation.vector, &Vector3::zeros()),
        goal: six(&request.goal.translation.vector, &primitive.unwound_rad),
        duration_s: request.duration_s,
        time_step_s: request.time_step_s,
        // at the start both the residual rotation and the turn it is about are zero, the latter at rest
        start_velocity: request
            .start_velocity
            .map(|velocity| six(&velocity.linear_m_per_s, &velocity.angular_rad_per_s)),
        settle_s: request.settle_s,
    }
}

// q = c·e^ρ·q_b and its motion; without a change on the way there is no c
fn state(coordinates: &DmpStepper, turning: &Turning, correction: Option<&Correction>) -> PoseMotion {
    let (progress, tau) = (coordinates.progress(), coordinates.duration_s());
    let planned = residual(coordinates).before(&planned_turn(turning, progress).by_time(tau));
    let turned = match correction {
        None => planned,
        Some(correction) => correction.at(progress).by_time(tau).before(&planned),
    };
    let place = |six: &DVector<f64>| Vector3::new(six[0], six[1], six[2]);
    PoseMotion {
        pose: Isometry3::from_parts(Translation3::from(place(coordinates.position())), turned.rotation),
        linear_velocity_m_per_s: place(coordinates.velocity()),
        angular_velocity_rad_per_s: turned.velocity,
        linear_acceleration_m_per_s2: place(coordinates.acceleration()),
        angular_acceleration_rad_per_s2: turned.acceleration,
    }
}

// e^ρ by time
fn residual(coordinates: &DmpStepper) -> AngularMotion {
    let half = |six: &DVector<f64>| Vector3::new(six[3], six[4], six[5]);
    let rho = half(coordinates.position());
    let (velocity, acceleration) =
        angular_motion(&rho, &half(coordinates.velocity()), &half(coordinates.acceleration()));
    AngularMotion { rotation: UnitQuaternion::from_scaled_axis(rho), velocity, acceleration }
}

// q_b by progress
fn planned_turn(turning: &Turning, progress: f64) -> AngularMotion {
    let (velocity, acceleration) = turning.angular_motion(progress);
    AngularMotion { rotation: turning.rotation(progress), velocity, acceleration }
}
