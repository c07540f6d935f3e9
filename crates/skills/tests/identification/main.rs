//! The model-based separation, Algorithm 1: against reference vectors made with an independent Python program, the theory
//! of its convergence, and demonstrations rolled out past obstacles.

// helpers of tests may stop at the first surprise, as tests do
#![allow(clippy::unwrap_used)]

mod convergence;
mod errata;
mod refusals;
mod shown;
mod statistics;
mod support;
mod vectors;
