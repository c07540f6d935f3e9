//! How well a food was cut: measures out of plan, record and episode alone.

use sim::cutting::geometry::Solid;
use sim::cutting::scene::{CutRecord, PieceRecord};
use skills::cutting::CutSkill;

use super::{CutEpisode, CutTask, Planned};
use crate::measures::rms_and_max;
use crate::outcome::{Limit, Measure};
use crate::tasks::spatial::arm_measures;

const MM: f64 = 1e3;
const G: f64 = 1e3;
const MRAD: f64 = 1e3;
const PERCENT: f64 = 100.0;

/// All measures of a run.
pub(super) fn measures(task: &CutTask<'_>, skill: &CutSkill, planned: &Planned, seen: &CutEpisode) -> Vec<Measure> {
    let mut measures = pieces(task, planned, seen);
    measures.extend(faces(task, seen));
    measures.extend(forces(task, seen));
    measures.extend(food(seen));
    measures.extend(plan(skill, planned));
    measures.extend(arm_measures(&seen.episode, &planned.ready.arm.model));
    measures.extend(planned.actual.measures(&task.cut.scenario));
    measures
}

/// Number, length and mass of the pieces.
fn pieces(task: &CutTask<'_>, planned: &Planned, seen: &CutEpisode) -> Vec<Measure> {
    let limits = &task.cut.scenario.limits;
    let there = &planned.actual.there.food;
    let density = there.material.density_kg_per_m3;
    let whole: Vec<&PieceRecord> = in_order(&seen.record.pieces);
    let extra = (whole.len() as f64 - planned.wanted.len() as f64).abs();
    let crumbs = seen.record.pieces.len() - whole.len();
    let errors = length_errors_m(&whole, &planned.wanted);
    let (rms_m, max_m) = errors.map(|errors| rms_and_max(errors.into_iter())).unzip();
    let before_kg = there.solid.mass_properties(density).mass_kg;
    let after_kg: f64 = seen.record.pieces.iter().map(|piece| piece.mass_kg).sum();
    let lost = (after_kg / before_kg - 1.0).abs();
    vec![
        Measure::reported("pieces", "pieces, without crumbs", whole.len() as f64, "1"),
        Measure::judged("pieces_error", "pieces more or fewer than wanted", extra, "1", Limit::AtMost(0.0)),
        Measure::reported("crumbs", "pieces too thin to collide", crumbs as f64, "1"),
        Measure::judged(
            "thickness_error_rms_mm",
            "length of the pieces to that wanted, RMS",
            rms_m.map(|error_m| error_m * MM),
            "mm",
            Limit::AtMost(limits.thickness_error_rms_m * MM),
        ),
        Measure::reported(
            "thickness_error_max_mm",
            "length of the pieces to that wanted, largest",
            max_m.map(|error_m| error_m * MM),
            "mm",
        ),
        Measure::reported("mass_g", "mass of the food", before_kg * G, "g"),
        Measure::judged(
            "mass_error_share",
            "mass lost or won by cutting",
            lost,
            "1",
            Limit::AtMost(limits.mass_error_share),
        ),
        Measure::reported(
            "mass_cv_percent",
            "coefficient of variation of the pieces' masses",
            variation(&whole).map(|share| share * PERCENT),
            "%",
        ),
    ]
}

/// Pieces that are no crumbs, along the food.
fn in_order(pieces: &[PieceRecord]) -> Vec<&PieceRecord> {
    let mut whole: Vec<&PieceRecord> = pieces.iter().filter(|piece| !piece.crumb).collect();
    whole.sort_by(|one, other| one.center_in_food.x.total_cmp(&other.center_in_food.x));
    whole
}

/// Length of a solid along its x axis, m.
fn length_m(solid: &Solid) -> f64 {
    let (low, high) = solid.bounds();
    high.x - low.x
}

/// Differences of the pieces' lengths along the food from those of the wanted pieces, m; none if their numbers differ.
fn length_errors_m(whole: &[&PieceRecord], wanted: &[Solid]) -> Option<Vec<f64>> {
    let pairs = whole.iter().zip(wanted);
    (whole.len() == wanted.len())
        .then(|| pairs.map(|(piece, wanted)| piece.extent_in_food_m.x - length_m(wanted)).collect())
}

/// Standard deviation of the masses over their mean; none for fewer than two pieces.
fn variation(whole: &[&PieceRecord]) -> Option<f64> {
    let count = whole.len() as f64;
    let mean = whole.iter().map(|piece| piece.mass_kg).sum::<f64>() / count;
    let squares: f64 = whole.iter().map(|piece| (piece.mass_kg - mean).powi(2)).sum();
    (whole.len() > 1).then(|| (squares / (count - 1.0)).sqrt() / mean)
}

/// Form and roughness of the cut faces.
fn faces(task: &CutTask<'_>, seen: &CutEpisode) -> Vec<Measure> {
    let limits = &task.cut.scenario.limits;
    let cuts = &seen.record.cuts;
    let of = |value: fn(&CutRecord) -> f64| mean_and_worst(cuts, value);
    let (ra, ra_worst) = of(|cut| cut.quality.mean_deviation_m * MM);
    let (rt, rt_worst) = of(|cut| cut.quality.total_deviation_m * MM);
    let (wave, _) = of(|cut| cut.quality.waviness_m * MM);
    let (tilt, tilt_worst) = of(|cut| cut.quality.tilt_rad * MRAD);
    let kinks = (!cuts.is_empty()).then(|| cuts.iter().map(|cut| f64::from(cut.quality.kinks)).sum::<f64>());
    let torn: f64 = cuts.iter().map(|cut| cut.quality.torn_area_m2).sum();
    vec![
        Measure::reported("face_deviation_mean_mm", "mean deviation Ra of the cut faces, mean", ra, "mm"),
        bounded(
            "face_deviation_worst_mm",
            "mean deviation Ra of the worst cut face",
            ra_worst,
            "mm",
            limits.mean_deviation_m.map(|m| m * MM),
        ),
        Measure::reported("face_range_mean_mm", "range Rt of the cut faces, mean", rt, "mm"),
        Measure::reported("face_range_worst_mm", "range Rt of the worst cut face", rt_worst, "mm"),
        Measure::reported("face_waviness_mean_mm", "waviness of the cut faces above 5 mm, mean", wave, "mm"),
        Measure::reported("kinks", "stops and retreats of the edge in the food", kinks, "1"),
        Measure::reported("face_tilt_mean_mrad", "tilt of the cut faces from where they began, mean", tilt, "mrad"),
        bounded(
            "face_tilt_worst_mrad",
            "tilt of the worst cut face",
            tilt_worst,
            "mrad",
            limits.tilt_rad.map(|rad| rad * MRAD),
        ),
        Measure::reported("torn_area_mm2", "area torn instead of cut", torn * MM * MM, "mm2"),
    ]
}

/// A measure that is judged if there is a limit.
fn bounded(name: &str, label: &str, value: Option<f64>, unit: &str, most: Option<f64>) -> Measure {
    match most {
        None => Measure::reported(name, label, value, unit),
        Some(most) => Measure::judged(name, label, value, unit, Limit::AtMost(most)),
    }
}

/// Mean and largest value over the cuts; none without any.
fn mean_and_worst(cuts: &[CutRecord], value: fn(&CutRecord) -> f64) -> (Option<f64>, Option<f64>) {
    let mean = cuts.iter().map(value).sum::<f64>() / cuts.len() as f64;
    let worst = cuts.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
    if cuts.is_empty() { (None, None) } else { (Some(mean), Some(worst)) }
}

/// Forces, work and strokes.
fn forces(task: &CutTask<'_>, seen: &CutEpisode) -> Vec<Measure> {
    let cuts = &seen.record.cuts;
    let of = |value: fn(&CutRecord) -> f64| mean_and_worst(cuts, value);
    let (mean_n, _) = of(|cut| cut.force_mean_n);
    let (_, peak_n) = of(|cut| cut.force_peak_n);
    let (ratio, _) = of(|cut| cut.slice_push_ratio_mean);
    let (_, ligament) = of(CutRecord::ligament_share);
    let total = |value: fn(&CutRecord) -> f64| cuts.iter().map(value).sum::<f64>();
    let area_m2 = total(|cut| cut.cut_area_m2);
    let per_area = |work_j: f64| (area_m2 > 0.0).then_some(work_j / area_m2);
    let asked = task.cut.scenario.cut().wanted.cuts() as f64;
    vec![
        Measure::reported("through", "wanted cuts that came apart", through(cuts), "1"),
        Measure::reported("cuts_wanted", "wanted cuts", asked, "1"),
        Measure::reported(
            "ligament_worst_percent",
            "uncut share of a section, largest",
            ligament.map(|share| share * PERCENT),
            "%",
        ),
        Measure::reported("cutting_force_peak_n", "force of the food on the knife, largest", peak_n, "N"),
        Measure::reported("cutting_force_mean_n", "force of the food on the knife while it pressed, mean", mean_n, "N"),
        Measure::reported(
            "work_per_area_j_per_m2",
            "work of the knife by cut area",
            per_area(total(|cut| cut.energy.work_j)),
            "J/m2",
        ),
        Measure::reported(
            "fracture_per_area_j_per_m2",
            "work of fracture by cut area",
            per_area(total(|cut| cut.energy.fracture_j)),
            "J/m2",
        ),
        Measure::reported(
            "unaccounted_per_area_j_per_m2",
            "work of the knife that no part of it accounts for, by cut area",
            per_area(total(|cut| cut.energy.balance_j())),
            "J/m2",
        ),
        Measure::reported("slice_push_ratio_mean", "way along the edge by way into the food, mean", ratio, "1"),
        Measure::reported("strokes", "strokes to and fro, all cuts", total(|cut| cut.strokes as f64), "1"),
        Measure::reported(
            "board_force_max_n",
            "force between knife and board, largest",
            seen.record.board_force_peak_n,
            "N",
        ),
    ]
}

/// Wanted cuts that came apart, each counted once.
fn through(cuts: &[CutRecord]) -> f64 {
    let mut apart: Vec<usize> =
        cuts.iter().filter(|cut| cut.separated_s.is_some()).filter_map(|cut| cut.planned).collect();
    apart.sort_unstable();
    apart.dedup();
    apart.len() as f64
}

/// What the food did on the board.
fn food(seen: &CutEpisode) -> Vec<Measure> {
    let record = &seen.record;
    vec![
        Measure::reported("food_slip_mm", "food slid while it was cut", record.food_slip_m * MM, "mm"),
        Measure::reported("food_roll_mrad", "food turned while it was cut", record.food_roll_rad * MRAD, "mrad"),
    ]
}

/// What the plan was like, and what it was learned from.
fn plan(skill: &CutSkill, planned: &Planned) -> Vec<Measure> {
    let margin_m = planned.cuts.iter().map(|cut| cut.edge_margin_m).fold(f64::INFINITY, f64::min);
    let shown = skill.shown();
    vec![
        Measure::reported("planned_duration_s", "planned duration", planned.plan.duration_s(), "s"),
        Measure::reported(
            "planned_speed_max_m_per_s",
            "speed of the knife in the plan, at most",
            planned.report.rates.speed_m_per_s,
            "m/s",
        ),
        Measure::reported(
            "planned_edge_margin_mm",
            "food from the ends of the usable edge, at least",
            margin_m * MM,
            "mm",
        ),
        Measure::reported(
            "shown_slice_push_ratio",
            "way along the edge by way into the food that was shown",
            shown.slice_push_ratio,
            "1",
        ),
        Measure::reported(
            "shown_wander_mm",
            "knife off its section that was shown, RMS",
            shown.out_of_plane.lateral_m * MM,
            "mm",
        ),
    ]
}

/// What a reader should know of the pieces.
pub(super) fn piece_notes(planned: &Planned, seen: &CutEpisode) -> Vec<String> {
    let wanted = |index: usize| {
        planned.wanted.get(index).map_or_else(String::new, |solid| format!(" ({:.2} mm wanted)", length_m(solid) * MM))
    };
    let pieces = in_order(&seen.record.pieces).into_iter().enumerate();
    let told = pieces.map(|(index, piece)| {
        let (length_mm, mass_g) = (piece.extent_in_food_m.x * MM, piece.mass_kg * G);
        format!("piece {}: {length_mm:.2} mm long{}, {mass_g:.2} g", index + 1, wanted(index))
    });
    told.collect()
}

/// What a reader should know of the plan.
pub(super) fn plan_notes(planned: &Planned) -> Vec<String> {
    let cuts = planned.cuts.iter().zip(&planned.places).enumerate();
    cuts.map(|(index, (cut, place))| {
        let section = &place.section;
        format!(
            "plan: cut {} through {:.1} x {:.1} mm in {} strokes, slice-push ratio {:.2}",
            index + 1,
            section.width_m * MM,
            section.height_m * MM,
            cut.strokes,
            cut.slice_push_ratio,
        )
    })
    .collect()
}
