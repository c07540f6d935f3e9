//! Fig. 5(a), (b): sections of a demonstration freed from the tool's corridor, and the skill learned from all of them.

use nalgebra::{DVector, Point2};
use skills::segmentation::pushes;
use skills::{RolloutRequest, Trajectory};

use super::drawing::{X_CM, Y_CM, line_cm, points};
use super::verdict::{Finding, Verdict};
use super::{Figure, Part, Study, StudyError};
use crate::plot::{BLACK, BLUE, Chart, GRAY, LIGHT, RED, figure, fill, line};

/// Samples of a rollout.
const STEPS: f64 = 400.0;
/// Ends that differ by less are the same, m: the camera's noise.
const SAME_END_M: f64 = 0.0004;
/// Colors of the sections, as in the paper.
const SECTIONS: [&str; 2] = [RED, BLUE];

/// Frees the demonstrations from the corridors of their pushes and learns the skill.
pub fn figure_5_skill(study: &Study<'_>) -> Result<Part, StudyError> {
    let run = study.run()?;
    let intention = &run.library.intention;
    let (mut charts, [widest_m, farthest_m]) = section_charts(study)?;
    let shown: Vec<&Trajectory> = intention.unconstrained.iter().collect();

    let mut all = Chart::map("(b) All demonstrations, and the skill", X_CM, Y_CM);
    for path in &shown {
        all.line("unconstrained demonstrations", line(GRAY, 1.2), line_cm(&points(path)));
    }
    let mean = |ends: Vec<DVector<f64>>| ends.iter().sum::<DVector<f64>>() / ends.len().max(1) as f64;
    let start = mean(shown.iter().map(|path| path.start()).collect());
    let goal = mean(shown.iter().map(|path| path.end()).collect());
    let duration_s = intention.duration_s;
    let request = RolloutRequest::new(start, goal.clone(), duration_s, duration_s / STEPS);
    let skill = points(intention.primitive.rollout(&request)?.positions());
    all.line("constraint-irrelevant (CI) skill", line(RED, 2.4), line_cm(&skill));
    charts.push(all);

    let moved_m = intention
        .shown
        .iter()
        .zip(&shown)
        .flat_map(|(before, after)| {
            let after = points(after);
            let pair = |a: Option<&Point2<f64>>, b: Option<&Point2<f64>>| Some((a? - b?).norm());
            [pair(before.first(), after.first()), pair(before.last(), after.last())]
        })
        .flatten()
        .fold(0.0, f64::max);
    let goal_error_m = skill.last().map_or(f64::INFINITY, |end| (end - Point2::new(goal[0], goal[1])).norm());
    Ok(Part {
        text: "Within a push the contact surface keeps the object near a straight line. That corridor, half a surface to \
               either side, is taken out of each section by the map of Algorithm 2, Eqs. (16) to (21); the sections are \
               joined again, and one primitive is learned from all: the constraint-irrelevant (CI) skill."
            .into(),
        figures: vec![Figure {
            file: "figure_5ab.svg",
            svg: figure(&charts, 3, 300.0),
            caption: format!(
                "(a) The pushes of the first demonstration seen along themselves, the other axis drawn out: the object's path \
                 (black) in the reach of the contact surface (gray), and freed from it (red, blue). (b) All freed demonstrations \
                 (gray) and the CI skill (red). As in the paper the ends stay and the path between them is spread, the more the \
                 nearer it was to the edge: by up to {:.1} mm here, against at most {:.1} mm that the shown path itself leaves its \
                 straight line. The paper's demonstrations fill more of their corridors, so that its change is larger.",
                1e3 * farthest_m,
                1e3 * widest_m
            ),
        }],
        verdicts: vec![
            Verdict::new(
                "Proposition 1",
                "start and end of a demonstration are not moved by the map",
                Finding::of(moved_m < SAME_END_M),
                format!("moved by at most {:.6} mm", 1e3 * moved_m),
            ),
            Verdict::new(
                "Sec. IV.A.1, Fig. 5(b)",
                "one CI skill is learned from the unconstrained demonstrations by a standard primitive",
                Finding::of(goal_error_m < 1e-3),
                format!("rolled out to the mean goal, it ends {:.3} mm from it", 1e3 * goal_error_m),
            ),
            Verdict::new(
                "Sec. IV.A.1",
                "the model-based method does not apply here, since the constraints are sets of points",
                Finding::Reproduced,
                "by construction: the corridor is data, there is no Δu with parameters to identify".into(),
            ),
        ],
        ..Part::default()
    })
}

/// Each push of the first demonstration in its corridor, seen along the push, how far it leaves its straight line and how
/// far the map moves it, m.
fn section_charts(study: &Study<'_>) -> Result<(Vec<Chart>, [f64; 2]), StudyError> {
    let run = study.run()?;
    let scenario = study.push;
    let tool = &scenario.demonstration_tool;
    let Some(demonstration) = run.demonstrations.first() else { return Ok((Vec::new(), [0.0; 2])) };
    let aligned = demonstration.aligned();
    let fragments = pushes(&aligned, tool, &scenario.scenario.object.shape);
    let freed = run.library.intention.unconstrained.first().map(points).unwrap_or_default();
    let (mut charts, mut off_m, mut moved_m, mut passed) = (Vec::new(), 0.0f64, 0.0f64, 0);
    for (index, fragment) in fragments.iter().enumerate() {
        let path = fragment.object_path(&aligned);
        let (Some(from), Some(to)) = (path.first(), path.last()) else { continue };
        let along = (to - from).normalize();
        let seen = |place: &Point2<f64>| [1e2 * along.dot(&(place - from)), 1e3 * along.perp(&(place - from))];
        let widest_m = path.iter().map(|place| along.perp(&(place - from)).abs()).fold(0.0, f64::max);
        off_m = off_m.max(widest_m);
        let surface = tool.surfaces.get(fragment.surface);
        let half_m = surface.map_or(0.0, |surface| surface.length_m() / 2.0).max(widest_m);
        let name = surface.map_or("?", |surface| surface.name.as_str());
        let title = format!("(a) Push {} with the {name}", index + 1);
        let mut chart = Chart::graph(title, "along the push (cm)", "to the left of it (mm)");
        let (length, half) = (1e2 * (to - from).norm(), 1e3 * half_m);
        let corners = vec![[0.0, -half], [length, -half], [length, half], [0.0, half]];
        chart.shape("reach of the contact surface", fill(LIGHT, 0.8), vec![corners]);
        // where sections are joined, the first row of the later one is left out
        let own = path.get(usize::from(index > 0)..).unwrap_or_default();
        let part = freed.get(passed..passed + own.len()).unwrap_or_default();
        passed += own.len();
        moved_m = own.iter().zip(part).map(|(shown, freed)| along.perp(&(freed - shown)).abs()).fold(moved_m, f64::max);
        chart.line("freed from it", line(SECTIONS[index % SECTIONS.len()], 2.2), part.iter().map(seen).collect());
        chart.line("shown", line(BLACK, 1.8), path.iter().map(seen).collect());
        charts.push(chart);
    }
    Ok((charts, [off_m, moved_m]))
}
