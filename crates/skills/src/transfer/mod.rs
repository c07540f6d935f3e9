//! Tool transfer: what a skill shown with one tool becomes with another one, among obstacles.
//!
//! The paper generalizes three times (Fig. 5(c)): the intention to a new start and goal, then past obstacles, then to what
//! tool and arm can do. The last step is a search here, exact for its cost, over surface, place on it and place of the
//! object.

mod bound;
mod cells;
mod config;
mod holds;
mod passages;
mod problem;
mod reference;
mod refusal;
mod search;
mod workplace;

pub use config::TransferConfig;
pub use holds::{Hold, holds};
pub use passages::{Passage, Side, corridor, passages};
pub use problem::{Transfer, TransferProblem};
pub use reference::Reference;
pub use refusal::{NoPhases, TransferError, explain};
pub use search::{Phase, PhaseSearch, Phases, SearchConfig};
pub use workplace::{Everywhere, Reach, RectangularReach, Workplace};
