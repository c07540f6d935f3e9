//! Pushing an object over a table: what a pusher that sees the object should do.

mod steering;

pub use steering::{Steering, SteeringCommand, SteeringConfig};
