//! The dynamic movement primitive beyond one rollout: accuracy, memory, couplings, weights, changes on the way, files.

// helpers of tests may stop at the first surprise, as tests do
#![allow(clippy::unwrap_used, clippy::panic)]

mod accuracy;
mod allocation;
mod changes;
#[path = "../common/mod.rs"]
mod common;
mod couplings;
mod pairs;
mod saved;
mod weights;
