//! Tool design: parameters of a tool are chosen by CMA-ES so that a scenario goes well, whatever its seed.
//!
//! A candidate is a tool whose file has other numbers under some keys. It is judged by a measure over several seeds; one
//! whose runs fail is worse than any whose runs succeed. The best one becomes an asset, and is compared with the start on
//! seeds that the search never saw.

mod cost;
mod file;
mod load;
mod report;
mod search;
mod trying;

pub use cost::Aggregate;
pub(crate) use file::DesignFile;
pub(crate) use load::EXAMPLE;
pub use load::{DesignTask, Parameter, design_title, is_design, load_design};
pub use report::{Candidate, DESIGN_SCHEMA, DesignReport, designed_asset};
pub use search::{Found, search};
pub use trying::{Trying, TryingError};
