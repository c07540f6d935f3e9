//! Pouring skills: a demonstrated approach and tilt, carried to other cups, mouths and fills.
//!
//! The approach is an object-operating skill: its corridor of place, height and tilt is taken out of it, Eqs. (16) to (21),
//! and that of the new place put in, Eqs. (29) to (32). The tilt is a tool-flipping skill in the relative frame, Eqs. (22)
//! to (28): the way of the lip about the mouth, over the angle of tilt, is the skill's own way x^t and a virtual movement
//! k2·x^o, the least height at which the cup clears the rim.
//!
//! Departs from the paper, which does not tell its frames: the phase is the angle of tilt, x^o is computed from the shapes
//! instead of learned, and clearances are certified between samples.
//!
//! # Example
//!
//! ```
//! use nalgebra::{Isometry3, Point3};
//! use rand::SeedableRng;
//! use skills::pouring::{Container, Mouth, PourHuman, PourLearning, PourSkill, PourTask};
//!
//! let cup = Container::default();
//! let bowl = Mouth { center_world: Point3::new(0.5, 0.0, 0.06), radius_m: 0.06, wall_m: 0.003, shoulder: None };
//! let start = Isometry3::translation(0.2, 0.0, 0.0);
//! let human = PourHuman::default();
//! let shown = human.demonstrate(&cup, &bowl, &start, rand_chacha::ChaCha8Rng::seed_from_u64(1))?;
//!
//! let skill = PourSkill::learn(&PourLearning::default(), &shown)?;
//! let bottle = Mouth { center_world: Point3::new(0.4, 0.1, 0.21), radius_m: 0.02, ..bowl };
//! let planned = skill.plan(&PourTask::new(start, cup, bottle))?;
//! assert!(planned.report.clearance_m > 0.003);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod amount;
mod approach;
mod container;
mod demonstration;
mod human;
mod learning;
mod plain;
mod planning;
mod refusal;
mod saved;
mod steering;
mod stream;
mod task;
mod tilting;

pub use amount::{AmountControl, AmountOptions, TiltCommand};
pub use container::{Container, Mouth, Shoulder};
pub use demonstration::PourDemonstration;
pub use human::PourHuman;
pub use learning::{PourLearning, PourSkill, ShownPour};
pub use planning::{PourPlan, PourReport};
pub use refusal::PourError;
pub use saved::SavedPour;
pub use steering::TiltSteering;
pub use task::{Fill, PourAim, PourOptions, PourTask};

#[cfg(test)]
mod tests;
