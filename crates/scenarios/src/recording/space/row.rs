//! One row of a spatial recording: a sample copied into memory of its own.

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector6};
use sim::spatial::{Sample, SceneDescription};

/// A sample in memory of its own, with the largest force since the row before.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) step: u64,
    pub(super) time_s: f64,
    pub(super) phase: usize,
    pub(super) world_from_tool: Isometry3<f64>,
    pub(super) world_from_tool_reference: Isometry3<f64>,
    pub(super) links: Vec<Isometry3<f64>>,
    pub(super) q_rad: Vec<f64>,
    pub(super) dq_rad_per_s: Vec<f64>,
    pub(super) q_reference_rad: Vec<f64>,
    pub(super) torque_nm: Vec<f64>,
    pub(super) tool_wrench: Vector6<f64>,
    /// Largest force on the tool since the row before, N.
    pub(super) force_peak_n: f64,
    pub(super) bodies: Vec<Isometry3<f64>>,
    pub(super) grain_centers: Vec<Point3<f64>>,
    pub(super) grain_turns: Vec<UnitQuaternion<f64>>,
    pub(super) series: Vec<f64>,
    /// Whether something was copied that no row holds yet.
    pub(super) waits: bool,
}

impl Row {
    /// An empty row with room for what `scene` shows.
    pub(super) fn new(scene: &SceneDescription) -> Self {
        let joints = || Vec::with_capacity(scene.arm.joints.len());
        let grains = scene.grains.as_ref().map_or(0, |grains| grains.half_sizes_m.len());
        Self {
            step: 0,
            time_s: 0.0,
            phase: 0,
            world_from_tool: Isometry3::identity(),
            world_from_tool_reference: Isometry3::identity(),
            links: Vec::with_capacity(scene.arm.links.len()),
            q_rad: joints(),
            dq_rad_per_s: joints(),
            q_reference_rad: joints(),
            torque_nm: joints(),
            tool_wrench: Vector6::zeros(),
            force_peak_n: 0.0,
            bodies: Vec::with_capacity(scene.bodies.len()),
            grain_centers: Vec::with_capacity(grains),
            grain_turns: Vec::with_capacity(grains),
            series: Vec::with_capacity(scene.series.len()),
            waits: false,
        }
    }

    /// Copies a sample; the largest force grows until [`Row::written`].
    pub(super) fn copy(&mut self, sample: &Sample<'_>) {
        self.step = sample.step;
        self.time_s = sample.time_s;
        self.phase = sample.phase;
        self.world_from_tool = sample.world_from_tool;
        self.world_from_tool_reference = sample.world_from_tool_reference;
        self.tool_wrench = sample.tool_wrench;
        self.force_peak_n = self.force_peak_n.max(sample.tool_wrench.fixed_rows::<3>(0).norm());
        replace(&mut self.links, sample.world_from_links);
        replace(&mut self.q_rad, sample.q_rad);
        replace(&mut self.dq_rad_per_s, sample.dq_rad_per_s);
        replace(&mut self.q_reference_rad, sample.q_reference_rad);
        replace(&mut self.torque_nm, sample.torque_nm);
        replace(&mut self.bodies, sample.world_from_bodies);
        replace(&mut self.grain_centers, sample.grain_centers_world);
        replace(&mut self.grain_turns, sample.grain_turns);
        replace(&mut self.series, sample.series);
        self.waits = true;
    }

    /// Marks the row as written: the largest force begins anew.
    pub(super) fn written(&mut self) {
        self.force_peak_n = 0.0;
        self.waits = false;
    }
}

fn replace<T: Copy>(memory: &mut Vec<T>, values: &[T]) {
    memory.clear();
    memory.extend_from_slice(values);
}
