//! Foods: their shapes from a few lengths, what they are made of, and in what they differ from one another.

mod banana;
mod file;
mod look;
mod revolved;
mod shape;
mod variation;

pub use banana::Banana;
pub use file::{Food, FoodFile};
pub use look::FoodLook;
pub use shape::{Berry, Block, Cylinder, Disc, Ellipsoid, Shape};
pub use variation::{FoodRange, FoodSample};
