//! Cutting skills: a demonstrated stroke, freed of its section plane and size, carried to other foods and knives.
//!
//! The section that is cut constrains the knife: of the six coordinates of a demonstrated stroke three lie across the
//! section and are noise about it, three lie in it (draw along the edge, depth, rocking) and are learned as a skill free
//! of constraints, Eqs. (16) to (21), inside the corridor that section, board and length of the edge leave. For a new
//! food the skill runs in the corridor of the new section and is certified to stay inside, Eqs. (29) to (32).
//!
//! Departs from the paper, which tells neither coordinates nor corridor: lengths are measured in depths of the stroke, so
//! that the slice–push ratio is kept; draws that the edge has no room for become strokes to and fro.
//!
//! # Example
//!
//! Learn from one cut that a human showed, and cut another food into three:
//!
//! ```
//! use nalgebra::{Isometry3, Vector3};
//! use rand::SeedableRng;
//! use skills::cutting::{Blade, CutHuman, CutLearning, CutSkill, CutTask, Section};
//!
//! // cutting direction down, 30 mm wide and high, at the origin of the world
//! let down = Isometry3::rotation(Vector3::x() * -std::f64::consts::FRAC_PI_2);
//! let food = Section { world_from_section: down, width_m: 0.03, height_m: 0.03 };
//! let blade = Blade { edge_m: 0.15, ..Blade::default() };
//! let shown = CutHuman::default().demonstrate(&food, &blade, rand_chacha::ChaCha8Rng::seed_from_u64(1))?;
//!
//! let skill = CutSkill::learn(&CutLearning::default(), &shown)?;
//! let wide = Section { width_m: 0.06, height_m: 0.05, ..food };
//! let home = Isometry3::translation(0.0, -0.1, 0.2) * down;
//! let task = CutTask::new(home, blade, vec![wide.shifted(-0.02), wide.shifted(0.02)]);
//! let planned = skill.plan(&task)?;
//! assert!(planned.cuts.iter().all(|cut| cut.past_board_m <= 0.0005 && cut.edge_margin_m > 0.0));
//! let knife = planned.plan.at(2.0); // pose, velocity and acceleration
//! # let _ = knife;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod demonstration;
mod human;
mod in_plane;
mod incision;
mod learning;
mod plain;
mod planning;
mod refusal;
mod saved;
mod section;
mod stroke;
mod task;

pub use demonstration::{CutDemonstration, OutOfPlane};
pub use human::CutHuman;
pub use incision::Incision;
pub use learning::{CutLearning, CutSkill, ShownStroke, ShownWhole};
pub use planning::{CutPlan, CutReport};
pub use refusal::CutError;
pub use saved::SavedCut;
pub use section::{Blade, Section};
pub use task::{CutOptions, CutTask, Stroke};

#[cfg(test)]
mod tests;
