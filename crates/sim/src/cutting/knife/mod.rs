//! Knives: shape, edge, mass and grip from a few lengths.
//!
//! The knife's frame has its origin at the heel of the edge: x along the edge toward the tip, y the cutting direction
//! (from the spine toward the edge), z the normal of the blade. A further family is one variant of [`BladeFamily`].

mod edge;
mod family;
mod file;
mod solid;

pub use edge::Edge;
pub use family::{BladeFamily, BladeShape, Serration, WireShape};
pub use file::{Handle, Knife, KnifeFile};
pub use solid::{MassOf, Piece};

#[cfg(test)]
mod tests;
