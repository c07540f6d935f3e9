//! What can go wrong while a scene is built or simulated.

use skills::field::FieldError;

/// Failure of a scene or of a simulation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    /// A configuration value that cannot be used.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// The state stopped being finite, or the object left the map by more than its size: numbers mean nothing from here on.
    #[error(
        "simulate: {quantity} was {value} at {time_s:.4} s; expected a finite value; reduce engine.time_step_s or the controller's gains"
    )]
    Diverged {
        /// What diverged, with its unit.
        quantity: String,
        /// Its value.
        value: f64,
        /// Simulated time, s.
        time_s: f64,
    },
    /// The plan asks for a pose that the arm cannot take.
    #[error("{reason}; at {time_s:.3} s of the plan; move the arm's base, the goal or the start")]
    Unreachable {
        /// What is out of reach: pose, distance, joint.
        reason: String,
        /// Time in the plan, s.
        time_s: f64,
    },
    /// The arm's model cannot be simulated in this world.
    #[error("build arm: {reason}")]
    Arm {
        /// What is wrong and how to mend it.
        reason: String,
    },
    /// A food cannot be divided as the knife went.
    #[error("cut food: {reason}")]
    Cutting {
        /// What is wrong and how to mend it.
        reason: String,
    },
    /// A skill failed while the scene was run.
    #[error(transparent)]
    Skill(#[from] skills::SkillError),
    /// The arm's mathematics failed.
    #[error(transparent)]
    Robot(#[from] robot::RobotError),
}
