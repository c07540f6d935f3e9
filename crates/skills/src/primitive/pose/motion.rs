//! What is asked of a pose primitive, and the motion in progress that it yields.

use nalgebra::{DVector, Isometry3, Translation3, UnitQuaternion, Vector3};

use super::PoseDmp;
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

/// Motion of a [`PoseDmp`] in progress; stepping allocates nothing, and the same steps give the same bits as a rollout.
#[derive(Debug, Clone)]
pub struct PoseStepper {
    // x, y, z and the residual rotation vector, under one phase
    coordinates: DmpStepper,
    turning: Turning,
    motion: PoseMotion,
}

impl PoseStepper {
    pub(super) fn new(primitive: &PoseDmp, request: &PoseRequest) -> Result<Self, PoseError> {
        let (start, goal) = (checked(0, &request.start)?, checked(1, &request.goal)?);
        let coordinates = primitive.dmp.stepper(&coordinates(primitive, request))?;
        let turning = primitive.turn.turning(start.rotation, goal.rotation);
        let mut stepper = Self { motion: state(&coordinates, &turning), coordinates, turning };
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
        self.motion = state(&self.coordinates, &self.turning);
        Ok(())
    }

    /// Returns the present state.
    #[must_use]
    pub fn motion(&self) -> &PoseMotion {
        &self.motion
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

// q = e^ρ·q_b and its angular motion: ω = ω_ρ + e^ρ·ω_b, ω̇ = ω̇_ρ + ω_ρ × (e^ρ·ω_b) + e^ρ·ω̇_b
fn state(coordinates: &DmpStepper, turning: &Turning) -> PoseMotion {
    let halves = |six: &DVector<f64>| (Vector3::new(six[0], six[1], six[2]), Vector3::new(six[3], six[4], six[5]));
    let (place, rho) = halves(coordinates.position());
    let (linear, rate) = halves(coordinates.velocity());
    let (linear_acceleration, second) = halves(coordinates.acceleration());
    let residual = UnitQuaternion::from_scaled_axis(rho);
    let (own, own_change) = angular_motion(&rho, &rate, &second);
    let tau = coordinates.duration_s();
    let (carried, carried_change) = turning.angular_motion(coordinates.progress());
    let (carried, carried_change) = (residual * (carried / tau), residual * (carried_change / (tau * tau)));
    PoseMotion {
        pose: Isometry3::from_parts(Translation3::from(place), residual * turning.rotation(coordinates.progress())),
        linear_velocity_m_per_s: linear,
        angular_velocity_rad_per_s: own + carried,
        linear_acceleration_m_per_s2: linear_acceleration,
        angular_acceleration_rad_per_s2: own_change + own.cross(&carried) + carried_change,
    }
}
