//! The scene of cutting: a food on a board in the engine, and the knife in the arm's hand.
//!
//! The food is a rigid body that touches the board and its own pieces, but not the knife: between knife and food acts the
//! cutting law alone, as a force on the arm and the opposite force on the food in every step. Where the edge enters a piece,
//! the plane of the blade is frozen in the piece, and the law begins a cut of that section; when the law says that the
//! section is through, the piece comes apart along the way that the blade took, and its parts go on as bodies of their own.
//!
//! What is simplified: a blade that comes from the side, not through the top of a piece, passes through it without force
//! (an event says so), as does one that is drawn out between pieces that are apart; when a piece comes apart, other cuts
//! in it that were begun and left are forgotten.

mod board_force;
mod drawings;
mod edge_grip;
mod held;
mod incision;
mod knife_motion;
mod piece;
mod process;
mod record;
mod rest;
mod section_frame;
mod setup;
mod tally;

pub use held::{held_knife, knife_from_tool};
pub use process::CuttingProcess;
pub use record::{CutRecord, CuttingRecord, PieceRecord};
pub use rest::pose_at_rest;
pub use setup::{CuttingBoard, CuttingSetup};
