//! Fig. 8: the tree, the tool along its path, and how often the tool is placed anew.

use nalgebra::{Isometry2, Point2};
use skills::baseline::{ToolTurning, TwoLevelConfig, TwoLevelPlan};

use super::drawing::{OBJECT, cm, line_cm, outline_cm, start_and_goal, table, tool_cm, tool_style};
use super::planners::{Map, Searched};
use super::transfer::SAFE_MARGIN_M;
use super::{Study, StudyError};
use crate::plot::{BLACK, BLUE, Chart, DASHED, DOTTED, GRAY, GREEN, ORANGE, PURPLE, RED, SKY, figure, fill, line};

/// Colors of the surfaces, as in Fig. 8(d).
const SURFACES: [&str; 3] = [PURPLE, GREEN, ORANGE];
/// Every so many segments that can be pushed along the tool is drawn.
const DRAWN: usize = 3;

/// The search that is drawn, and the counts of all.
pub struct Example<'a> {
    /// The search.
    pub searched: &'a Searched,
    /// Trajectory points of all seeds.
    pub points: &'a [usize],
    /// The same with shortcuts.
    pub shortened: &'a [usize],
    /// Corners of the transferred plan.
    pub ours: &'a [Point2<f64>],
}

/// Draws the four charts.
pub fn draw(study: &Study<'_>, map: &Map<'_>, example: &Example<'_>) -> Result<String, StudyError> {
    let searched = example.searched;
    let mut tree = chart(study, map, "(a) RRT* for the object");
    tree.pieces(
        "tree",
        line(SKY, 0.7),
        searched.found.branches.iter().map(|branch| branch.each_ref().map(cm)).collect(),
    );
    tree.line("path found", line(BLUE, 3.0), line_cm(&searched.found.path));
    tree.dots("node of the path", fill(BLUE, 1.0), 3.0, line_cm(&searched.found.path));
    start_and_goal(&mut tree, &map.ends.0, &map.ends.1);

    let free = TwoLevelConfig { turning: ToolTurning::WithHeading, ..TwoLevelConfig::default() };
    let turned = map.tool_level(&free, &searched.found.path)?;
    let turned = tool_chart(study, map, "(b) Tool without constraints", &turned, example);
    let fixed = tool_chart(study, map, "(c) Tool with its angle kept", &searched.plans[0].1, example);
    Ok(figure(&[tree, turned, fixed, counts(example)], 2, 400.0))
}

fn chart(study: &Study<'_>, map: &Map<'_>, title: &str) -> Chart {
    let scenario = &study.push.scenario;
    let radius_m = scenario.object.shape.radius_m();
    let mut chart = table(title, scenario, SAFE_MARGIN_M + radius_m);
    chart.limits([-10.0, 12.0], [-0.6, 18.6]);
    let start = Isometry2::translation(map.ends.0.x, map.ends.0.y);
    chart.shape("object at the start", OBJECT, vec![outline_cm(&scenario.object.shape, &start)]);
    chart
}

fn tool_chart(study: &Study<'_>, map: &Map<'_>, title: &str, plan: &TwoLevelPlan, example: &Example<'_>) -> Chart {
    let mut chart = chart(study, map, title);
    let name = |surface: usize| study.push.tool.surfaces.get(surface).map_or("?", |surface| surface.name.as_str());
    let pushable = plan.segments.iter().filter(|segment| segment.obstruction.is_none());
    for segment in pushable.step_by(DRAWN) {
        let style = tool_style(SURFACES[segment.hold.surface % SURFACES.len()]).faint(0.45);
        chart.shape(None, style, tool_cm(&study.push.tool, &segment.hold.world_from_tool_start));
    }
    for segment in &plan.segments {
        let ends = vec![cm(&segment.from_world), cm(&segment.to_world)];
        if segment.obstruction.is_some() {
            chart.line("not pushable", line(RED, 3.0).dashed(DOTTED), ends);
        } else {
            let color = SURFACES[segment.hold.surface % SURFACES.len()];
            chart.line(format!("pushed by the {}", name(segment.hold.surface)).as_str(), line(color, 3.0), ends);
        }
    }
    if title.starts_with("(c)") {
        chart.line("transferred skill", line(BLACK, 1.4).dashed(DASHED), line_cm(example.ours));
    }
    start_and_goal(&mut chart, &map.ends.0, &map.ends.1);
    chart
}

/// How many seeds have how many trajectory points.
fn counts(example: &Example<'_>) -> Chart {
    let mut chart =
        Chart::graph("(d) Trajectory points over all seeds", "trajectory points (tool placed anew)", "seeds");
    let most = example.points.iter().copied().max().unwrap_or(0).max(24);
    let count = |all: &[usize], value: usize| all.iter().filter(|points| **points == value).count() as f64;
    let mut highest = 1.0f64;
    let series = [("two-level RRT*, as found", SKY, example.points), ("with shortcuts", ORANGE, example.shortened)];
    for (name, color, all) in series {
        let bars = (0..=most).filter(|value| count(all, *value) > 0.0).map(|value| {
            let (x, y) = (value as f64, count(all, value));
            vec![[x - 0.4, 0.0], [x + 0.4, 0.0], [x + 0.4, y], [x - 0.4, y]]
        });
        highest = (0..=most).map(|value| count(all, value)).fold(highest, f64::max);
        chart.shape(name, fill(color, 0.9), bars.collect());
    }
    let upright = |x: f64| vec![[x, 0.0], [x, 1.15 * highest]];
    chart.line("paper: RRT*, 22", line(RED, 1.8).dashed(DASHED), upright(22.0));
    chart.line("paper: DMP, 4", line(GRAY, 1.8).dashed(DOTTED), upright(4.0 - 0.12));
    chart.line("here: DMP", line(BLACK, 1.8), upright(example.ours.len() as f64 + 0.12));
    chart.limits([0.0, most as f64 + 1.5], [0.0, 1.15 * highest]);
    chart
}
