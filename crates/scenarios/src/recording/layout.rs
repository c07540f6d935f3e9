//! The layout with which a recording opens: views, containers and panels of a blueprint.
//!
//! Written into a blueprint store by hand, because the library's builder knows neither the bounds of a plane view, nor the eye
//! of a spatial one, nor the time range of an entity.

use rerun::blueprint::components::{ContainerKind, Corner2D, LinkAxis, PanelState, PlayState, RootContainer};
use rerun::datatypes::Uuid;
use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::external::re_sdk_types::blueprint::archetypes as blueprint;
use rerun::log::LogMsg;
use rerun::{AsComponents, RecordingStream, RecordingStreamBuilder, RecordingStreamResult};

use super::times::SIM_TIME;
use super::{APPLICATION, events, summary};

/// A layout that is being written.
pub(super) struct Layout {
    pub(super) stream: RecordingStream,
    nodes: u8,
    /// Entity below which views look, `/stick` for example; empty for the root.
    below: String,
}

/// A view or a container.
pub(super) struct Node {
    id: Uuid,
    pub(super) path: String,
}

/// Sends the layout that `write` makes, whose root it returns, as the active one and as the default.
pub(super) fn send(
    stream: &RecordingStream,
    write: impl FnOnce(&mut Layout) -> RecordingStreamResult<Node>,
) -> RecordingStreamResult<()> {
    let (layout, storage) = RecordingStreamBuilder::new(APPLICATION).enabled(true).blueprint().memory()?;
    layout.set_time_sequence("blueprint", 0);
    let mut layout = Layout { stream: layout, nodes: 0, below: String::new() };
    let root = write(&mut layout)?;
    layout.finish(&root)?;
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
    /// Lets the views that are added from now on look below an entity; the empty text stands for the root.
    pub(super) fn look_below(&mut self, entity: &str) {
        entity.clone_into(&mut self.below);
    }

    /// The path of an entity that is named as if it were the only run's.
    pub(super) fn placed(&self, path: &str) -> String {
        format!("{}/{}", self.below, path.trim_start_matches('/')).trim_end_matches('/').to_owned()
    }

    fn finish(&self, root: &Node) -> RecordingStreamResult<()> {
        let viewport = blueprint::ViewportBlueprint::new()
            .with_root_container(RootContainer(root.id))
            .with_auto_layout(false)
            .with_auto_views(false);
        self.stream.log("viewport", &viewport)?;
        self.panels()
    }

    /// Pages of what every arm has of its joints: how they moved, and their torques. An arm has up to seven lines in a plot,
    /// whose legend needs a third of a page.
    pub(super) fn joints(&mut self) -> RecordingStreamResult<[Node; 2]> {
        let errors = self.curves("joint tracking errors [mrad]", &["+ /plots/joint_error/**"])?;
        let positions = self.curves("joint positions [rad]", &["+ /plots/joint_position/**"])?;
        let velocities = self.curves("joint velocities [rad/s]", &["+ /plots/joint_velocity/**"])?;
        let torques = self.curves("joint torques [N m]", &["+ /plots/joint_torque/**"])?;
        let limited = &["+ /plots/joint_torque/**", "+ /plots/joint_torque_limit/**"];
        let limits = self.curves("the same with the limits as thin lines [N m]", limited)?;
        let motions =
            self.container(ContainerKind::Vertical, "joint motions", &[&errors, &positions, &velocities], &[])?;
        Ok([motions, self.container(ContainerKind::Vertical, "joint torques", &[&torques, &limits], &[])?])
    }

    /// Outcome, events and task, one behind the other.
    pub(super) fn texts(&mut self) -> RecordingStreamResult<Node> {
        let outcome = self.view("TextDocument", "outcome", summary::OUTCOME, &["$origin"])?;
        let log = self.view("TextLog", "events", events::PATH, &["$origin"])?;
        let task = self.view("TextDocument", "task", summary::TASK, &["$origin"])?;
        self.container(ContainerKind::Tabs, "texts", &[&outcome, &log, &task], &[])
    }

    /// Curves of one run.
    pub(super) fn curves(&mut self, name: &str, contents: &[&str]) -> RecordingStreamResult<Node> {
        self.series("/plots", name, contents)
    }

    /// Curves of several runs.
    pub(super) fn shared_curves(&mut self, name: &str, contents: &[&str]) -> RecordingStreamResult<Node> {
        self.series("/", name, contents)
    }

    fn series(&mut self, origin: &str, name: &str, contents: &[&str]) -> RecordingStreamResult<Node> {
        let view = self.view("TimeSeries", name, origin, contents)?;
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

    pub(super) fn view(
        &mut self,
        class: &str,
        name: &str,
        origin: &str,
        contents: &[&str],
    ) -> RecordingStreamResult<Node> {
        let node = self.node("view");
        let origin = if self.below.is_empty() { origin.to_owned() } else { self.placed(origin) };
        let view = blueprint::ViewBlueprint::new(class).with_display_name(name).with_space_origin(origin);
        self.stream.log(node.path.as_str(), &view)?;
        let below = |rule: &&str| rule.replacen("+ /", &format!("+ {}/", self.below), 1);
        self.property(&node, "ViewContents", &blueprint::ViewContents::new(contents.iter().map(below)))?;
        Ok(node)
    }

    pub(super) fn container(
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

    pub(super) fn property(&self, view: &Node, name: &str, property: &dyn AsComponents) -> RecordingStreamResult<()> {
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
