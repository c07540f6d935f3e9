//! The layout with which a recording opens: scene on the left, curves and texts on the right.
//!
//! Written into a blueprint store by hand, because the library's builder knows neither the bounds of a plane view nor the
//! time range of an entity.

use rerun::blueprint::components::{
    BackgroundKind, ContainerKind, Corner2D, LinkAxis, PanelState, PlayState, RootContainer, VisibleTimeRange,
    VisualBounds2D,
};
use rerun::datatypes::{Range1D, Range2D, TimeRange, TimeRangeBoundary, Uuid};
use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::external::re_sdk_types::blueprint::archetypes as blueprint;
use rerun::log::LogMsg;
use rerun::{AsComponents, RecordingStream, RecordingStreamBuilder, RecordingStreamResult};
use sim::planar::{MapBounds, SceneDescription};

use super::times::{SIM_TIME, STEP};
use super::{APPLICATION, events, scene, style, summary};

/// Margin of the view around the map as a share of the map's width: left and right, above, below (with the legend).
const MARGINS: [f64; 3] = [0.04, 0.08, 0.14];

/// A layout that is being written.
struct Layout {
    stream: RecordingStream,
    nodes: u8,
}

/// A view or a container.
struct Node {
    id: Uuid,
    path: String,
}

/// Sends the layout as the active one and as the default.
pub(super) fn send(stream: &RecordingStream, scene: &SceneDescription) -> RecordingStreamResult<()> {
    let (layout, storage) = RecordingStreamBuilder::new(APPLICATION).enabled(true).blueprint().memory()?;
    layout.set_time_sequence("blueprint", 0);
    Layout { stream: layout, nodes: 0 }.write(scene)?;
    let messages = storage.take();
    if let Some(blueprint_id) = messages.first().map(|message: &LogMsg| message.store_id().clone()) {
        stream.send_blueprint(
            messages,
            BlueprintActivationCommand { blueprint_id, make_active: true, make_default: true },
        );
    }
    Ok(())
}

impl Layout {
    fn write(mut self, scene: &SceneDescription) -> RecordingStreamResult<()> {
        let plane = self.plane(&scene.world.map)?;
        let left = self.container(ContainerKind::Vertical, "scene", &[&plane], &[])?;
        let right = self.right()?;
        let root = self.container(ContainerKind::Horizontal, "run", &[&left, &right], &[1.15, 1.0])?;
        let viewport = blueprint::ViewportBlueprint::new()
            .with_root_container(RootContainer(root.id))
            .with_auto_layout(false)
            .with_auto_views(false);
        self.stream.log("viewport", &viewport)?;
        self.panels()
    }

    fn plane(&mut self, map: &MapBounds) -> RecordingStreamResult<Node> {
        let view = self.view("2D", "scene from above (x right, y up, m)", "/", &["+ /plane/**"])?;
        self.property(&view, "VisualBounds2D", &blueprint::VisualBounds2D::new(bounds(map)))?;
        let background = blueprint::Background::new(BackgroundKind::SolidColor).with_color(style::BACKGROUND);
        self.property(&view, "Background", &background)?;
        for trail in ["plane/object_path", "plane/tool_path"] {
            // a trail shows all of its stretches up to the time cursor
            let ranges = blueprint::VisibleTimeRanges::new([STEP, SIM_TIME].map(until_cursor));
            self.stream.log(format!("{}/ViewContents/overrides/{trail}/visualizers", view.path), &ranges)?;
        }
        Ok(view)
    }

    fn right(&mut self) -> RecordingStreamResult<Node> {
        let goal = self.curves("distance from the goal [mm]", &["+ /plots/distance/goal"])?;
        let tracking =
            self.curves("deviation from the plan [mm]", &["+ /plots/distance/plan", "+ /plots/tracking/**"])?;
        let forces = self.curves("contact force [N]", &["+ /plots/force/**"])?;
        let torques = self.curves("joint torques [N m]", &["+ /plots/joint_torque/**"])?;
        let run = self.container(ContainerKind::Vertical, "run", &[&goal, &tracking, &forces, &torques], &[])?;
        let errors = self.curves("joint tracking errors [mrad]", &["+ /plots/joint_error/**"])?;
        let positions = self.curves("joint positions [rad]", &["+ /plots/joint_position/**"])?;
        let velocities = self.curves("joint velocities [rad/s]", &["+ /plots/joint_velocity/**"])?;
        let limits = self.curves(
            "joint torques and limits [N m]",
            &["+ /plots/joint_torque/**", "+ /plots/joint_torque_limit/**"],
        )?;
        let joints =
            self.container(ContainerKind::Vertical, "joints", &[&errors, &positions, &velocities, &limits], &[])?;
        let states = self.curves("action and contact", &["+ /plots/state/**"])?;
        let curves = self.container(ContainerKind::Tabs, "curves", &[&run, &joints, &states], &[])?;
        let outcome = self.view("TextDocument", "outcome", summary::OUTCOME, &["$origin"])?;
        let log = self.view("TextLog", "events", events::PATH, &["$origin"])?;
        let task = self.view("TextDocument", "task", summary::TASK, &["$origin"])?;
        let texts = self.container(ContainerKind::Tabs, "texts", &[&outcome, &log, &task], &[])?;
        self.container(ContainerKind::Vertical, "curves and texts", &[&curves, &texts], &[2.6, 1.0])
    }

    fn curves(&mut self, name: &str, contents: &[&str]) -> RecordingStreamResult<Node> {
        let view = self.view("TimeSeries", name, "/plots", contents)?;
        self.property(&view, "TimeAxis", &blueprint::TimeAxis::new().with_link(LinkAxis::LinkToGlobal))?;
        self.property(&view, "PlotLegend", &blueprint::PlotLegend::new().with_corner(Corner2D::RightTop))?;
        Ok(view)
    }

    fn panels(&self) -> RecordingStreamResult<()> {
        let collapsed = blueprint::PanelBlueprint::new().with_state(PanelState::Collapsed);
        self.stream.log("blueprint_panel", &collapsed)?;
        self.stream.log("selection_panel", &collapsed)?;
        // a file opens at its end with the whole way drawn, a live run shows the newest rows
        let time = blueprint::TimePanelBlueprint::new()
            .with_state(PanelState::Collapsed)
            .with_timeline(SIM_TIME)
            .with_play_state(PlayState::Following);
        self.stream.log("time_panel", &time)
    }

    fn view(&mut self, class: &str, name: &str, origin: &str, contents: &[&str]) -> RecordingStreamResult<Node> {
        let node = self.node("view");
        let view = blueprint::ViewBlueprint::new(class).with_display_name(name).with_space_origin(origin);
        self.stream.log(node.path.as_str(), &view)?;
        self.property(&node, "ViewContents", &blueprint::ViewContents::new(contents.iter().copied()))?;
        Ok(node)
    }

    fn container(
        &mut self,
        kind: ContainerKind,
        name: &str,
        nodes: &[&Node],
        shares: &[f32],
    ) -> RecordingStreamResult<Node> {
        let node = self.node("container");
        let mut container = blueprint::ContainerBlueprint::new(kind)
            .with_display_name(name)
            .with_contents(nodes.iter().map(|child| child.path.as_str()));
        if kind == ContainerKind::Horizontal {
            container = container.with_col_shares(shares.iter().copied());
        }
        if kind == ContainerKind::Vertical && !shares.is_empty() {
            container = container.with_row_shares(shares.iter().copied());
        }
        if let (ContainerKind::Tabs, Some(first)) = (kind, nodes.first()) {
            container = container.with_active_tab(first.path.as_str());
        }
        self.stream.log(node.path.as_str(), &container)?;
        Ok(node)
    }

    fn property(&self, view: &Node, name: &str, property: &dyn AsComponents) -> RecordingStreamResult<()> {
        self.stream.log(format!("{}/{name}", view.path), property)
    }

    /// Views and containers are numbered: their identity has to be unique within a layout only.
    fn node(&mut self, kind: &str) -> Node {
        self.nodes += 1;
        let mut bytes = [0; 16];
        bytes[15] = self.nodes;
        Node { id: Uuid { bytes }, path: format!("{kind}/00000000-0000-0000-0000-{:012x}", self.nodes) }
    }
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
