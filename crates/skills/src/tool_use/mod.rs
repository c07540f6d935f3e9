//! Tool-use skills learned from demonstrations: how the object moves under the tool, and how the tool changes its hold.

mod closing;
mod intention;
mod legs;
mod library;
mod operating;
mod planning;
mod refusal;
mod routing;
mod saved;
mod ways;

pub(crate) use closing::straight_on;
pub use intention::Intention;
pub use legs::{Undivided, divide};
pub use library::{LearningReport, ObjectOperatingSkill, SkillLibrary, ToolFlippingSkill};
pub use planning::{Orientation, PushProblem};
pub use refusal::{LearnError, PlanError};
pub use routing::Surroundings;
pub use saved::{SavedFlip, SavedIntention, SavedLibrary, SavedPush};
