//! The cutting law against closed forms, measured forces, and its own balance of energy.

#![expect(clippy::expect_used, reason = "a test stops at the first surprise")]

mod allocation;
mod behavior;
mod closed_forms;
mod energy;
mod failures;
mod stroke;
mod surface;
