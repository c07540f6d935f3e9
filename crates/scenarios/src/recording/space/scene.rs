//! What stands still in a spatial scene, and the shapes of arm and tool.

use nalgebra::Vector3;
use rerun::{Arrows3D, LineStrips3D, Points3D, RecordingStream, RecordingStreamResult, Transform3D, ViewCoordinates};
use sim::spatial::{SceneDescription, Target};

use super::shapes::{self, plain_vector, quaternion};
use crate::recording::curves::part;
use crate::recording::shapes::dashed;
use crate::recording::style::{self, on_screen};

/// Length of a dash, and of the axes of a target, over the radius of what is worth seeing.
const DASH_SHARE: f64 = 0.02;
const TARGET_SHARE: f64 = 0.08;

/// Entity of one link of the arm.
pub(super) fn link_path(index: usize, name: &str) -> String {
    if name.is_empty() { format!("/world/arm/link_{index}") } else { format!("/world/arm/{}", part(name)) }
}

/// Sends the axes of a target's frame, x red, y green, z blue, with its name.
fn send_target(stream: &RecordingStream, target: &Target, length_m: f64) -> RecordingStreamResult<()> {
    let path = format!("/world/targets/{}", part(&target.name));
    let pose = &target.world_from_target;
    let place = Transform3D::from_translation_rotation(plain_vector(&pose.translation.vector), quaternion(pose));
    stream.log_static(path.as_str(), &place)?;
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| plain_vector(&(axis * length_m)));
    let arrows = Arrows3D::from_vectors(axes).with_colors(style::AXES).with_radii([on_screen(1.6)]);
    stream.log_static(format!("{path}/axes"), &arrows)?;
    let name = Points3D::new([[0.0_f32; 3]])
        .with_labels([target.name.as_str()])
        .with_show_labels(true)
        .with_colors([style::GOAL])
        .with_radii([on_screen(4.0)]);
    stream.log_static(format!("{path}/name"), &name)
}

/// Sends everything that has no time.
pub(super) fn send(stream: &RecordingStream, scene: &SceneDescription) -> RecordingStreamResult<()> {
    stream.log_static("/world", &ViewCoordinates::RIGHT_HAND_Z_UP())?;
    shapes::send_static(stream, "/world/fixed", &scene.fixed)?;
    for (index, link) in scene.arm.links.iter().enumerate() {
        shapes::send_static(stream, &link_path(index, &link.name), &link.drawings)?;
    }
    shapes::send_static(stream, "/world/tool", &scene.arm.tool)?;
    if scene.tool_path_world.len() > 1 {
        // wider than the way that was taken and in dashes: it shows beneath it where both agree
        let dashes = dashed(&scene.tool_path_world, DASH_SHARE * scene.focus_world.1);
        let path = LineStrips3D::new(dashes).with_colors([style::REFERENCE]).with_radii([on_screen(2.2)]);
        stream.log_static("/world/tool_plan", &path)?;
    }
    for target in &scene.targets_world {
        send_target(stream, target, TARGET_SHARE * scene.focus_world.1)?;
    }
    let trail = LineStrips3D::update_fields().with_colors([style::TOOL]).with_radii([on_screen(1.4)]);
    stream.log_static("/world/tool_path", &trail)?;
    let force = Arrows3D::update_fields().with_colors([style::FORCE]).with_radii([on_screen(3.0)]);
    stream.log_static("/world/force", &force)?;
    if let Some(grains) = &scene.grains {
        let radii = grains.half_sizes_m.iter().map(|[x, y, z]| {
            // the radius of the ball of equal volume
            rerun::Radius::new_scene_units((x * y * z).cbrt() as f32)
        });
        let look = Points3D::update_fields().with_radii(radii).with_colors([shapes::bytes(grains.color)]);
        stream.log_static("/world/grains", &look)?;
    }
    Ok(())
}
