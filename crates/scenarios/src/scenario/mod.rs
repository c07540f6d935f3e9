//! The scenario file: everything that a run depends on, as one serializable struct for each kind of task.

pub(crate) mod changes;
mod check;
mod decode;
mod document;
mod draft;
mod explain;
mod given;
mod load;
pub(crate) mod named;
mod parts;
mod resolved;
mod shared;
mod skills_file;
mod source;
mod units;
mod words;

pub(crate) use changes::INTO_ASSET;
pub use changes::{Change, GivenBy, check_key, parse_value};
pub(crate) use document::{Node, Value, path};
pub(crate) use draft::{Draft, read as read_draft};
pub(crate) use explain::{Context, key_name};
pub(crate) use load::{Loader, load_as};
pub use load::{load, load_changed, load_text, notes, title};
pub(crate) use named::{
    Reader, asset_description, asset_source, demonstration_description, field_problem, skills_description,
    stated_description,
};
pub use parts::{CONTROL_RATE_HZ, LARGEST_SEED};
pub(crate) use parts::{is_in_name, name_of_file};
pub(crate) use resolved::{ArmKeys, ReadScenario, ScenarioFile};
pub use resolved::{AssetUsed, ResolvedScenario};
pub use shared::{Header, RecordingConfig, RobotConfig, ToolConfig};
pub(crate) use skills_file::describe as describe_skills;
pub use skills_file::{KeptSkills, Origin, SavedSkills, SkillsFile};
pub(crate) use source::Source;
pub(crate) use units::unit_of;
