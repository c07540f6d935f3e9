//! Cutting: foods that come apart, knives, the forces between them, and the scene in which an arm cuts.

pub mod food;
pub mod geometry;
pub mod knife;
pub mod material;
pub mod mechanics;
pub mod scene;
