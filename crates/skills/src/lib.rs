//! Movement primitives and tool-use skills: trajectories in, trajectories out.

pub mod basis;
pub mod canonical;
pub mod demonstration;
pub mod error;
pub mod field;
pub mod outline;
pub mod plan;
pub mod primitive;
pub mod pushing;
pub mod regression;
pub mod segmentation;
pub mod time_law;
pub mod tool;
pub mod tool_use;
pub mod trajectory;

pub use error::SkillError;
pub use primitive::{Dmp, DmpConfig, DmpForm, DmpStepper, MovementPrimitive, PrimitiveConfig, Rollout, RolloutRequest};
pub use trajectory::Trajectory;
