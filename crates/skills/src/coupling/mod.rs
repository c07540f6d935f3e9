//! Couplings Δu of Eq. (6): the contract, and the list of laws.
//!
//! A further law is one file with an implementation of [`Coupling`], and its lines in this one.

mod cooperative;
mod hoffmann;
mod potential;

use std::fmt;

pub use cooperative::{CooperativeConfig, CooperativeCoupling};
pub use hoffmann::Hoffmann;
pub use potential::{DynamicPotential, PointObstacle, PotentialConfig, PotentialCoupling, StaticPotential};

use crate::error::SkillError;

/// State of a motion that a coupling sees; d coordinates, unit and frame of the demonstrations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionState<'a> {
    /// Position, d values.
    pub position: &'a [f64],
    /// Velocity (not scaled by τ), d values, per second.
    pub velocity: &'a [f64],
    /// Time since the motion started, s.
    pub elapsed_s: f64,
    /// Duration T = τ of the motion, s.
    pub duration_s: f64,
}

/// Law of an additional term Δu of Eq. (6): τv̇ = α(β(g − x) − v) + f(s) + Δu.
///
/// Contract: a pure function of the state, finite for a finite state, free of allocation. Δu stands next to the forcing
/// term: an acceleration a (per second squared) is Δu = τ²a.
pub trait Coupling: fmt::Debug + Send + Sync {
    /// Returns the number d of coordinates the law is for, or nothing if it serves any.
    fn dimension(&self) -> Option<usize> {
        None
    }

    /// Adds Δu of the law at `state` to `sum` (d values).
    fn add_to(&self, state: &MotionState<'_>, sum: &mut [f64]);
}

/// Sums Δu of all `couplings` at `state` into `sum` (d values).
///
/// # Errors
/// If a coupling is of another dimension or the sum is not finite.
pub(crate) fn add_up(couplings: &[&dyn Coupling], state: &MotionState<'_>, sum: &mut [f64]) -> Result<(), SkillError> {
    sum.fill(0.0);
    for (index, coupling) in couplings.iter().enumerate() {
        if let Some(found) = coupling.dimension().filter(|dimension| *dimension != sum.len()) {
            return Err(SkillError::Dimension { operation: "evaluate coupling", found, expected: sum.len() });
        }
        coupling.add_to(state, sum);
        if let Some(coordinate) = sum.iter().position(|value| !value.is_finite()) {
            return Err(SkillError::NonFiniteCoupling { coupling: index, coordinate, found: sum[coordinate] });
        }
    }
    Ok(())
}
