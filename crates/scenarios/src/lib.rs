//! TOML scenarios, the pipeline from demonstrations to an outcome, reports and recordings.

pub mod assets;
pub mod cli;
pub mod diagnostic;
pub mod files;
pub mod measures;
pub mod outcome;
pub mod pipeline;
#[cfg(feature = "recording")]
pub mod recording;
pub mod report;
mod reproduction;
pub mod scenario;
pub mod suggest;
pub mod tasks;
pub mod trials;
