//! Where the tool should be: sources of references, one for each control instant.

use nalgebra::{Isometry3, Vector6};

/// Where the tool should be at one control instant, and how it should move.
#[derive(Clone, Debug, PartialEq)]
pub struct SpatialReference {
    /// Wanted pose of the tool's frame.
    pub world_from_tool: Isometry3<f64>,
    /// Wanted velocity of the tool's origin (m/s, rows 0–2) and angular velocity (rad/s, rows 3–5), world axes.
    pub velocity: Vector6<f64>,
    /// Wanted acceleration (m/s², rad/s²), world axes.
    pub acceleration: Vector6<f64>,
    /// Force (N, rows 0–2) and moment about the tool's origin (N m, rows 3–5), world axes, that the surroundings are expected
    /// to exert on the tool: the arm is told to withstand it. Zero if nothing is known.
    pub expected_wrench: Vector6<f64>,
    /// Index of the current action.
    pub phase: usize,
    /// Whether the plan has come to its end.
    pub finished: bool,
}

impl SpatialReference {
    /// Rest at a pose.
    #[must_use]
    pub fn at_rest(world_from_tool: Isometry3<f64>) -> Self {
        let zero = Vector6::zeros();
        Self { world_from_tool, velocity: zero, acceleration: zero, expected_wrench: zero, phase: 0, finished: false }
    }
}

/// Gives the reference of each control instant; may look at where the tool is.
pub trait ReferenceSource {
    /// The reference at `time_s`, with the tool at `world_from_tool`.
    fn next(&mut self, time_s: f64, world_from_tool: &Isometry3<f64>) -> SpatialReference;
}

impl<F: FnMut(f64, &Isometry3<f64>) -> SpatialReference> ReferenceSource for F {
    fn next(&mut self, time_s: f64, world_from_tool: &Isometry3<f64>) -> SpatialReference {
        self(time_s, world_from_tool)
    }
}
