//! Rapier scenes, controllers and the control loop.

pub mod controllers;
pub mod cutting;
mod error;
pub mod human;
pub mod planar;
pub mod pouring;
pub mod random;
pub mod sensing;
pub mod spatial;
pub mod support;

pub use error::SimError;
