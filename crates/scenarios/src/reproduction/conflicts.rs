//! Fig. 9: flips by a classic primitive of the tool's pose, which knows neither tool nor object, beside the divided ones.

use skills::outline::Outline;
use skills::tool_flipping::FlipOptions;

use super::flip_tasks::{FIGURE_RADIUS_M, ShownFlips, asked, classic, clearance_m, poses, range_m};
use super::flips::{stages, whole};
use super::verdict::{Finding, Verdict};
use super::{Figure, Part, Study, StudyError, Table};
use crate::plot::{BLACK, figure};

/// Deeper than this is a conflict, not a rounding of the primitive's end, m.
const CONFLICT_M: f64 = 0.0005;
/// A flip that touches is clear to this, m.
const TOUCH_M: f64 = 1e-5;
/// Ratio of the ranges that the paper gives: 5 cm to 8 cm.
const PAPER_RATIO: f64 = 5.0 / 8.0;

/// Objects to flip about: the paper's disc and two others of its size.
fn objects() -> [(&'static str, Outline); 3] {
    let vertices_m = vec![[-0.012, -0.009], [0.0105, -0.0105], [0.0165, 0.003], [0.003, 0.0135], [-0.0105, 0.009]];
    [
        ("disc", Outline::Disc { radius_m: FIGURE_RADIUS_M }),
        ("box", Outline::Box { width_m: 0.024, height_m: 0.020 }),
        ("polygon", Outline::Polygon { vertices_m }),
    ]
}

/// Takes the same demonstrations to the same flips, without and with the division of Prop. 2.
pub fn figure_9(study: &Study<'_>) -> Result<Part, StudyError> {
    let tool = &study.push.tool;
    let skills = ShownFlips::of(study)?.learn(&study.push.demonstration_tool, &study.push.scenario.object.shape)?;
    let mut rows = String::from(
        "| object | angles on the object | surfaces | classic: depth (mm) | TF: clearance (mm) | classic: range (mm) | TF, k2 = 1 \
         (mm) | TF, smallest k2 (mm) |\n|---|---|---|---|---|---|---|---|\n",
    );
    let (mut panels, mut ratios) = (Vec::new(), Vec::new());
    let (mut conflicts, mut flips, mut deepest_m, mut nearest_m) = (0, 0, 0.0f64, f64::INFINITY);
    for (name, object) in objects() {
        for (index, asked) in asked(tool, &object).into_iter().enumerate() {
            let whole = skills.divided.generalize(&asked.task, &whole())?;
            let least = skills.divided.generalize(&asked.task, &FlipOptions::default())?;
            let (whole_poses, least_poses) = (poses(&whole), poses(&least));
            let (Some(first), Some(last)) = (whole_poses.first(), whole_poses.last()) else { continue };
            let plain = classic(&skills.classic, first, last)?;
            let (plain_m, worst) = clearance_m(&asked.task, &plain);
            let clear_m = whole.certificate.smallest_clearance_m.min(least.certificate.smallest_clearance_m);
            let [plain_range, whole_range, least_range] =
                [&plain, &whole_poses, &least_poses].map(|poses| range_m(poses));
            flips += 1;
            conflicts += usize::from(plain_m < -CONFLICT_M);
            deepest_m = deepest_m.max(-plain_m);
            nearest_m = nearest_m.min(clear_m);
            ratios.push(whole_range / plain_range);
            rows += &format!(
                "| {name} | {} | {} | {:.2} | {:.4} | {:.1} | {:.1} | {:.1} |\n",
                asked.name,
                asked.surfaces,
                (-1e3 * plain_m).max(0.0),
                // no minus before a zero
                (1e7 * clear_m).round() / 1e4 + 0.0,
                1e3 * plain_range,
                1e3 * whole_range,
                1e3 * least_range
            );
            if name == "disc" && index % 2 == 0 {
                let deepest = plain.get(worst).filter(|_| plain_m < -CONFLICT_M);
                panels.push(stages(&asked.name, &asked.task, &plain, BLACK, deepest));
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    let [low, high] = [ratios.first(), ratios.last()].map(|ratio| ratio.copied().unwrap_or(f64::NAN));
    let in_range = ratios.iter().filter(|ratio| **ratio <= PAPER_RATIO).count();
    Ok(Part {
        text: "The same demonstrations as one classic primitive of the tool's pose relative to the object, rolled out between \
               the same poses as the flips of Fig. 6, and about two further objects. It knows neither the outline of the tool \
               nor that of the object."
            .into(),
        figures: vec![Figure {
            file: "figure_9.svg",
            svg: figure(&panels, 2, 360.0),
            caption: "The flips of Fig. 6(c), (d) by a classic primitive. As in Fig. 9 the tool cuts through the object on its way; \
                      its deepest pose is red. In a chart without red there is no conflict: the shown way fits the new tool \
                      there by chance. The way is short of what Fig. 6 needs since it is not led round the tool."
                .into(),
        }],
        tables: vec![Table {
            file: "figure_9.md",
            caption: "Depth of the classic primitive in the object, least certified clearance of the divided flips (k2 = 1 and \
                      smallest; 0 is the contact), and the larger extent of the grip's way:"
                .into(),
            markdown: rows,
        }],
        verdicts: vec![
            Verdict::new(
                "Sec. IV.B, Fig. 9",
                "classic DMPs result in conflicts of tool and object in flips",
                if conflicts == flips {
                    Finding::Reproduced
                } else if conflicts > 0 {
                    Finding::Differs
                } else {
                    Finding::NotReproduced
                },
                format!(
                    "in {conflicts} of {flips} flips the tool is more than {:.1} mm inside the object, {:.1} mm at most",
                    1e3 * CONFLICT_M,
                    1e3 * deepest_m
                ),
            ),
            Verdict::new(
                "Sec. IV.B, Fig. 6(c), (d)",
                "the divided flips (TF) do not",
                Finding::of(nearest_m >= -TOUCH_M),
                format!("certified in all {flips}: clearance at least {:.4} mm, contacts included", 1e3 * nearest_m),
            ),
            Verdict::new(
                "Sec. IV.B",
                "with k2 = 1 the range of motion is smaller: 5 cm against 8 cm",
                if in_range == ratios.len() { Finding::Reproduced } else { Finding::NotReproduced },
                format!(
                    "TF over classic is {low:.2} to {high:.2}, 0.63 or less in {in_range} of {}: going round costs way, and what is \
                     saved against a classic primitive depends on what was shown",
                    ratios.len()
                ),
            ),
        ],
        ..Part::default()
    })
}
