//! Columns of a run in space.

use nalgebra::Isometry3;
use sim::spatial::{Sample, SceneDescription};

use super::table::{Column, fill_joints, joint_columns};

/// Coordinates of a pose: place, then the quaternion of its orientation.
const COORDINATES: [(&str, &str, &str); 7] = [
    ("x_m", "m", "x in the world"),
    ("y_m", "m", "y in the world"),
    ("z_m", "m", "z in the world"),
    ("qw", "", "orientation in the world, real part of the quaternion"),
    ("qx", "", "orientation in the world, i"),
    ("qy", "", "orientation in the world, j"),
    ("qz", "", "orientation in the world, k"),
];

pub(super) fn columns(scene: &SceneDescription) -> Vec<Column> {
    let mut columns = vec![Column::new("time_s", "s", "simulated time")];
    columns.extend(joint_columns(&scene.arm.joints));
    for (name, label) in [("tool", "the tool"), ("tool_reference", "where the tool should be")] {
        let of = |(end, unit, what)| Column::new(format!("{name}_{end}"), unit, format!("{label}: {what}"));
        columns.extend(COORDINATES.map(of));
    }
    for axis in ["x", "y", "z"] {
        let label = format!("force of the surroundings on the tool, as the arm's motion tells: {axis} in the world");
        columns.push(Column::new(format!("tool_force_{axis}_n"), "N", label));
    }
    for axis in ["x", "y", "z"] {
        let label = format!("moment of the surroundings about the tool's origin: {axis} in the world");
        columns.push(Column::new(format!("tool_moment_{axis}_nm"), "N m", label));
    }
    // the task's curves bear their units in their names
    columns.extend(scene.series.iter().map(|series| {
        let label = format!("{}: {}", series.plot, series.name);
        Column::new(identifier(&format!("{} {}", series.plot, series.name)), "", label)
    }));
    columns
}

pub(super) fn fill(row: &mut Vec<f64>, sample: &Sample<'_>) {
    row.push(sample.time_s);
    fill_joints(row, [sample.q_rad, sample.dq_rad_per_s, sample.q_reference_rad, sample.torque_nm]);
    row.extend(coordinates(&sample.world_from_tool));
    row.extend(coordinates(&sample.world_from_tool_reference));
    row.extend(sample.tool_wrench.iter());
    row.extend_from_slice(sample.series);
}

fn coordinates(pose: &Isometry3<f64>) -> [f64; 7] {
    let (at, turn) = (pose.translation.vector, pose.rotation.quaternion());
    [at.x, at.y, at.z, turn.w, turn.i, turn.j, turn.k]
}

/// A name of small letters, digits and underscores.
fn identifier(text: &str) -> String {
    let spaced: String =
        text.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { ' ' }).collect();
    spaced.split_whitespace().collect::<Vec<_>>().join("_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_named_by_its_plot_and_itself() {
        assert_eq!(identifier("flow [g/s] out of the cup"), "flow_g_s_out_of_the_cup");
        assert_eq!(identifier("lip [mm] to the mouth"), "lip_mm_to_the_mouth");
    }
}
