//! Tool flipping: factors and their errata, division and recombination, and certified generalization.

// helpers of tests may stop at the first surprise, as tests do
#![allow(clippy::unwrap_used, clippy::panic)]

mod certified;
mod decomposition;
mod experiment1;
mod factors;
mod figures;
mod learned;
mod scenes;
