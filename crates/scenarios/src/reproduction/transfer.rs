//! Fig. 5(c): the skill generalized three times: freely, past the obstacle, and by what the new tool can do.

use nalgebra::{Isometry2, Point2};
use skills::outline::separation_m;
use skills::transfer::Transfer;

use super::drawing::{OBJECT, line_cm, outline_cm, points, start_and_goal, table};
use super::verdict::{Finding, Verdict};
use super::{Figure, Part, Study, StudyError, Table};
use crate::measures::path_length_m;
use crate::plot::{BLUE, GREEN, RED, figure, fill, line};
use crate::tasks::push::ResolvedPush;

/// The paper's safe margin between object and obstacle, m (§IV.A.1).
pub const SAFE_MARGIN_M: f64 = 0.015;
/// An object that slides less than this on its tool over a whole run does not slip, mm.
const MOST_SLIP_MM: f64 = 1.0;
/// Points between two corners of a path whose clearance is looked at.
const LOOKS: u32 = 200;

/// Least distance of the object from an obstacle along a path of its center, m.
pub fn clearance_m(scenario: &ResolvedPush, path: &[Point2<f64>]) -> f64 {
    let object = &scenario.scenario.object.shape;
    let at = |place: Point2<f64>| {
        let here = Isometry2::translation(place.x, place.y);
        let all = scenario.scenario.world.obstacles.iter().map(|obstacle| obstacle.placed());
        all.filter_map(|other| separation_m(object, &here, &other.shape, &other.pose())).fold(f64::INFINITY, f64::min)
    };
    let leg = |pair: &[Point2<f64>]| {
        let looks = if path.len() > LOOKS as usize { 1 } else { LOOKS };
        (0..=looks)
            .map(|look| at(pair[0] + (pair[1] - pair[0]) * (f64::from(look) / f64::from(looks))))
            .fold(f64::INFINITY, f64::min)
    };
    path.windows(2).map(leg).fold(f64::INFINITY, f64::min)
}

/// The corners of the phases: start, each change of surface, end.
pub fn corners(transfer: &Transfer) -> Vec<Point2<f64>> {
    let phases = &transfer.phases.phases;
    phases.iter().take(1).map(|phase| phase.from_world).chain(phases.iter().map(|phase| phase.to_world)).collect()
}

/// Start and goal of the task.
pub fn ends(study: &Study<'_>) -> (Point2<f64>, Point2<f64>) {
    let push = study.push.scenario.push();
    (push.start_m.into(), push.goal_m.into())
}

/// Draws the three paths and measures what each keeps.
pub fn figure_5_transfer(study: &Study<'_>) -> Result<Part, StudyError> {
    let (scenario, transfer) = (study.push, study.transfer()?);
    let object = &scenario.scenario.object.shape;
    let (start, goal) = ends(study);
    let slip = study.run()?.outcome.measures.iter().find(|measure| measure.name == "slip_mm");
    let slip_mm = slip.and_then(|measure| measure.value).unwrap_or(f64::NAN);
    let free = points(&transfer.reference.generalized);
    let kept = points(&transfer.reference.constrained);
    let phases = corners(transfer);

    let mut chart = table("Three generalizations", &scenario.scenario, SAFE_MARGIN_M + object.radius_m());
    for place in [&start, &goal] {
        chart.shape(
            "object at start and goal",
            OBJECT,
            vec![outline_cm(object, &Isometry2::translation(place.x, place.y))],
        );
    }
    chart.line("CI skill, generalized", line(GREEN, 2.2), line_cm(&free));
    chart.line("past the obstacle (C-DMP)", line(BLUE, 2.2), line_cm(&kept));
    chart.line("with the tool: phases", line(RED, 2.4), line_cm(&phases));
    chart.dots(
        "change of contact surface",
        fill(RED, 1.0),
        4.0,
        line_cm(&phases[1..phases.len().saturating_sub(1).max(1)]),
    );
    start_and_goal(&mut chart, &start, &goal);

    let all = [("CI skill, generalized", &free), ("past the obstacle", &kept), ("phases of the tool", &phases)];
    let mut rows =
        String::from("| path | length (mm) | object to obstacle (mm) | end to goal (mm) |\n|---|---|---|---|\n");
    for (name, path) in all {
        let miss_m = path.last().map_or(f64::INFINITY, |end| (end - goal).norm());
        let (length, clearance) = (1e3 * path_length_m(path), 1e3 * clearance_m(scenario, path));
        rows += &format!("| {name} | {length:.1} | {clearance:.2} | {:.3} |\n", 1e3 * miss_m);
    }
    Ok(Part {
        text: "The CI skill is rolled out to the new start and goal (green), kept out of the obstacle and its safe margin of \
               15 mm (blue), and brought to what the L-shaped tool can push along its three surfaces (red)."
            .into(),
        figures: vec![Figure {
            file: "figure_5c.svg",
            svg: figure(&[chart], 1, 520.0),
            caption: format!(
                "The object's center. As in Fig. 5(c) the green path runs into the obstacle's margin, the blue one bends \
                 round it, and the red one follows the blue one as far as pushes down, left and up allow. The blue path falls \
                 and rises steeply, where the paper's is drawn smooth: its bound is one on y over time, which falls as the \
                 green path comes over the obstacle. The dashed curve is 15 mm plus the object's radius away from the \
                 obstacle: the center may touch it, not cross it. All paths begin where the camera sees the object, {:.1} mm \
                 from where it stands.",
                free.first().map_or(0.0, |seen| 1e3 * (seen - start).norm())
            ),
        }],
        tables: vec![Table { file: "figure_5c.md", caption: "The three paths:".into(), markdown: rows }],
        verdicts: verdicts(scenario, transfer, [&free, &kept, &phases], (start, goal), slip_mm),
        ..Part::default()
    })
}

fn verdicts(
    scenario: &ResolvedPush,
    transfer: &Transfer,
    [free, kept, phases]: [&Vec<Point2<f64>>; 3],
    (start, goal): (Point2<f64>, Point2<f64>),
    slip_mm: f64,
) -> Vec<Verdict> {
    let least = |path: &[Point2<f64>]| clearance_m(scenario, path);
    let (free_m, kept_m, phases_m) = (least(free), least(kept), least(phases));
    let straight_m = least(&[start, goal]);
    let certified = transfer.reference.certificate.as_ref().is_some_and(skills::corridor_filter::Certificate::holds);
    let used: Vec<&str> = transfer
        .phases
        .phases
        .iter()
        .filter_map(|phase| Some(scenario.tool.surfaces.get(phase.hold.surface)?.name.as_str()))
        .collect();
    vec![
        Verdict::new(
            "Table 1",
            "the generalized task needs the obstacle to be avoided",
            Finding::of(straight_m < 0.0 && free_m < 0.0),
            format!(
                "straight from start to goal the object overlaps the obstacle by {:.1} mm; along the CI skill by {:.1} mm",
                -1e3 * straight_m,
                -1e3 * free_m
            ),
        ),
        Verdict::new(
            "Sec. IV.A.1, Fig. 5(c)",
            "constrained DMP keeps a safe margin of 1.5 cm between object and obstacle (blue)",
            Finding::of(kept_m >= SAFE_MARGIN_M && certified),
            format!(
                "{:.2} mm at least; {} (with the logit law in place of Eq. (32), whose proof has a gap)",
                1e3 * kept_m,
                if certified { "certified between samples too" } else { "not certified" }
            ),
        ),
        Verdict::new(
            "Fig. 5(c)",
            "each generalization keeps what the one before it keeps: the phases (red) keep the margin too",
            Finding::of(phases_m >= SAFE_MARGIN_M),
            format!("{:.2} mm at least", 1e3 * phases_m),
        ),
        Verdict::new(
            "Sec. IV.B, Fig. 5(d)",
            "the L-shaped tool changes its surface only twice: bottom, left side, top",
            Finding::of(used == ["bottom", "tip", "top"]),
            format!("surfaces {}; the search is exact for its cost", used.join(", ")),
        ),
        Verdict::new(
            "Sec. IV.A",
            "the tool pushes perpendicular to its surfaces, and the object does not slip",
            Finding::of(
                slip_mm < MOST_SLIP_MM && transfer.phases.phases.iter().all(|phase| along_normal(scenario, phase)),
            ),
            format!(
                "{} straight pushes, each within 0.01 rad of the normal of its surface; carried out, the object slides {slip_mm:.2} mm on the tool in all",
                transfer.phases.phases.len()
            ),
        ),
    ]
}

/// Whether a phase leads along the normal of its surface.
fn along_normal(scenario: &ResolvedPush, phase: &skills::transfer::Phase) -> bool {
    let Some(surface) = scenario.tool.surfaces.get(phase.hold.surface) else { return false };
    let normal = phase.hold.center_from_tool.rotation * surface.contact_at(phase.hold.place_m).normal.into_inner();
    normal.angle(&(phase.to_world - phase.from_world)) < 0.01
}
