//! Tool flipping divided into the tool's own way and a virtual motion of the object, Eqs. (22)–(28), and its
//! collision-free generalization to another tool.
//!
//! Departs from the paper: by default k1 = I and the goal g^t of the tool's own way is solved for instead of k1, which
//! exists for every displacement and dimension. The virtual motion of the object is the way of its center round the
//! outline of the tool, in the tool's frame, and k2 is the smallest that is certified to be free of collisions.

mod certificate;
mod clearance;
mod contour;
pub mod decomposition;
pub mod factors;
mod generalization;
mod learning;
mod options;
mod refusal;
mod search;
mod virtual_motion;
mod way;

pub use certificate::FlipCertificate;
pub use generalization::{Flip, FlipTask};
pub use learning::{ShownFlip, ToolFlip};
pub use options::{FlipOptions, SecondFactor, WayRound};
pub use refusal::FlipError;
