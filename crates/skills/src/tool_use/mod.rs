//! Tool-use skills learnt from demonstrations: how the object moves under the tool, and how the tool changes its hold.

mod legs;
mod library;
mod planning;
mod routing;

pub use legs::{Undivided, divide};
pub use library::{LearningReport, ObjectOperatingSkill, SkillLibrary, ToolFlippingSkill};
pub use planning::{Orientation, PlanError, PushProblem};
pub use routing::Surroundings;
