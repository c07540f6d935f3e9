//! TOML scenarios, the pipeline from demonstrations to an outcome, reports and recordings.
//!
//! # Example
//!
//! Load a scenario with another value of one key, run it, read a measure:
//!
//! ```
//! use std::path::Path;
//!
//! use scenarios::assets::Assets;
//! use scenarios::pipeline;
//! use scenarios::scenario::{Change, load_text};
//!
//! let file = Path::new("../../scenarios/hold_panda.toml");
//! let text = std::fs::read_to_string(file)?;
//! let changes = ["limits.largest_tool_error_m=0.02".parse::<Change>()?];
//! let scenario = load_text(file, &text, &changes, &Assets::find(None, Some(file))).map_err(|problems| problems[0].clone())?;
//!
//! let report = pipeline::run(&scenario, 1, &mut (), &|_, _| {})?;
//! assert!(report.outcome.success);
//! let deviation = report.outcome.measures.iter().find(|measure| measure.name == "tool_error_max_mm");
//! assert!(deviation.and_then(|measure| measure.value).is_some_and(|deviation_mm| deviation_mm < 20.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod assets;
pub mod campaign;
pub mod cli;
pub mod comparison;
pub mod diagnostic;
pub mod files;
pub mod measures;
pub mod outcome;
pub mod pipeline;
mod plot;
#[cfg(feature = "recording")]
pub mod recording;
pub mod report;
mod reproduction;
pub mod scenario;
pub mod schema;
pub mod statistics;
pub mod suggest;
pub mod sweep;
pub mod tasks;
pub mod telemetry;
pub mod tool_design;
pub mod trials;
