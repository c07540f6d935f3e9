//! Curves of a planar run: distances, tracking errors, forces, joints. A curve is one line of the list below and one value.

use nalgebra::{Isometry2, Point2};
use rerun::{RecordingStream, RecordingStreamResult};
use sim::planar::SceneDescription;

use super::curves::{Curves, JointRow, send_torque_limits};
use super::row::Row;
use super::style;
use super::times::Times;

const MM_PER_M: f64 = 1e3;

/// All curves of a run.
pub(super) struct Plots {
    curves: Curves,
    goal: Point2<f64>,
    joints: Vec<String>,
    torque_limits_nm: Vec<f64>,
}

impl Plots {
    /// Room for `rows` rows of `scene`.
    pub(super) fn new(scene: &SceneDescription, rows: usize) -> Self {
        let mut curves = Curves::with_capacity(rows);
        for (path, name, color) in [
            ("distance/goal", "object to goal [mm]", style::GOAL),
            ("distance/plan", "object to its plan [mm]", style::OBJECT),
            ("tracking/tool", "tool to its reference [mm]", style::TOOL),
            ("tracking/belief", "controller's belief to object [mm]", style::SEEN),
            ("force/push", "tool on object, peak [N]", style::FORCE),
            ("force/obstacles", "obstacles, peak [N]", style::OBSTACLE),
            ("state/contact", "tool touches object [0/1]", style::FORCE),
            ("state/action", "action [number]", style::TOOL),
        ] {
            curves.add(path, name, color);
        }
        curves.add_joints(&scene.arm.joints);
        Self {
            curves,
            goal: scene.goal_world,
            joints: scene.arm.joints.clone(),
            torque_limits_nm: scene.arm.torque_limits_nm.clone(),
        }
    }

    /// Adds a row, in the order of the list above.
    pub(super) fn push(&mut self, row: &Row) {
        let center = Point2::from(row.world_from_object.translation.vector);
        let single = [
            (center - self.goal).norm() * MM_PER_M,
            distance_m(&row.world_from_object, &row.world_from_object_expected) * MM_PER_M,
            distance_m(&row.world_from_tool, &row.world_from_tool_reference) * MM_PER_M,
            row.object_believed_world.map_or(f64::NAN, |belief| (belief - center).norm() * MM_PER_M),
            row.push_peak_n,
            row.obstacle_peak_n,
            f64::from(u8::from(row.push_peak_n > 0.0)),
            row.phase as f64 + 1.0,
        ];
        let joints = JointRow {
            q_reference_rad: &row.q_reference_rad,
            q_rad: &row.q_rad,
            dq_rad_per_s: &row.dq_rad_per_s,
            torque_nm: &row.torque_nm,
        };
        self.curves.push(single.into_iter().chain(joints.values(self.joints.len())));
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
    pub(super) fn send_limits(&self, stream: &RecordingStream, last: &Row) -> RecordingStreamResult<()> {
        send_torque_limits(stream, &self.joints, &self.torque_limits_nm, last.step, last.time_s)
    }

    /// Forgets all rows and keeps their room.
    pub(super) fn clear(&mut self) {
        self.curves.clear();
    }
}

fn distance_m(first: &Isometry2<f64>, second: &Isometry2<f64>) -> f64 {
    (first.translation.vector - second.translation.vector).norm()
}
