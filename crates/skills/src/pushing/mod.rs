//! Pushing an object over a table: what a pusher that sees the object should do.

mod renewal;
mod steering;

pub use renewal::HoldRenewalConfig;
pub use steering::{Steering, SteeringCommand, SteeringConfig};
