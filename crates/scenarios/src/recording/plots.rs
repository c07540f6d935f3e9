//! Curves over time: distances, tracking errors, forces, joints. A curve is one line of the list below and one value.

use nalgebra::{Isometry2, Point2};
use rerun::{RecordingStream, RecordingStreamResult, Scalars, SeriesLines, TimeColumn};
use sim::planar::SceneDescription;

use super::row::Row;
use super::style::{self, Rgba};
use super::times::{SIM_TIME, STEP, Times};

const MM_PER_M: f64 = 1e3;
const MRAD_PER_RAD: f64 = 1e3;

/// One curve: where it lies, how its legend reads.
struct Series {
    path: String,
    name: String,
    color: Rgba,
    values: Vec<f64>,
}

/// All curves of a run.
pub(super) struct Plots {
    series: Vec<Series>,
    joints: usize,
    goal: Point2<f64>,
    torque_limits_nm: Vec<f64>,
    joint_names: Vec<String>,
}

impl Plots {
    /// Room for `rows` rows of `scene`.
    pub(super) fn new(scene: &SceneDescription, rows: usize) -> Self {
        let arm = &scene.arm;
        let single = [
            ("distance/goal", "object to goal [mm]", style::GOAL),
            ("distance/plan", "object to its plan [mm]", style::OBJECT),
            ("tracking/tool", "tool to its reference [mm]", style::TOOL),
            ("tracking/belief", "controller's belief to object [mm]", style::SEEN),
            ("force/push", "tool on object, peak [N]", style::FORCE),
            ("force/obstacles", "obstacles, peak [N]", style::OBSTACLE),
            ("state/contact", "tool touches object [0/1]", style::FORCE),
            ("state/action", "action [number]", style::TOOL),
        ];
        let mut series: Vec<_> =
            single.iter().map(|(path, name, color)| Series::new(path, (*name).into(), *color, rows)).collect();
        for (group, quantity) in [
            ("joint_error", "error [mrad]"),
            ("joint_position", "position [rad]"),
            ("joint_velocity", "velocity [rad/s]"),
            ("joint_torque", "torque [N m]"),
        ] {
            series.extend(arm.joints.iter().zip(style::JOINTS.iter().cycle()).map(|(joint, color)| {
                Series::new(&format!("{group}/{}", part(joint)), format!("{joint} {quantity}"), *color, rows)
            }));
        }
        Self {
            series,
            joints: arm.joints.len(),
            goal: scene.goal_world,
            torque_limits_nm: arm.torque_limits_nm.clone(),
            joint_names: arm.joints.clone(),
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
        let joints = self.joints;
        let padded = |values: &[f64], joint: usize| values.get(joint).copied().unwrap_or(f64::NAN);
        let errors =
            (0..joints).map(|joint| (padded(&row.q_reference_rad, joint) - padded(&row.q_rad, joint)) * MRAD_PER_RAD);
        let groups = [&row.q_rad, &row.dq_rad_per_s, &row.torque_nm];
        let others = groups.iter().flat_map(|values| (0..joints).map(|joint| padded(values, joint)));
        for (series, value) in self.series.iter_mut().zip(single.into_iter().chain(errors).chain(others)) {
            series.values.push(value);
        }
    }

    /// Sends names and colors.
    pub(super) fn send_static(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        for series in &self.series {
            let line =
                SeriesLines::new().with_names([series.name.as_str()]).with_colors([series.color]).with_widths([1.5]);
            stream.log_static(series.path.as_str(), &line)?;
        }
        Ok(())
    }

    /// Hands all rows to the stream.
    pub(super) fn send(&self, stream: &RecordingStream, times: &Times) -> RecordingStreamResult<()> {
        for series in &self.series {
            let values = Scalars::new(series.values.iter().copied());
            stream.send_columns(series.path.as_str(), times.columns(), values.columns_of_unit_batches()?)?;
        }
        Ok(())
    }

    /// Sends the torque limits as level lines from the start to the last row.
    pub(super) fn send_limits(&self, stream: &RecordingStream, last: &Row) -> RecordingStreamResult<()> {
        let limits = self.joint_names.iter().zip(&self.torque_limits_nm).zip(style::JOINTS.iter().cycle());
        for ((joint, limit), color) in limits.filter(|((_, limit), _)| limit.is_finite()) {
            let path = format!("/plots/joint_torque_limit/{}", part(joint));
            let line = SeriesLines::new()
                .with_names([format!("{joint} limit [N m]"), format!("{joint} limit, negative [N m]")])
                .with_colors([*color, *color])
                .with_widths([0.75, 0.75]);
            stream.log_static(path.as_str(), &line)?;
            let step = i64::try_from(last.step).unwrap_or(i64::MAX);
            let times = [
                TimeColumn::new_sequence(STEP, [0, step]),
                TimeColumn::new_duration_secs(SIM_TIME, [0.0, last.time_s]),
            ];
            let values = Scalars::new([*limit, -limit, *limit, -limit]).columns([2, 2])?;
            stream.send_columns(path.as_str(), times, values)?;
        }
        Ok(())
    }

    /// Forgets all rows and keeps their room.
    pub(super) fn clear(&mut self) {
        self.series.iter_mut().for_each(|series| series.values.clear());
    }
}

impl Series {
    fn new(path: &str, name: String, color: Rgba, rows: usize) -> Self {
        Self { path: format!("/plots/{path}"), name, color, values: Vec::with_capacity(rows) }
    }
}

/// A name as one part of an entity path.
pub(super) fn part(name: &str) -> String {
    rerun::EntityPath::from_single_string(name).to_string().trim_start_matches('/').to_owned()
}

fn distance_m(first: &Isometry2<f64>, second: &Isometry2<f64>) -> f64 {
    (first.translation.vector - second.translation.vector).norm()
}
