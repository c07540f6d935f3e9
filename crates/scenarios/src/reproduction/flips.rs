//! Fig. 6: a flip learned round the stick, with an arched and a straight virtual object movement, and taken to the L.

use nalgebra::{Isometry2, Point2};
use skills::outline::Outline;
use skills::time_law::minimum_jerk;
use skills::tool_flipping::{Flip, FlipOptions, FlipTask, SecondFactor};

use super::drawing::{OBJECT, X_CM, Y_CM, cm, line_cm, outline_cm, tool_cm, tool_style};
use super::flip_tasks::{Asked, FIGURE_RADIUS_M, FlipSkills, SAMPLES, ShownFlips, asked, poses, range_m};
use super::verdict::{Finding, Verdict};
use super::{Figure, Part, Study, StudyError, Table};
use crate::plot::{BLACK, BLUE, Chart, GRAY, LIGHT, ORANGE, PURPLE, RED, figure, line, outlined};

/// Stages at which the tool is drawn.
const STAGES: usize = 4;
/// A certified bound may lie below zero by this at a contact, m: the contact tolerance.
const TOUCH_M: f64 = 1e-6;

/// The paper's k2 = 1.
pub fn whole() -> FlipOptions {
    FlipOptions { k2: SecondFactor::Fixed(1.0), ..FlipOptions::default() }
}

/// Learns, generalizes, draws.
pub fn figure_6(study: &Study<'_>) -> Result<Part, StudyError> {
    let (tool, small) = (&study.push.tool, &study.push.scenario.object.shape);
    let shown = ShownFlips::of(study)?;
    let skills = shown.learn(&study.push.demonstration_tool, small)?;
    let (charts, [arched_m, straight_m], depth_m) = virtual_movements(study, &skills)?;

    let object = Outline::Disc { radius_m: FIGURE_RADIUS_M };
    let mut rows = String::from(
        "| angles on the object | surfaces | k2 | kept of xᵗ | clearance halfway (mm) | range (mm) |\n|---|---|---|---|---|---|\n",
    );
    let (mut panels, mut worst_m) = (Vec::new(), f64::INFINITY);
    for (index, asked) in asked(tool, &object).into_iter().enumerate() {
        for options in [whole(), FlipOptions::default()] {
            let flip = skills.divided.generalize(&asked.task, &options)?;
            worst_m = worst_m.min(flip.certificate.smallest_clearance_m);
            let (middle_mm, range_mm) = (1e3 * flip.certificate.middle_clearance_m, 1e3 * range_m(&poses(&flip)));
            let Asked { name, surfaces, .. } = &asked;
            rows += &format!(
                "| {name} | {surfaces} | {:.2} | {:.0} % | {middle_mm:.2} | {range_mm:.1} |\n",
                flip.k2,
                1e2 * flip.own_share
            );
            if index % 2 == 0 && options == whole() {
                panels.push(stages(&asked.name, &asked.task, &poses(&flip), PURPLE, None));
            }
        }
    }
    Ok(Part {
        text: format!(
            "The flip skill is learned from the ways of the stick between its two pushes in the {} demonstrations, divided by \
             Prop. 2 into a virtual object movement xᵒ round the stick and the tool's own way xᵗ, and put together again \
             round the L-shaped tool by Eq. (28). All is seen as the way of the object's center in the tool's frame; k1 is \
             the identity, since the factor of Eq. (27) does not meet the end points.",
            shown.tool_world.len()
        ),
        figures: vec![
            Figure {
                file: "figure_6ab.svg",
                svg: figure(&charts, 2, 360.0),
                caption: format!(
                    "The same own way xᵗ (blue) with an arched (a) and a straight (b) virtual object movement xᵒ (orange), and \
                     their sum xᵀᶠ (red), from the lower face to the tip of the L. As in the paper the arched one leads farther \
                     from the start, {:.1} against {:.1} mm; the straight one cuts {:.1} mm deep into the tool's reach.",
                    1e3 * arched_m,
                    1e3 * straight_m,
                    1e3 * depth_m
                ),
            },
            Figure {
                file: "figure_6cd.svg",
                svg: figure(&panels, 2, 360.0),
                caption: "Flips from the lower face to the tip of the L round an object of radius 1.5 cm, at four stages (numbered \
                          at the grip), for both pairs of contact angles of Fig. 6(c), (d) and both readings of their unit (as \
                          printed, and with a lost π). The way of the grip is red. No stage overlaps the object, in any case."
                    .into(),
            },
        ],
        tables: vec![Table {
            file: "figure_6.md",
            caption: "All flips, first with the paper's k2 = 1, then with the smallest that is certified; clearance in the \
                      middle half of the flip:"
                .into(),
            markdown: rows,
        }],
        verdicts: vec![
            Verdict::new(
                "Sec. IV.A.2, Fig. 6(a), (b)",
                "with an arched virtual object movement the trajectory deviates more from its start than with a line",
                Finding::of(arched_m > straight_m),
                format!("farthest from the start {:.1} mm against {:.1} mm, same ends", 1e3 * arched_m, 1e3 * straight_m),
            ),
            Verdict::new(
                "Sec. IV.A.2, Fig. 6(c), (d)",
                "flips for the given contact angles change the contact on tool and object without conflict",
                Finding::of(worst_m >= -TOUCH_M),
                format!(
                    "8 flips (2 pairs of angles, 2 readings of \"rad\", 2 pairs of surfaces), k2 = 1 and smallest: certified \
                     clearance at least {:.4} mm, contacts included",
                    1e3 * worst_m
                ),
            ),
            Verdict::new(
                "Eqs. (26), (27)",
                "k1 = I − 2 tr(Δxᵗ (Δxᵒ)ᴴ) recovers the flip",
                Finding::NotReproduced,
                "the trace has a unit and k1 not; a scalar k1 exists only for parallel displacements. Used instead: k1 = I, \
                 and the goal of xᵗ is solved for"
                    .into(),
            ),
        ],
        ..Part::default()
    })
}

/// The tool at stages of a flip about the object.
///
/// `deepest` is a pose to be shown for its overlap.
pub fn stages(
    title: &str,
    task: &FlipTask<'_>,
    poses: &[Isometry2<f64>],
    color: &'static str,
    deepest: Option<&Isometry2<f64>>,
) -> Chart {
    let mut chart = Chart::map(title, X_CM, Y_CM);
    let at = |stage: usize| poses.get(stage * (poses.len().saturating_sub(1)) / (STAGES - 1));
    let drawn: Vec<&Isometry2<f64>> = (0..STAGES).filter_map(at).collect();
    chart.shape("object", OBJECT, vec![outline_cm(task.object, &task.object_world)]);
    for (stage, pose) in drawn.iter().enumerate() {
        let edge = if stage == 0 || stage + 1 == STAGES { color } else { GRAY };
        let name = if stage == 0 || stage + 1 == STAGES { "tool, first and last" } else { "tool, on its way" };
        chart.shape(name, tool_style(edge).faint(0.5), tool_cm(task.tool, pose));
    }
    if let Some(pose) = deepest {
        chart.shape("tool, deepest in the object", outlined(RED, "#ff9d8c", 0.55), tool_cm(task.tool, pose));
    }
    let way: Vec<Point2<f64>> = poses.iter().map(|pose| pose.translation.vector.into()).collect();
    chart.line("way of the grip", line(RED, 2.0), line_cm(&way));
    for (stage, pose) in drawn.iter().enumerate() {
        chart.word(line(BLACK, 1.0), cm(&pose.translation.vector.into()), (stage + 1).to_string());
    }
    chart
}

/// Charts of both movements, how far each leads from the start, and how deep the straight one cuts in, m.
fn virtual_movements(study: &Study<'_>, skills: &FlipSkills) -> Result<([Chart; 2], [f64; 2], f64), StudyError> {
    let (tool, object) = (&study.push.tool, &study.push.scenario.object.shape);
    let Some([from, to]) = tool.surfaces.first_chunk::<2>() else {
        return Err(StudyError::Run(format!("the tool `{}` has fewer than two surfaces", tool.name)));
    };
    let task = FlipTask {
        tool,
        object,
        object_world: Isometry2::identity(),
        contacts: [from.middle(), to.middle()],
        tool_angles_rad: [0.0; 2],
        duration_s: 2.0,
    };
    let [arched, bare] = [skills.divided.generalize(&task, &whole())?, task.flip(&whole())?];
    let sampled = |flip: &Flip| -> Vec<Point2<f64>> {
        (0..SAMPLES).map(|row| flip.object_in_tool(2.0 * row as f64 / (SAMPLES - 1) as f64).point()).collect()
    };
    let (sum, object_way) = (sampled(&arched), sampled(&bare));
    let (start, end) = (sum[0], sum[SAMPLES - 1]);
    let line_way: Vec<Point2<f64>> =
        (0..SAMPLES).map(|row| start + (end - start) * minimum_jerk(row as f64 / (SAMPLES - 1) as f64)).collect();
    let own: Vec<Point2<f64>> = sum.iter().zip(&object_way).map(|(sum, object)| start + (sum - object)).collect();
    let straight: Vec<Point2<f64>> = line_way.iter().zip(&own).map(|(line, own)| line + (own - start)).collect();
    let farthest = |way: &[Point2<f64>]| way.iter().map(|place| (place - start).norm()).fold(0.0, f64::max);
    let depth_m = straight
        .iter()
        .map(|place| object.radius_m() - tool.signed_distance_m(place))
        .fold(f64::NEG_INFINITY, f64::max);
    let chart = |title: &str, way: &[Point2<f64>], sum: &[Point2<f64>]| {
        let mut chart = Chart::map(title, "x in the tool's frame (cm)", "y in the tool's frame (cm)");
        chart.shape("tool", outlined(GRAY, LIGHT, 1.0), tool_cm(tool, &Isometry2::identity()));
        for place in [&start, &end] {
            chart.shape(
                "object, first and last",
                OBJECT.faint(0.35),
                vec![outline_cm(object, &Isometry2::translation(place.x, place.y))],
            );
        }
        chart.line("xᵒ, virtual object movement", line(ORANGE, 2.2), line_cm(way));
        chart.line("xᵗ, the tool's own way", line(BLUE, 2.2), line_cm(&own));
        chart.line("xᵀᶠ, their sum", line(RED, 2.0).dashed("6 3"), line_cm(sum));
        chart
    };
    let charts = [chart("(a) Arched xᵒ", &object_way, &sum), chart("(b) Straight xᵒ", &line_way, &straight)];
    Ok((charts, [farthest(&sum), farthest(&straight)], depth_m))
}
