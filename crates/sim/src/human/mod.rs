//! A synthetic human who demonstrates a task by driving the tool in the physics.

mod config;
mod demonstrate;
mod hand;
mod motor;
mod operator;

pub use config::HumanConfig;
pub use demonstrate::{DemonstrationTask, Trial, demonstrate};
