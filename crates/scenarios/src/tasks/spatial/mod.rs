//! What tasks in space share: the arm with what it holds, plans that it follows, measures of how it followed them.

mod following;
mod held_arm;
mod measures;
mod robot;

pub(crate) use following::PlanSource;
pub(crate) use held_arm::{HeldArm, Readied, built};
pub(crate) use measures::arm_measures;
pub use robot::SpatialRobotConfig;
