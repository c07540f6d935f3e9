//! Colors, widths and drawing order: one color means one thing in the scene, in its legend and in the plots.

use rerun::Radius;

/// A color as red, green, blue, opacity.
pub(super) type Rgba = [u8; 4];

/// Behind the scene, whatever theme the viewer has.
pub(super) const BACKGROUND: Rgba = [24, 26, 31, 255];
/// The object and its way.
pub(super) const OBJECT: Rgba = [255, 152, 48, 255];
/// Inside of the object.
pub(super) const OBJECT_FILL: Rgba = [150, 84, 24, 255];
/// Where the plan expects the object.
pub(super) const OBJECT_PLAN: Rgba = [206, 160, 112, 255];
/// The tool and its way.
pub(super) const TOOL: Rgba = [88, 160, 255, 255];
/// Inside of the tool.
pub(super) const TOOL_FILL: Rgba = [36, 72, 128, 255];
/// Where the plan wants the tool.
pub(super) const TOOL_PLAN: Rgba = [128, 156, 200, 255];
/// Where the plan wants the tool, in space, where the way that was taken lies upon it.
pub(super) const REFERENCE: Rgba = [250, 220, 100, 255];
/// Axes x, y, z of a frame.
pub(super) const AXES: [Rgba; 3] = [[235, 80, 80, 255], [96, 208, 120, 255], [88, 130, 255, 255]];
/// Obstacles.
pub(super) const OBSTACLE: Rgba = [158, 162, 170, 255];
/// Inside of obstacles.
pub(super) const OBSTACLE_FILL: Rgba = [78, 82, 90, 255];
/// The arm.
pub(super) const ARM: Rgba = [112, 120, 134, 255];
/// The goal.
pub(super) const GOAL: Rgba = [96, 208, 120, 255];
/// Contact forces.
pub(super) const FORCE: Rgba = [255, 84, 120, 255];
/// What the camera sees.
pub(super) const SEEN: Rgba = [250, 240, 120, 255];
/// Bounds of the map and plain text.
pub(super) const MAP: Rgba = [120, 124, 132, 255];
/// Lines of plots that belong to one joint each.
pub(super) const JOINTS: [Rgba; 7] = [
    [88, 160, 255, 255],
    [255, 152, 48, 255],
    [96, 208, 120, 255],
    [220, 120, 220, 255],
    [250, 220, 100, 255],
    [100, 210, 210, 255],
    [200, 140, 110, 255],
];

/// Height in the drawing: what is larger covers what is smaller.
pub(super) mod order {
    /// Bounds of the map.
    pub(in super::super) const MAP: f32 = 1.0;
    /// Obstacles.
    pub(in super::super) const OBSTACLE: f32 = 2.0;
    /// Goal.
    pub(in super::super) const GOAL: f32 = 4.0;
    /// The arm's links.
    pub(in super::super) const ARM: f32 = 6.0;
    /// Planned paths.
    pub(in super::super) const PLAN: f32 = 7.0;
    /// Ways that were taken, below the bodies that took them.
    pub(in super::super) const TRAIL: f32 = 8.0;
    /// Object.
    pub(in super::super) const OBJECT: f32 = 10.0;
    /// Tool.
    pub(in super::super) const TOOL: f32 = 12.0;
    /// Contacts and what the camera sees.
    pub(in super::super) const MARK: f32 = 20.0;
    /// Text.
    pub(in super::super) const TEXT: f32 = 30.0;
    /// Added to an order, puts an outline above its own inside.
    pub(in super::super) const ABOVE: f32 = 0.5;
}

/// A line of constant width on the screen.
pub(super) fn on_screen(half_width: f32) -> Radius {
    Radius::new_ui_points(half_width)
}
