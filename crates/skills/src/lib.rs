//! Movement primitives and tool-use skills: trajectories in, trajectories out.

pub mod baseline;
pub mod basis;
pub mod canonical;
pub mod corridor;
pub mod corridor_filter;
pub mod corridor_map;
pub mod coupling;
pub mod demonstration;
pub mod error;
pub mod field;
pub mod outline;
pub mod plan;
pub mod primitive;
pub mod pushing;
pub mod regression;
pub mod segmentation;
pub mod separation;
pub mod time_law;
pub mod tool;
pub mod tool_flipping;
pub mod tool_use;
pub mod trajectory;
pub mod transfer;

pub use error::SkillError;
pub use primitive::{
    Dmp, DmpConfig, DmpForm, DmpPair, DmpStepper, MovementPrimitive, PrimitiveConfig, Rollout, RolloutRequest,
    SavedDmp, rollout_pair,
};
pub use trajectory::Trajectory;
