//! Curves of a spatial run: tracking, force on the tool, joints, and what the task adds.

use rerun::{RecordingStream, RecordingStreamResult};
use sim::spatial::SceneDescription;

use super::row::Row;
use crate::recording::curves::{Curves, JointRow, part, send_torque_limits};
use crate::recording::style;
use crate::recording::times::Times;

const MM_PER_M: f64 = 1e3;
const MRAD_PER_RAD: f64 = 1e3;

/// All curves of a run.
pub(super) struct Plots {
    curves: Curves,
    joints: Vec<String>,
    torque_limits_nm: Vec<f64>,
}

/// Place of a task's plot below `/plots`.
pub(super) fn task_plot(plot: &str) -> String {
    format!("task/{}", part(plot))
}

impl Plots {
    /// Room for `rows` rows of `scene`.
    pub(super) fn new(scene: &SceneDescription, rows: usize) -> Self {
        let mut curves = Curves::with_capacity(rows);
        for (path, name, legend, color) in [
            ("tracking/distance", "tool to its reference [mm]", "distance [mm]", style::TOOL),
            ("tracking/angle", "turn of the tool to its reference [mrad]", "angle [mrad]", style::TOOL_PLAN),
            ("force/x", "force on the tool, x [N]", "x [N]", style::JOINTS[0]),
            ("force/y", "force on the tool, y [N]", "y [N]", style::JOINTS[1]),
            ("force/z", "force on the tool, z [N]", "z [N]", style::JOINTS[2]),
            ("force/peak", "force on the tool, peak [N]", "peak [N]", style::FORCE),
            ("state/action", "action [number]", "action", style::TOOL),
        ] {
            curves.add_short(path, name, legend, color);
        }
        curves.add_joints(&scene.arm.joints);
        for (series, color) in scene.series.iter().zip(style::JOINTS.iter().cycle()) {
            curves.add(&format!("{}/{}", task_plot(&series.plot), part(&series.name)), &series.name, *color);
        }
        Self { curves, joints: scene.arm.joints.clone(), torque_limits_nm: scene.arm.torque_limits_nm.clone() }
    }

    /// Adds a row, in the order of the list above.
    pub(super) fn push(&mut self, row: &Row) {
        let (tool, reference) = (&row.world_from_tool, &row.world_from_tool_reference);
        let force = row.tool_wrench.fixed_rows::<3>(0);
        let single = [
            (tool.translation.vector - reference.translation.vector).norm() * MM_PER_M,
            tool.rotation.angle_to(&reference.rotation) * MRAD_PER_RAD,
            force.x,
            force.y,
            force.z,
            row.force_peak_n,
            row.phase as f64 + 1.0,
        ];
        let joints = JointRow {
            q_reference_rad: &row.q_reference_rad,
            q_rad: &row.q_rad,
            dq_rad_per_s: &row.dq_rad_per_s,
            torque_nm: &row.torque_nm,
        };
        // a task that gives fewer values than it named leaves gaps
        let task = row.series.iter().copied().chain(std::iter::repeat(f64::NAN));
        self.curves.push(single.into_iter().chain(joints.values(self.joints.len())).chain(task));
    }

    /// The curves.
    pub(super) fn curves(&self) -> &Curves {
        &self.curves
    }

    /// Sends names and colors.
    pub(super) fn send_static(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        self.curves.send_static(stream)
    }

    /// Hands all rows to the stream.
    pub(super) fn send(&self, stream: &RecordingStream, times: &Times) -> RecordingStreamResult<()> {
        self.curves.send(stream, times)
    }

    /// Sends the torque limits as level lines from the start to the last row.
    pub(super) fn send_limits(&self, stream: &RecordingStream, step: u64, time_s: f64) -> RecordingStreamResult<()> {
        send_torque_limits(stream, &self.joints, &self.torque_limits_nm, step, time_s)
    }

    /// Forgets all rows and keeps their room.
    pub(super) fn clear(&mut self) {
        self.curves.clear();
    }
}
