//! What tasks in space share: the arm with what it holds, plans that it follows, measures of how it followed them.

mod following;
mod held_arm;
mod measures;
mod recorded;
mod robot;
mod trials;

pub(crate) use following::PlanSource;
pub(crate) use held_arm::{Aim, HeldArm, Readied, built};
pub(crate) use measures::arm_measures;
pub(crate) use recorded::{check_near, is_poses, read as read_poses, write as write_poses};
pub use robot::SpatialRobotConfig;
pub(crate) use trials::{Trial, run_trials};
