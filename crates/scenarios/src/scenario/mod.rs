//! The scenario file: everything that a run depends on, as one serializable struct for each kind of task.

mod check;
mod decode;
mod document;
mod draft;
mod explain;
mod load;
pub(crate) mod named;
mod parts;
mod resolved;
mod shared;
mod skills_file;
mod source;
mod units;
mod words;

pub(crate) use document::path;
pub(crate) use explain::{Context, key_name};
pub(crate) use load::{Loader, load_as};
pub use load::{load, notes, title};
pub(crate) use named::{Reader, asset_description, demonstration_description, skills_description, stated_description};
pub use parts::{CONTROL_RATE_HZ, LARGEST_SEED};
pub use resolved::ResolvedScenario;
pub(crate) use resolved::{ArmKeys, ReadScenario, ScenarioFile};
pub use shared::{Header, RecordingConfig, RobotConfig, ToolConfig};
pub use skills_file::{Origin, SkillsFile};
pub(crate) use source::Source;
