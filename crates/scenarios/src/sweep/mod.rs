//! Sweeps: one scenario with many values of some of its keys, under the same seeds at each point.
//!
//! A sweep file names the scenario, the factors, and the design by which their values are combined: a grid, random points,
//! a Latin hypercube, or points of the Sobol' sequence. It is planned as a [`crate::campaign`]: which runs there are
//! depends on the file alone, never on threads, machines or the order of work.
//!
//! ```toml
//! [sweep]
//! scenario = "../push_transfer_l.toml"       # relative to this file
//! trials = 10                                # seeds at each point, the same for all: differences are paired
//! first_seed = 1                             # the scenario's if absent
//! invalid_points = "record"                  # or "refuse", which is usual for a grid: points that make no valid scenario
//!
//! [design.latin_hypercube]                   # or grid, which is usual, random, sobol
//! points = 64
//! seed = 1
//!
//! [[factor]]
//! key = "object.table_friction"              # as for --set
//! uniform = { min = 0.15, max = 0.4 }        # or log_uniform, integers, normal = { mean, sd, min, max }, values = [...]
//! ```

mod design;
mod factor;
mod file;
mod load;
#[expect(clippy::excessive_precision, reason = "coefficients with all digits that were published")]
mod normal;
mod summary;

pub use factor::{Factor, Values};
pub(crate) use file::SweepFile;
pub use file::{Design, IntegerRange, MOST_RUNS, Normal, Range};
pub(crate) use load::EXAMPLE;
pub use load::{Sweep, is_sweep, load_sweep, sweep_title};
pub use summary::{FactorSummary, LevelSummary, MeasureSummary, SUMMARY_SCHEMA, SweepSummary};
