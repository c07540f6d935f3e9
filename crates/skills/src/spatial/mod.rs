//! Plans in space: chains of named actions as timed tool poses, `world_from_tool`, with velocity and acceleration.
//!
//! The pieces that such plans are made of are here too: [`SpatialTrack`], twice continuously differentiable between its
//! knots; [`free_move`], minimum jerk through via points; [`certified_clearance`] of a moving body; and [`Hand`], the
//! noise of a human hand in six coordinates.

mod clearance;
mod free_move;
mod hand;
mod motion;
mod plan;
mod refusal;
mod resting;
mod timed_move;
mod track;
mod verification;

pub use clearance::{SpatialClearance, certified_clearance};
pub use free_move::{FreeMoveConfig, free_move, over};
pub use hand::{Hand, HandConfig};
pub use motion::{SpatialJump, SpatialMotion};
pub use plan::{ActionPhase, SpatialAction, SpatialPlan};
pub use refusal::SpatialError;
pub(crate) use resting::resting;
pub use timed_move::{rest, timed_move};
pub use track::{SpatialKnot, SpatialTrack, SpeedBounds};
pub use verification::{SpatialJoint, SpatialLimits, SpatialReport};
