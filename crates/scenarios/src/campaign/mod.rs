//! Campaigns: many runs of one scenario, planned before the first begins, each with an identity of its own.
//!
//! A campaign lives in a folder. Its manifest says what is to be run; journals, one for each process that worked on it,
//! hold a line for every run that ended. Tables are made from these and can be made anew at any time. A run is done if
//! its line is in some journal: that is all that resuming, sharding and merging rest on.

mod execute;
mod folder;
mod identity;
mod journal;
mod manifest;
mod plan;
mod row;
mod status;
pub mod submission;
mod tables;

pub use execute::{Attempt, Execution, Summary, execute, load_run};
pub use folder::{CampaignFolder, FolderError};
pub use identity::{RunId, run_id};
pub use journal::{Journal, JournalReader};
pub use manifest::{Base, CAMPAIGN_SCHEMA, Factor, Manifest, ManifestError, PlannedRun, Shard};
pub use plan::{InvalidPoint, InvalidPoints, plan};
pub use row::Row;
pub use status::{CampaignStatus, STATUS_SCHEMA};
pub use tables::{TableFormat, write_tables};
