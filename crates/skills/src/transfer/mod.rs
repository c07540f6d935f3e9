//! Tool transfer: what a skill shown with one tool becomes with another one, among obstacles.
//!
//! The paper generalizes three times (Fig. 5(c)): the intention to a new start and goal, then past obstacles, then to what
//! tool and arm can do. The last step is a search here, exact for its cost, over surface, place on it and place of the
//! object.

mod barring;
mod bound;
mod cells;
mod chaining;
mod changing;
mod config;
#[cfg(test)]
mod fixtures;
mod grid;
mod holds;
mod passages;
mod phases;
mod problem;
mod reference;
mod refusal;
mod search;
mod shapes;
mod sweep;
mod workplace;

pub use barring::Barring;
pub use config::{SearchConfig, TransferConfig};
pub use holds::Hold;
pub use passages::{Passage, Side, corridor, passages};
pub use phases::{Phase, Phases};
pub use problem::{Transfer, TransferProblem};
pub use reference::Reference;
pub use refusal::{NoPhases, TransferError, explain};
pub use search::PhaseSearch;
pub use workplace::{Everywhere, Reach, RectangularReach, Workplace};
