//! The layout of a planar run: scene from above on the left, curves and texts on the right.

use rerun::RecordingStreamResult;
use rerun::blueprint::components::{BackgroundKind, ContainerKind, VisibleTimeRange, VisualBounds2D};
use rerun::datatypes::{Range1D, Range2D, TimeRange, TimeRangeBoundary};
use rerun::external::re_sdk_types::blueprint::archetypes as blueprint;
use sim::planar::{MapBounds, SceneDescription};

use super::layout::{Layout, Node};
use super::times::{SIM_TIME, STEP};
use super::{scene, style};

/// Margin of the view around the map as a share of the map's width: left and right, above (with action and legend), below,
/// where the arm comes from.
const MARGINS: [f64; 3] = [0.04, 0.20, 0.06];

/// Writes the layout and returns its root.
pub(super) fn write(layout: &mut Layout, scene: &SceneDescription) -> RecordingStreamResult<Node> {
    let plane = plane(layout, "scene from above (x right, y up, m)", &scene.world.map)?;
    let left = layout.container(ContainerKind::Vertical, "scene", &[&plane], &[])?;
    let right = right(layout)?;
    layout.container(ContainerKind::Horizontal, "run", &[&left, &right], &[1.15, 1.0])
}

/// The view of the scene from above.
pub(super) fn plane(layout: &mut Layout, name: &str, map: &MapBounds) -> RecordingStreamResult<Node> {
    let view = layout.view("2D", name, "/", &["+ /plane/**"])?;
    layout.property(&view, "VisualBounds2D", &blueprint::VisualBounds2D::new(bounds(map)))?;
    let background = blueprint::Background::new(BackgroundKind::SolidColor).with_color(style::BACKGROUND);
    layout.property(&view, "Background", &background)?;
    for trail in ["plane/object_path", "plane/tool_path"] {
        show_whole(layout, &view, trail)?;
    }
    Ok(view)
}

/// Lets a trail show all of its stretches up to the time cursor.
pub(super) fn show_whole(layout: &Layout, view: &Node, trail: &str) -> RecordingStreamResult<()> {
    let ranges = blueprint::VisibleTimeRanges::new([STEP, SIM_TIME].map(until_cursor));
    let trail = layout.placed(trail);
    layout.stream.log(format!("{}/ViewContents/overrides{trail}/visualizers", view.path), &ranges)
}

fn right(layout: &mut Layout) -> RecordingStreamResult<Node> {
    let goal = layout.curves("distance from the goal [mm]", &["+ /plots/distance/goal"])?;
    let tracking =
        layout.curves("deviation from the plan [mm]", &["+ /plots/distance/plan", "+ /plots/tracking/**"])?;
    let forces = layout.curves("contact force [N]", &["+ /plots/force/**"])?;
    let torques = layout.curves("joint torques [N m]", &["+ /plots/joint_torque/**"])?;
    let run = layout.container(ContainerKind::Vertical, "run", &[&goal, &tracking, &forces, &torques], &[])?;
    let [motions, torques] = layout.joints()?;
    let states = layout.curves("action and contact", &["+ /plots/state/**"])?;
    let curves = layout.container(ContainerKind::Tabs, "curves", &[&run, &motions, &torques, &states], &[])?;
    let texts = layout.texts()?;
    layout.container(ContainerKind::Vertical, "curves and texts", &[&curves, &texts], &[2.6, 1.0])
}

/// The map with its margins, in the view's reflected coordinates.
fn bounds(map: &MapBounds) -> VisualBounds2D {
    let width = scene::width_m(map);
    let [side, above, below] = MARGINS.map(|share| share * width);
    VisualBounds2D(Range2D {
        x_range: Range1D([map.min_m[0] - side, map.max_m[0] + side]),
        y_range: Range1D([-map.max_m[1] - above, -map.min_m[1] + below]),
    })
}

fn until_cursor(timeline: &str) -> VisibleTimeRange {
    let range = TimeRange { start: TimeRangeBoundary::Infinite, end: TimeRangeBoundary::AT_CURSOR };
    VisibleTimeRange(rerun::datatypes::VisibleTimeRange { timeline: timeline.into(), range })
}
