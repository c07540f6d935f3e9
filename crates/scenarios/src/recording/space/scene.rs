//! What stands still in a spatial scene, and the shapes of arm and tool.

use rerun::{Arrows3D, LineStrips3D, Points3D, RecordingStream, RecordingStreamResult, ViewCoordinates};
use sim::spatial::SceneDescription;

use super::shapes::{self, plain};
use crate::recording::curves::part;
use crate::recording::style::{self, on_screen};

/// Entity of one link of the arm.
pub(super) fn link_path(index: usize, name: &str) -> String {
    if name.is_empty() { format!("/world/arm/link_{index}") } else { format!("/world/arm/{}", part(name)) }
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
        let path = LineStrips3D::new([scene.tool_path_world.iter().map(plain).collect::<Vec<_>>()])
            .with_colors([style::TOOL_PLAN])
            .with_radii([on_screen(0.7)]);
        stream.log_static("/world/tool_plan", &path)?;
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
