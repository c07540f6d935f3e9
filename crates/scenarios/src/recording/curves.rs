//! Curves over time that wait to be handed over: what each is called, and its values row by row.

use rerun::{RecordingStream, RecordingStreamResult, Scalars, SeriesLines, TimeColumn};

use super::style::{self, Rgba};
use super::times::{SIM_TIME, STEP, Times};

const MRAD_PER_RAD: f64 = 1e3;

/// What every arm has a curve of for each joint: entity, quantity, unit.
const JOINT_GROUPS: [(&str, &str, &str); 4] = [
    ("joint_error", "error", "mrad"),
    ("joint_position", "position", "rad"),
    ("joint_velocity", "velocity", "rad/s"),
    ("joint_torque", "torque", "N m"),
];

/// One curve: where it lies, what it is called alone, and in the legend of a plot whose title tells what is drawn.
struct Curve {
    path: String,
    name: String,
    legend: String,
    color: Rgba,
    values: Vec<f64>,
}

/// Curves in a fixed order, with one value each per row.
pub(super) struct Curves {
    curves: Vec<Curve>,
    rows: usize,
}

/// State of the joints in one row, rad, rad/s, N m; entries that are missing leave gaps in the curves.
pub(super) struct JointRow<'a> {
    /// Desired positions.
    pub(super) q_reference_rad: &'a [f64],
    /// Positions.
    pub(super) q_rad: &'a [f64],
    /// Velocities.
    pub(super) dq_rad_per_s: &'a [f64],
    /// Torques of the motors.
    pub(super) torque_nm: &'a [f64],
}

impl Curves {
    /// No curves yet, with room for `rows` rows of those to come.
    pub(super) fn with_capacity(rows: usize) -> Self {
        Self { curves: Vec::new(), rows }
    }

    /// Adds a curve at `/plots/path`.
    pub(super) fn add(&mut self, path: &str, name: &str, color: Rgba) {
        self.add_short(path, name, name, color);
    }

    /// Adds a curve at `/plots/path` with a shorter name in the legend, which otherwise covers the curves.
    pub(super) fn add_short(&mut self, path: &str, name: &str, legend: &str, color: Rgba) {
        let values = Vec::with_capacity(self.rows);
        let (path, name, legend) = (format!("/plots/{path}"), name.to_owned(), legend.to_owned());
        self.curves.push(Curve { path, name, legend, color, values });
    }

    /// Adds the curves that every arm has of its joints.
    pub(super) fn add_joints(&mut self, joints: &[String]) {
        for (group, quantity, unit) in JOINT_GROUPS {
            for (joint, color) in joints.iter().zip(style::JOINTS.iter().cycle()) {
                let (name, legend) = (format!("{joint} {quantity} [{unit}]"), format!("{joint} [{unit}]"));
                self.add_short(&format!("{group}/{}", part(joint)), &name, &legend, *color);
            }
        }
    }

    /// Adds a row: one value per curve, in the order in which the curves were added.
    pub(super) fn push(&mut self, values: impl IntoIterator<Item = f64>) {
        for (curve, value) in self.curves.iter_mut().zip(values) {
            curve.values.push(value);
        }
    }

    /// Path and name of every curve.
    pub(super) fn told(&self) -> impl Iterator<Item = (&str, &str)> {
        self.curves.iter().map(|curve| (curve.path.as_str(), curve.name.as_str()))
    }

    /// Sends names and colors.
    pub(super) fn send_static(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        self.curves.iter().try_for_each(|curve| {
            let line =
                SeriesLines::new().with_names([curve.legend.as_str()]).with_colors([curve.color]).with_widths([1.5]);
            stream.log_static(curve.path.as_str(), &line)
        })
    }

    /// Hands all rows to the stream.
    pub(super) fn send(&self, stream: &RecordingStream, times: &Times) -> RecordingStreamResult<()> {
        self.curves.iter().try_for_each(|curve| {
            let values = Scalars::new(curve.values.iter().copied());
            stream.send_columns(curve.path.as_str(), times.columns(), values.columns_of_unit_batches()?)
        })
    }

    /// Forgets all rows and keeps their room.
    pub(super) fn clear(&mut self) {
        self.curves.iter_mut().for_each(|curve| curve.values.clear());
    }
}

impl JointRow<'_> {
    /// Values of the curves that [`Curves::add_joints`] adds for `joints` joints.
    pub(super) fn values(&self, joints: usize) -> impl Iterator<Item = f64> {
        let padded = |values: &[f64], joint: usize| values.get(joint).copied().unwrap_or(f64::NAN);
        let errors = (0..joints)
            .map(move |joint| (padded(self.q_reference_rad, joint) - padded(self.q_rad, joint)) * MRAD_PER_RAD);
        let groups = [self.q_rad, self.dq_rad_per_s, self.torque_nm];
        let others = groups.into_iter().flat_map(move |values| (0..joints).map(move |joint| padded(values, joint)));
        errors.chain(others)
    }
}

/// Sends torque limits (N m; infinite: none) as level lines from the start to the row at `step` and `time_s`.
pub(super) fn send_torque_limits(
    stream: &RecordingStream,
    joints: &[String],
    limits_nm: &[f64],
    step: u64,
    time_s: f64,
) -> RecordingStreamResult<()> {
    let limits = joints.iter().zip(limits_nm).zip(style::JOINTS.iter().cycle());
    for ((joint, limit), color) in limits.filter(|((_, limit), _)| limit.is_finite()) {
        let path = format!("/plots/joint_torque_limit/{}", part(joint));
        let line = SeriesLines::new()
            // called as the joint's torque is: a legend has one entry for lines of one name, and no room for two more each
            .with_names([format!("{joint} [N m]"), format!("{joint} [N m]")])
            .with_colors([*color, *color])
            .with_widths([0.75, 0.75]);
        stream.log_static(path.as_str(), &line)?;
        let step = i64::try_from(step).unwrap_or(i64::MAX);
        let times = [TimeColumn::new_sequence(STEP, [0, step]), TimeColumn::new_duration_secs(SIM_TIME, [0.0, time_s])];
        let values = Scalars::new([*limit, -limit, *limit, -limit]).columns([2, 2])?;
        stream.send_columns(path.as_str(), times, values)?;
    }
    Ok(())
}

/// A name as one part of an entity path.
pub(super) fn part(name: &str) -> String {
    rerun::EntityPath::from_single_string(name).to_string().trim_start_matches('/').to_owned()
}
