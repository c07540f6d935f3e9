//! Corridor filters: against numbers of an independent program, against what the paper claims, and in many random
//! corridors.

// helpers of tests may stop at the first surprise, as tests do
#![allow(clippy::unwrap_used, clippy::panic)]

mod cases;
mod errata;
mod properties;
mod statistics;
mod vectors;
