//! Tool-use skills learned from demonstrations: how the object moves under the tool, and how the tool changes its hold.

mod closing;
mod legs;
mod library;
mod planning;
mod refusal;
mod routing;
mod ways;

pub use legs::{Undivided, divide};
pub use library::{LearningReport, ObjectOperatingSkill, SkillLibrary, ToolFlippingSkill};
pub use planning::{Orientation, PushProblem};
pub use refusal::{LearnError, PlanError};
pub use routing::Surroundings;
