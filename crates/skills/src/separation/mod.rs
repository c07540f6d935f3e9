//! Separation of the constraint-irrelevant skill from demonstrations that were shown under constraints.

pub mod constraint_based;
pub mod model_based;
