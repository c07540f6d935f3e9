//! Drawings that several figures share: the table with its obstacles, tools, objects; lengths in cm, as in the paper.

use nalgebra::{DMatrix, Isometry2, Point2};
use skills::Trajectory;
use skills::outline::Outline;
use skills::tool::Tool;

use crate::plot::{BLACK, Chart, DASHED, GRAY, LIGHT, RED, Style, fill, line, outlined};
use crate::tasks::push::PushScenario;

/// Labels of the axes of a map.
pub const X_CM: &str = "x (cm)";
pub const Y_CM: &str = "y (cm)";
/// How an object is drawn.
pub const OBJECT: Style = outlined(RED, "#f4c7bf", 0.8);
/// Points of a drawn circle.
const ARC_POINTS: usize = 60;

/// A place in cm.
pub fn cm(point: &Point2<f64>) -> [f64; 2] {
    [1e2 * point.x, 1e2 * point.y]
}

/// Places in cm.
pub fn line_cm<'a>(points: impl IntoIterator<Item = &'a Point2<f64>>) -> Vec<[f64; 2]> {
    points.into_iter().map(cm).collect()
}

/// The points of a path (n × 2 or more, m).
pub fn points(path: &Trajectory) -> Vec<Point2<f64>> {
    rows(path.samples())
}

/// The points of a table of coordinates.
pub fn rows(table: &DMatrix<f64>) -> Vec<Point2<f64>> {
    table.row_iter().map(|row| Point2::new(row[0], row[1])).collect()
}

/// A tool at a pose, as polygons.
pub fn tool_cm(tool: &Tool, world_from_tool: &Isometry2<f64>) -> Vec<Vec<[f64; 2]>> {
    tool.pieces.iter().map(|piece| outline_cm(&piece.shape, &(world_from_tool * piece.pose()))).collect()
}

/// An outline at a pose, as a polygon.
pub fn outline_cm(outline: &Outline, pose: &Isometry2<f64>) -> Vec<[f64; 2]> {
    outline.drawing(ARC_POINTS).into_iter().map(|vertex| cm(&(pose * Point2::from(vertex)))).collect()
}

/// A chart of the whole map with its obstacles, and the distance from them at which the object's center stays.
pub fn table(title: &str, scenario: &PushScenario, center_margin_m: f64) -> Chart {
    let mut chart = Chart::map(title, X_CM, Y_CM);
    let (min, max) = (scenario.world.map.min_m, scenario.world.map.max_m);
    chart.limits(
        [1e2 * min[0] - BORDER_CM, 1e2 * max[0] + BORDER_CM],
        [1e2 * min[1] - BORDER_CM, 1e2 * max[1] + BORDER_CM],
    );
    let corners = [[min[0], min[1]], [max[0], min[1]], [max[0], max[1]], [min[0], max[1]], [min[0], min[1]]];
    chart.line("map", line(GRAY, 1.0).dashed("4 3"), corners.map(|corner| cm(&corner.into())).to_vec());
    for obstacle in &scenario.world.obstacles {
        let placed = obstacle.placed();
        if center_margin_m > 0.0 {
            let around = offset_cm(&placed.shape, &placed.pose(), center_margin_m);
            chart.line("limit of the object's center", line(BLACK, 1.0).dashed(DASHED), around);
        }
        chart.shape("obstacle", outlined(BLACK, GRAY, 1.0), vec![outline_cm(&placed.shape, &placed.pose())]);
    }
    chart
}

/// Room around the map, cm.
const BORDER_CM: f64 = 0.6;

/// The curve at a distance around a convex outline.
fn offset_cm(outline: &Outline, pose: &Isometry2<f64>, distance_m: f64) -> Vec<[f64; 2]> {
    // the farthest point in every direction, moved outward along it, and the first one again
    let vertices: Vec<Point2<f64>> =
        outline.drawing(ARC_POINTS).into_iter().map(|vertex| pose * Point2::from(vertex)).collect();
    let directions = (0..DIRECTIONS).map(|index| std::f64::consts::TAU * f64::from(index) / f64::from(DIRECTIONS));
    let mut around: Vec<[f64; 2]> = directions
        .filter_map(|angle| {
            let direction = nalgebra::Vector2::new(angle.cos(), angle.sin());
            let vertex =
                vertices.iter().max_by(|a, b| a.coords.dot(&direction).total_cmp(&b.coords.dot(&direction)))?;
            Some(cm(&(vertex + direction * distance_m)))
        })
        .collect();
    around.extend(around.first().copied());
    around
}

/// Directions in which a curve around an outline is drawn.
const DIRECTIONS: u32 = 144;

/// Marks start and goal of the object.
pub fn start_and_goal(chart: &mut Chart, start: &Point2<f64>, goal: &Point2<f64>) {
    chart.dots(None, fill(BLACK, 1.0), 3.5, vec![cm(start), cm(goal)]);
    for (place, letter) in [(start, "S"), (goal, "E")] {
        let [x, y] = cm(place);
        chart.word(line(BLACK, 1.0), [x + 0.55, y + 0.5], letter);
    }
}

/// How a tool is drawn, its border in a color.
pub fn tool_style(color: &'static str) -> Style {
    Style { opacity: 0.75, ..outlined(color, LIGHT, 1.0) }
}
