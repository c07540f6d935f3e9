//! The tool's reference while a plan is carried out. A source of references is one file and its lines here.

mod closed_loop;
mod open_loop;
mod renewal;
mod room;
mod settling;

use nalgebra::{Isometry2, Point2};
use skills::plan::PlanarMotion;

use crate::sensing::Sighting;

pub use closed_loop::{ClosedLoop, ClosedLoopConfig};
pub use open_loop::OpenLoop;

/// Where the tool should be now, and what the plan expects of the object.
#[derive(Clone, Copy, Debug)]
pub struct ToolReference {
    /// Motion of the tool, world frame.
    pub tool: PlanarMotion,
    /// Where the plan expects the object.
    pub world_from_object_expected: Isometry2<f64>,
    /// Where the object is believed to be, if the source keeps a belief.
    pub object_believed_world: Option<Point2<f64>>,
    /// Index of the current action.
    pub phase: usize,
    /// Whether the tool is to push the object now.
    pub is_pushing: bool,
    /// Whether the tool is off the object to renew its hold in the current push.
    pub renews_hold: bool,
    /// Whether the current push has run out of time and is being given up.
    pub gives_up: bool,
    /// Whether the plan has come to its end.
    pub finished: bool,
}

/// Source of the tool's reference, asked once per control period.
pub trait ReferenceSource {
    /// The reference at `time_s`, given where the joint sensors say that the tool is and the newest sighting of the
    /// object; allocates nothing.
    fn next(&mut self, time_s: f64, world_from_tool: &Isometry2<f64>, sighting: Option<&Sighting>) -> ToolReference;
}
