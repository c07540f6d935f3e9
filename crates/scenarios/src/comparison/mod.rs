//! Comparisons: the same scenario under the same seeds with different tools or other values, and which of them is better,
//! by how much and how surely.
//!
//! Every variant runs the same seeds, so that what differs from seed to seed differs for all of them alike: differences
//! are taken seed by seed against the first variant.

mod build;
mod charts;
mod differences;
mod page;
mod result;
mod sentences;
mod table;
mod variants;
mod verdict;

pub use build::{UnknownMeasure, check_measures, compare};
pub use page::page;
pub use result::{
    COMPARISON_SCHEMA, ComparedMeasure, Comparison, Difference, FailedTrial, Limits, Spread, SuccessDifference, Variant,
};
pub use sentences::{Statement, remarks, statements};
pub use table::text;
pub use variants::{Variation, points, variant_names};
pub use verdict::Verdict;
