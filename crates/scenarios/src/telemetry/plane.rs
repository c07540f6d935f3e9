//! Columns of a run in the plane.

use nalgebra::Isometry2;
use sim::planar::{Party, Sample, SceneDescription};

use super::table::{Column, fill_joints, joint_columns};

/// Things whose place and heading are in the table.
const POSES: [(&str, &str); 5] = [
    ("tool", "the tool"),
    ("tool_reference", "where the tool should be"),
    ("object", "the object"),
    ("object_expected", "where the plan expects the object"),
    ("object_seen", "what the camera showed last"),
];

pub(super) fn columns(scene: &SceneDescription) -> Vec<Column> {
    let mut columns = vec![Column::new("time_s", "s", "simulated time")];
    columns.extend(joint_columns(&scene.arm.joints));
    for (name, label) in POSES {
        columns.push(Column::new(format!("{name}_x_m"), "m", format!("{label}: x in the world")));
        columns.push(Column::new(format!("{name}_y_m"), "m", format!("{label}: y in the world")));
        columns.push(Column::new(format!("{name}_angle_rad"), "rad", format!("{label}: heading in the world")));
    }
    columns.push(Column::new("object_believed_x_m", "m", "where the controller believes the object: x in the world"));
    columns.push(Column::new("object_believed_y_m", "m", "where the controller believes the object: y in the world"));
    columns.push(Column::new("object_contact_force_x_n", "N", "contact forces on the object, sum: x in the world"));
    columns.push(Column::new("object_contact_force_y_n", "N", "contact forces on the object, sum: y in the world"));
    columns
}

pub(super) fn fill(row: &mut Vec<f64>, sample: &Sample<'_>) {
    row.push(sample.time_s);
    fill_joints(row, [sample.q_rad, sample.dq_rad_per_s, sample.q_reference_rad, sample.torque_nm]);
    let poses = [
        Some(sample.world_from_tool),
        Some(sample.world_from_tool_reference),
        Some(sample.world_from_object),
        Some(sample.world_from_object_expected),
        sample.world_from_object_seen,
    ];
    poses.iter().for_each(|pose| row.extend(coordinates(pose.as_ref())));
    row.extend(sample.object_believed_world.map_or([f64::NAN; 2], |point| [point.x, point.y]));
    let mut force = [0.0; 2];
    for contact in sample.contacts {
        let [first, second] = contact.parties;
        // a force is that of the first party on the second
        let sign = f64::from(second == Party::Object) - f64::from(first == Party::Object);
        force[0] += sign * contact.force_world_n.x;
        force[1] += sign * contact.force_world_n.y;
    }
    row.extend(force);
}

fn coordinates(pose: Option<&Isometry2<f64>>) -> [f64; 3] {
    pose.map_or([f64::NAN; 3], |pose| [pose.translation.x, pose.translation.y, pose.rotation.angle()])
}
