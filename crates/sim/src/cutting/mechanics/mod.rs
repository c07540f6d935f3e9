//! The cutting law: forces between a knife's edge and a food in the plane of one cut.
//!
//! Work of the knife is the work of fracture R dA, friction and elastic energy (Atkins, "The Science and Engineering of
//! Cutting", 2009). All is plane: x along the edge, y the cutting direction, down into the food, z the blade's normal.
//!
//! The swept region is a profile: along columns of the section's width, how deep the crack has gone, exact in depth.
//! What lies above the profile is cut. This holds for every stroke that enters from above (pushing, slicing, sawing,
//! rocking, tilted, withdrawn and continued), but not for a blade that is stabbed in below uncut food: that counts as cut
//! from above. Toughness acts through an elastic edge zone of the food's indentation stiffness: force grows with the dent
//! before the edge until the crack runs. So a stalled knife is held, not slowed to a creep, and no motion is reversed.

mod config;
mod elements;
mod energy;
mod failure;
mod flank_grip;
mod front;
mod giving;
mod grid;
mod kinks;
mod lateral;
mod law;
mod motion;
mod process;
mod quality;
mod statics;
mod surface;
mod way;

pub use config::{Board, CuttingConfig};
pub use energy::Energy;
pub use failure::{Failure, FailureMonitor, Observation, Thresholds};
pub use law::{edge_force_n_per_m, slicing_ratio_at_which_food_slides};
pub use motion::EdgeMotion;
pub use process::{Cut, CutStep, Stage};
pub use quality::IncisionQuality;
pub use statics::{roll_limit_offset_m, rolls};
