//! How closely a Panda carries a tool along a motion, for several gains of the impedance controller and several ways in which
//! the real arm differs from the controller's model.
//!
//! The motion takes 4 s: the hand, 25° below the horizontal, moves 0.30 m sideways and 0.10 m up and turns by 110° about its
//! approach axis in 3 s (minimum jerk), then holds for 1 s. With a perfect model every gain tracks it within an eighth of a
//! millimeter; the other conditions tell gains apart.

mod condition;
mod gains;
mod motion;
mod outcome;
mod report;
mod runs;
mod table;

pub use condition::Condition;
pub use gains::StudiedGains;
pub use motion::{StudyMotion, start_of_study};
pub use outcome::{GainStudy, GainSummary, RunOutcome};
pub use report::report;
pub use runs::{FR3_ROTOR_INERTIA_KG_M2, bare_arm_divergence_s, gain_study};
