//! The scene that stands still, and the shapes of what moves.
//!
//! Rerun's plane views have y pointing down. The root `/plane` therefore carries one fixed reflection (scale 1, −1, 1) and
//! the view looks from above that root: everything below is logged as it is, x to the right and y up, in meters, and the
//! picture shows +y up. Only the view's own bounds are given in reflected coordinates (see the module `layout`).

use nalgebra::Point2;
use rerun::{LineStrips2D, Points2D, RecordingStream, RecordingStreamResult, Transform3D};
use sim::planar::{MapBounds, SceneDescription};
use skills::outline::PlacedOutline;

use super::curves::part;
use super::shapes::{self, Strip, plain};
use super::style::{self, Rgba, on_screen, order};

/// Half size of the goal's cross, as a share of the map's width.
const GOAL_CROSS: f64 = 0.02;

/// Height of the legend's upper line above the map, as a share of the map's width; the action's name is below it.
const LEGEND_ABOVE: f64 = 0.165;

/// A map has this many dashes along its width.
const DASHES: f64 = 75.0;

/// Corners of `map`, counterclockwise.
fn map_corners(map: &MapBounds) -> [Point2<f64>; 4] {
    let ([left, low], [right, high]) = (map.min_m, map.max_m);
    [[left, low], [right, low], [right, high], [left, high]].map(Point2::from)
}

/// Width of a map, m.
pub(super) fn width_m(map: &MapBounds) -> f64 {
    map.max_m[0] - map.min_m[0]
}

/// Sends everything that has no time.
pub(super) fn send(stream: &RecordingStream, scene: &SceneDescription, tolerance_m: f64) -> RecordingStreamResult<()> {
    stream.log_static("/plane", &Transform3D::from_scale([1.0, -1.0, 1.0]))?;
    let map = lines([shapes::closed(&map_corners(&scene.world.map))], style::MAP, 1.0, order::MAP);
    stream.log_static("/plane/map", &map)?;
    for (index, obstacle) in scene.world.obstacles.iter().enumerate() {
        let twins = scene.world.obstacles.iter().take(index).filter(|other| other.name == obstacle.name).count();
        let number = if twins == 0 { String::new() } else { format!("_{}", twins + 1) };
        let path = format!("/plane/obstacles/{}{number}", part(&obstacle.name));
        send_body(stream, &path, &[obstacle.placed()], [style::OBSTACLE, style::OBSTACLE_FILL], order::OBSTACLE)?;
        let place = plain(&(obstacle.placed().pose() * obstacle.shape.centroid()));
        stream.log_static(format!("{path}/name"), &text(place, &obstacle.name, style::OBSTACLE))?;
    }
    send_plan(stream, scene)?;
    send_goal(stream, scene, tolerance_m)?;
    send_object(stream, scene)?;
    send_body(stream, "/plane/tool", &scene.tool.pieces, [style::TOOL, style::TOOL_FILL], order::TOOL)?;
    send_styles(stream)?;
    send_legend(stream, &scene.world.map)
}

/// A body's inside and, below it so that the pieces of a union show one edge, its outline.
fn send_body(
    stream: &RecordingStream,
    path: &str,
    pieces: &[PlacedOutline],
    [edge, fill]: [Rgba; 2],
    height: f32,
) -> RecordingStreamResult<()> {
    let corners: Vec<_> = pieces.iter().map(shapes::corners).collect();
    let edges = lines(corners.iter().map(|corners| shapes::closed(corners)), edge, 2.5, height);
    stream.log_static(format!("{path}/outline"), &edges)?;
    let (strips, radii): (Vec<_>, Vec<_>) = corners
        .iter()
        .map(|corners| shapes::filled(corners))
        .flat_map(|(lines, radius)| lines.into_iter().map(move |line| (line, rerun::Radius::new_scene_units(radius))))
        .unzip();
    let inside = LineStrips2D::new(strips).with_radii(radii).with_colors([fill]).with_draw_order(height + order::ABOVE);
    stream.log_static(format!("{path}/inside"), &inside)
}

fn send_plan(stream: &RecordingStream, scene: &SceneDescription) -> RecordingStreamResult<()> {
    let dash_m = width_m(&scene.world.map) / DASHES;
    let tool = lines(shapes::dashed(&scene.tool_path_world, dash_m), style::TOOL_PLAN, 0.8, order::PLAN);
    stream.log_static("/plane/plan/tool", &tool)?;
    let object = lines(shapes::dashed(&scene.object_path_world, dash_m), style::OBJECT_PLAN, 1.2, order::PLAN);
    stream.log_static("/plane/plan/object", &object)
}

/// The goal, the circle within which the object's center has arrived, and where the object's edge lies then.
fn send_goal(stream: &RecordingStream, scene: &SceneDescription, tolerance_m: f64) -> RecordingStreamResult<()> {
    let pose = nalgebra::Isometry2::from_parts(scene.goal_world.into(), nalgebra::UnitComplex::identity());
    let cross = shapes::cross(&pose, GOAL_CROSS * width_m(&scene.world.map));
    let strokes = cross.into_iter().map(|stroke| stroke.to_vec());
    stream.log_static("/plane/goal", &lines(strokes, style::GOAL, 1.5, order::GOAL))?;
    let circle = lines([shapes::circle(&scene.goal_world, tolerance_m)], style::GOAL, 1.2, order::MARK);
    stream.log_static("/plane/goal/tolerance", &circle)?;
    let outline = scene.object.shape.drawing(72);
    let corners: Vec<_> = outline.into_iter().map(|corner| pose * Point2::from(corner)).collect();
    let edge = lines(shapes::dashed(&corners, 0.002), style::GOAL, 0.8, order::GOAL);
    stream.log_static("/plane/goal/object", &edge)
}

fn send_object(stream: &RecordingStream, scene: &SceneDescription) -> RecordingStreamResult<()> {
    let shape = scene.object.shape.clone();
    let heading = vec![[0.0, 0.0], [shape.radius_m() as f32, 0.0]];
    let outline = PlacedOutline { shape, position_m: [0.0, 0.0], angle_rad: 0.0 };
    send_body(stream, "/plane/object", &[outline], [style::OBJECT, style::OBJECT_FILL], order::OBJECT)?;
    let heading = lines([heading], style::OBJECT, 1.5, order::OBJECT + 2.0 * order::ABOVE);
    stream.log_static("/plane/object/heading", &heading)
}

/// Sends colors and widths of what gets its shape row by row.
fn send_styles(stream: &RecordingStream) -> RecordingStreamResult<()> {
    let styled = |color: Rgba, half_width: f32, height: f32| {
        LineStrips2D::update_fields().with_colors([color]).with_radii([on_screen(half_width)]).with_draw_order(height)
    };
    stream.log_static("/plane/object_path", &styled(style::OBJECT, 1.6, order::TRAIL))?;
    stream.log_static("/plane/tool_path", &styled(style::TOOL, 1.0, order::TRAIL))?;
    stream.log_static("/plane/arm", &styled(style::ARM, 3.0, order::ARM))?;
    stream.log_static("/plane/seen", &styled(style::SEEN, 1.2, order::MARK))?;
    let points = |color: Rgba, size: f32, height: f32| {
        Points2D::update_fields().with_colors([color]).with_radii([on_screen(size)]).with_draw_order(height)
    };
    stream.log_static("/plane/arm/joints", &points(style::ARM, 5.0, order::ARM + order::ABOVE))?;
    stream.log_static("/plane/contacts", &points(style::FORCE, 3.5, order::MARK))?;
    let arrows = rerun::Arrows2D::update_fields().with_colors([style::FORCE]).with_radii([on_screen(3.0)]);
    stream.log_static("/plane/contacts/forces", &arrows.with_draw_order(order::MARK + order::ABOVE))?;
    stream.log_static("/plane/phase", &points(style::MAP, 0.1, order::TEXT))
}

/// Says above the map, where no arm comes from, what the colors mean: plane views have no legend.
fn send_legend(stream: &RecordingStream, map: &MapBounds) -> RecordingStreamResult<()> {
    let entries = [
        ("object, its way", style::OBJECT),
        ("tool, its way", style::TOOL),
        ("plan of the tool", style::TOOL_PLAN),
        ("plan of the object", style::OBJECT_PLAN),
        ("goal, tolerance", style::GOAL),
        ("object as seen", style::SEEN),
        ("contact force", style::FORCE),
        ("arm", style::ARM),
    ];
    let (width, columns) = (width_m(map), 4);
    let place = |index: usize| {
        let (column, line) = ((index % columns) as f64, (index / columns) as f64);
        let x = map.min_m[0] + width * (0.125 + column / columns as f64);
        [x as f32, (map.max_m[1] + width * (LEGEND_ABOVE - 0.055 * line)) as f32]
    };
    let legend = Points2D::new((0..entries.len()).map(place))
        .with_colors(entries.map(|(_, color)| color))
        .with_radii([on_screen(5.0)])
        .with_labels(entries.map(|(label, _)| label))
        .with_show_labels(true)
        .with_draw_order(order::TEXT);
    stream.log_static("/plane/legend", &legend)
}

fn lines(strips: impl IntoIterator<Item = Strip>, color: Rgba, half_width: f32, height: f32) -> LineStrips2D {
    LineStrips2D::new(strips).with_colors([color]).with_radii([on_screen(half_width)]).with_draw_order(height)
}

fn text(place: [f32; 2], words: &str, color: Rgba) -> Points2D {
    Points2D::new([place])
        .with_labels([words])
        .with_show_labels(true)
        .with_colors([color])
        .with_radii([on_screen(0.1)])
        .with_draw_order(order::TEXT)
}
