//! The layout of a spatial run: the scene on the left, curves and texts on the right.

use nalgebra::{Point3, Vector3};
use rerun::RecordingStreamResult;
use rerun::blueprint::components::{BackgroundKind, ContainerKind, Eye3DKind};
use rerun::external::re_sdk_types::blueprint::archetypes as blueprint;
use sim::spatial::SceneDescription;

use super::plots::task_plot;
use super::shapes::{plain, plain_vector};
use crate::recording::layout::{Layout, Node};
use crate::recording::{plane_layout, style};

/// Where the eye stands, seen from the middle of the scene: to the front, to the side, above.
const EYE_DIRECTION: [f64; 3] = [1.0, -0.9, 0.55];
/// Distance of the eye over the radius of what is worth seeing.
const EYE_DISTANCE: f64 = 2.0;

/// Writes the layout and returns its root.
pub(super) fn write(layout: &mut Layout, scene: &SceneDescription) -> RecordingStreamResult<Node> {
    let space = space(layout, "scene", &scene.focus_world)?;
    let left = layout.container(ContainerKind::Vertical, "scene", &[&space], &[])?;
    let right = right(layout, scene)?;
    layout.container(ContainerKind::Horizontal, "run", &[&left, &right], &[1.3, 1.0])
}

/// The view of the scene; `focus_world` are middle and radius of what is worth seeing, m.
pub(in crate::recording) fn space(
    layout: &mut Layout,
    name: &str,
    focus_world: &(Point3<f64>, f64),
) -> RecordingStreamResult<Node> {
    let view = layout.view("3D", name, "/world", &["+ /world/**"])?;
    let background = blueprint::Background::new(BackgroundKind::SolidColor).with_color(style::BACKGROUND);
    layout.property(&view, "Background", &background)?;
    let (center, radius_m) = focus_world;
    let eye = center + Vector3::from(EYE_DIRECTION).normalize() * (EYE_DISTANCE * radius_m);
    let controls = blueprint::EyeControls3D::new()
        .with_kind(Eye3DKind::Orbital)
        .with_position(plain(&eye))
        .with_look_target(plain(center))
        .with_eye_up(plain_vector(&Vector3::z()));
    layout.property(&view, "EyeControls3D", &controls)?;
    plane_layout::show_whole(layout, &view, "world/tool_path")?;
    Ok(view)
}

fn right(layout: &mut Layout, scene: &SceneDescription) -> RecordingStreamResult<Node> {
    let mut plots: Vec<Node> = Vec::new();
    let mut titles: Vec<&str> = Vec::new();
    for series in &scene.series {
        if !titles.contains(&series.plot.as_str()) {
            titles.push(&series.plot);
            plots.push(layout.curves(&series.plot, &[&format!("+ /plots/{}/**", task_plot(&series.plot))])?);
        }
    }
    plots.push(layout.curves("force on the tool [N]", &["+ /plots/force/**"])?);
    plots.push(layout.curves("tool to its reference [mm, mrad]", &["+ /plots/tracking/**"])?);
    plots.push(layout.curves("joint torques [N m]", &["+ /plots/joint_torque/**"])?);
    let run = layout.container(ContainerKind::Vertical, "run", &plots.iter().collect::<Vec<_>>(), &[])?;
    let joints = layout.joints()?;
    let states = layout.curves("action", &["+ /plots/state/**"])?;
    let curves = layout.container(ContainerKind::Tabs, "curves", &[&run, &joints, &states], &[])?;
    let texts = layout.texts()?;
    layout.container(ContainerKind::Vertical, "curves and texts", &[&curves, &texts], &[2.6, 1.0])
}
