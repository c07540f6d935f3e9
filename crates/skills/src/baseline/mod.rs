//! Baseline planners to compare with: RRT* for the object, and two-level tool planning on its path.
//!
//! The paper takes the two-level planner from elsewhere and states the parameters of its first level only (§IV.B). What
//! is missing is chosen here in favor of the baseline: the tool level finds the fewest changes of surface that the path
//! allows, and a shortcut variant of the path shows what of the paper's count is owed to the sampling.

mod free_space;
mod measures;
mod neighbors;
mod rrt_star;
mod shortcut;
mod tree;
mod two_level;

pub use free_space::FreeSpace;
pub use measures::{PathMeasures, heading_changes};
pub use rrt_star::{RrtStar, RrtStarConfig, SearchCounts};
pub use shortcut::shortcut;
pub use two_level::{
    Hold, Obstruction, Phase, Segment, ToolTurning, TwoLevelConfig, TwoLevelMeasures, TwoLevelPlan, TwoLevelProblem,
};
