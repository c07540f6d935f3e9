//! How well it was poured: measures out of what became of the grains and of the arm's episode.

use nalgebra::Vector2;
use sim::pouring::PourResult;
use skills::pouring::PourReport;

use super::scenario::PourScenario;
use super::{Planned, PourEpisode};
use crate::outcome::{Limit, Measure};
use crate::tasks::spatial::arm_measures;

const MM: f64 = 1e3;
const GRAMS: f64 = 1e3;
const PERCENT: f64 = 100.0;
/// A link that touches the target is at 0, as is one inside of it.
const LEAST_ARM_TO_TARGET_MM: f64 = 0.1;

/// All measures of a run.
pub(super) fn measures(scenario: &PourScenario, planned: &Planned, episode: &PourEpisode) -> Vec<Measure> {
    let poured = &episode.poured;
    let mut measures = amounts(scenario, poured);
    measures.extend(flow(poured));
    measures.extend(stream(&planned.pour.report, poured));
    measures.extend(lip(planned, poured));
    measures.extend(touches(scenario, poured));
    measures.extend(arm_measures(&episode.episode, &planned.ready.arm.model));
    measures.extend(planned.drawn.measures(&scenario.variation, &scenario.grains.bean));
    measures
}

/// What was collected, spilt and left: the three and what still flies add up to what was in the cup.
fn amounts(scenario: &PourScenario, poured: &PourResult) -> Vec<Measure> {
    let (limits, amount) = (&scenario.limits, &scenario.pour().amount);
    let (counts, masses) = (&poured.counts, &poured.masses);
    let percent = |count: usize| PERCENT * count as f64 / counts.total().max(1) as f64;
    let count = |name: &str, label: &str, count: usize| Measure::reported(name, label, count as f64, "1");
    let left_label = "beans left in the cup, share";
    let left = match amount {
        None => Measure::judged(
            "left_percent",
            left_label,
            percent(counts.source),
            "%",
            Limit::AtMost(PERCENT * limits.left_share),
        ),
        Some(_) => Measure::reported("left_percent", left_label, percent(counts.source), "%"),
    };
    let mut measures = vec![
        Measure::judged(
            "spilt_percent",
            "beans spilt, share",
            percent(counts.spilt),
            "%",
            Limit::AtMost(PERCENT * limits.spilt_share),
        ),
        left,
        Measure::reported("collected_percent", "beans collected, share", percent(counts.target), "%"),
    ];
    if let Some(amount) = amount {
        let error_kg = masses.target_kg - amount.wanted_kg;
        measures.push(Measure::reported("fill_error_g", "poured, less what was wanted", error_kg * GRAMS, "g"));
        measures.push(Measure::judged(
            "fill_error_size_g",
            "difference of what was poured from what was wanted",
            error_kg.abs() * GRAMS,
            "g",
            Limit::AtMost(limits.amount_error_kg * GRAMS),
        ));
    }
    measures.extend([
        count("beans", "beans in the cup at first, number", counts.total()),
        count("collected_count", "beans collected, number", counts.target),
        count("spilt_count", "beans spilt, number", counts.spilt),
        count("left_count", "beans left in the cup, number", counts.source),
        count("flying_count", "beans still on the way, number", counts.flying),
        Measure::reported("collected_g", "mass collected", masses.target_kg * GRAMS, "g"),
        Measure::reported("spilt_g", "mass spilt", masses.spilt_kg * GRAMS, "g"),
        Measure::reported("left_g", "mass left in the cup", masses.source_kg * GRAMS, "g"),
    ]);
    measures
}

fn flow(poured: &PourResult) -> Vec<Measure> {
    let has_landed = poured.landed > 0;
    let spread = |value: f64| has_landed.then_some(value * MM);
    let (deviation, width) = (poured.landing_deviation_m, poured.landing_width_m);
    let measure = |name: &str, label: &str, value: Option<f64>, unit: &str| Measure::reported(name, label, value, unit);
    vec![
        measure("flow_mean_g_per_s", "flow, mean", Some(poured.mean_flow_kg_per_s * GRAMS), "g/s"),
        measure("flow_peak_g_per_s", "flow over 0.2 s, largest", Some(poured.peak_flow_kg_per_s * GRAMS), "g/s"),
        measure("flow_variation", "flow over 0.2 s, deviation over mean", Some(poured.flow_variation), "1"),
        measure(
            "exit_speed_mean_m_per_s",
            "beans as they leave the cup, mean speed",
            Some(poured.exit_speed_m_per_s),
            "m/s",
        ),
        measure("clogs", "stops of the flow in the tilted cup", Some(poured.clogs as f64), "1"),
        measure("bounce_outs", "beans that left the target again", Some(poured.bounce_outs as f64), "1"),
        measure("rim_hits", "beans that hit the rim", Some(poured.rim_hits as f64), "1"),
        measure(
            "landing_off_center_mm",
            "middle of the beans in the mouth's plane, off its center",
            spread(poured.landing_mean_m.norm()),
            "mm",
        ),
        measure("landing_deviation_x_mm", "beans in the mouth's plane, deviation along x", spread(deviation.x), "mm"),
        measure("landing_deviation_y_mm", "beans in the mouth's plane, deviation along y", spread(deviation.y), "mm"),
        measure("landing_width_x_mm", "beans in the mouth's plane, width of 95 % along x", spread(width.x), "mm"),
        measure("landing_width_y_mm", "beans in the mouth's plane, width of 95 % along y", spread(width.y), "mm"),
    ]
}

/// Where the stream meets the plane of the mouth, along the direction of pouring, and where the plan expects it.
fn stream(report: &PourReport, poured: &PourResult) -> Vec<Measure> {
    let known = |value: f64| value.is_finite().then_some(value * MM);
    let (sin, cos) = report.direction_rad.sin_cos();
    let landed = (poured.landed > 0).then(|| poured.landing_mean_m.dot(&Vector2::new(cos, sin)) * MM);
    let measure = |name: &str, label: &str, value: Option<f64>, unit: &str| Measure::reported(name, label, value, unit);
    vec![
        measure("landing_along_mm", "middle of the beans in the mouth's plane, along the pour", landed, "mm"),
        measure(
            "planned_landing_mm",
            "middle of the beans along the pour, expected by the plan",
            known(report.landing_m),
            "mm",
        ),
        measure("planned_throw_mm", "throw of the stream, expected by the plan", known(report.throw_m), "mm"),
        measure(
            "planned_exit_speed_m_per_s",
            "beans as they leave the cup, expected by the plan",
            report.exit_speed_m_per_s.is_finite().then_some(report.exit_speed_m_per_s),
            "m/s",
        ),
    ]
}

fn lip(planned: &Planned, poured: &PourResult) -> Vec<Measure> {
    let lip = &poured.lip;
    let mm = |value_m: Option<f64>| value_m.map(|value_m| value_m * MM);
    let report = &planned.pour.report;
    let measure = |name: &str, label: &str, value: Option<f64>, unit: &str| Measure::reported(name, label, value, unit);
    vec![
        measure("lip_distance_onset_mm", "lip to the mouth when 1 % has left", mm(lip.onset_distance_m), "mm"),
        measure("lip_distance_mean_mm", "lip to the mouth while it flows, mean", mm(lip.mean_distance_m), "mm"),
        measure("lip_distance_max_mm", "lip to the mouth while it flows, largest", mm(lip.largest_distance_m), "mm"),
        measure("onset_tilt_deg", "tilt when 1 % has left", lip.onset_tilt_rad.map(f64::to_degrees), "deg"),
        measure("stop_tilt_deg", "tilt when the last bean left", lip.stop_tilt_rad.map(f64::to_degrees), "deg"),
        measure(
            "planned_onset_tilt_deg",
            "tilt at which the plan expects the flow",
            Some(report.onset_rad.to_degrees()),
            "deg",
        ),
        measure("planned_clearance_mm", "cup to target in the plan, certified", mm(planned.clearance_m), "mm"),
    ]
}

fn touches(scenario: &PourScenario, poured: &PourResult) -> Vec<Measure> {
    vec![
        Measure::judged(
            "cup_touches",
            "times that the cup touched the target",
            poured.target_touches as f64,
            "1",
            Limit::AtMost(scenario.limits.cup_touches as f64),
        ),
        Measure::reported("table_touches", "times that the cup touched the table", poured.table_touches as f64, "1"),
        arm_distance("arm_above_table_mm", "lowest point of the arm's links above the table", poured.arm.table_m, 0.0),
        arm_distance(
            "arm_to_target_mm",
            "arm's links to the target, least",
            poured.arm.target_m,
            LEAST_ARM_TO_TARGET_MM,
        ),
    ]
}

/// The arm has no colliders, and must go through nothing; one whose file states no shapes that collide is not judged.
fn arm_distance(name: &str, label: &str, least_m: f64, at_least_mm: f64) -> Measure {
    if least_m.is_infinite() {
        return Measure::reported(name, label, None, "mm");
    }
    Measure::judged(name, label, least_m * MM, "mm", Limit::AtLeast(at_least_mm))
}
