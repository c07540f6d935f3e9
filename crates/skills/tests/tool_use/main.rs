//! Learning to use a tool from demonstrations whose truth is known, and planning with what was learned.

// helpers of tests may stop at the first surprise, as tests do
#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

mod chain;
mod generalizing;
mod kinds;
mod learning;
mod planning;
mod refusals;
mod segmentation;
mod shown;
mod transferring;
