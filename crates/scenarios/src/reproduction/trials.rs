//! The transfer experiment under many seeds, with and without looking at the object.

use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::verdict::{Finding, Verdict};
use super::{Figure, Part, Study, StudyError, Table};
use crate::outcome::Outcome;
use crate::pipeline;
use crate::plot::{BLACK, BLUE, Chart, DASHED, ORANGE, figure, line};
use crate::scenario::ResolvedScenario;
use crate::statistics::wilson;
use crate::tasks::push::ExecutionMode;

/// Ways in which a plan is carried out.
const MODES: [(&str, ExecutionMode); 2] =
    [("closed loop", ExecutionMode::ClosedLoop), ("open loop", ExecutionMode::OpenLoop)];
/// Measures that are told of every mode.
const MEASURES: [&str; 4] = ["goal_error_mm", "object_clearance_mm", "tool_clearance_mm", "knocked_mm"];

/// Runs the seeds in both ways.
pub fn trials(study: &Study<'_>) -> Result<Part, StudyError> {
    let (trials, done) = (study.trials as usize, AtomicUsize::new(0));
    let limit_mm = 1e3 * study.push.scenario.limits.goal_error_m;
    let mut chart =
        Chart::graph("Distance to the goal", "distance of the object from its goal (mm)", "share of seeds (%)");
    let mut rows = String::from(
        "| | succeeded | 95 % interval (Wilson) | measure | median | range |\n|---|---|---|---|---|---|\n",
    );
    let mut verdicts = Vec::new();
    let mut farthest_mm = 0.0;
    for ((name, mode), style) in MODES.into_iter().zip([line(BLUE, 2.2), line(ORANGE, 2.2).dashed("9 3")]) {
        let scenario = study.executed(mode);
        let outcomes = outcomes(&scenario, trials, &|| {
            (study.count)(done.fetch_add(1, Ordering::Relaxed) + 1, MODES.len() * trials);
        })?;
        let successes = outcomes.iter().filter(|outcome| outcome.success).count();
        let [low, high] = wilson(successes, trials).map(|share| 1e2 * share);
        for (index, measure) in MEASURES.iter().enumerate() {
            let (values, label) = values(&outcomes, measure);
            let head = if index == 0 {
                format!("{name} | {successes} of {trials} | {low:.1} to {high:.1} %")
            } else {
                " | | ".into()
            };
            rows += &format!("| {head} | {label} | {} |\n", spread(&values));
        }
        let (errors, _) = values(&outcomes, "goal_error_mm");
        farthest_mm = errors.last().map_or(farthest_mm, |last| last.max(farthest_mm));
        chart.line(name, style, staircase(&errors, trials));
        verdicts.push((name, successes, [low, high], spread(&errors)));
    }
    if farthest_mm > limit_mm {
        chart.line("limit", line(BLACK, 1.2).dashed(DASHED), vec![[limit_mm, 0.0], [limit_mm, 100.0]]);
    }
    chart.limits([0.0, 1.15 * farthest_mm], [0.0, 104.0]);
    let verdicts = verdicts.into_iter().enumerate().map(|(index, (_, successes, [low, high], errors))| {
        let claim = if index == 0 {
            "the skill is transferred: the joystick with tool 2 pushes the object to the destination"
        } else {
            "the generalized trajectory alone, carried out without looking, reaches the destination"
        };
        let finding = if successes == trials {
            Finding::Reproduced
        } else if 2 * successes > trials {
            Finding::Differs
        } else {
            Finding::NotReproduced
        };
        let measured = format!(
            "{successes} of {trials} seeds succeed (95 % interval {low:.1} to {high:.1} %); distance to the goal, median and range: {} mm",
            errors.replace(" | ", ", ")
        );
        Verdict::new("Sec. IV.A", claim, finding, measured)
    });
    Ok(Part {
        text: format!(
            "The paper shows one run. Here the whole chain, from the demonstrations on, is repeated with seeds 1 to {trials}, \
             which change the human, the camera and its noise. A run succeeds if the object ends within {limit_mm:.0} mm of its \
             goal and neither it nor the tool touches the obstacle."
        ),
        verdicts: verdicts.collect(),
        figures: vec![Figure {
            file: "trials.svg",
            svg: figure(&[chart], 1, 460.0),
            caption: format!(
                "Share of the seeds whose object ended within a distance of its goal: closed loop, in which the tool is \
                      steered by what the camera sees, and open loop, in which the plan is carried out whatever the object does. \
                      A success is anything up to {limit_mm:.0} mm. The paper has no such figure."
            ),
        }],
        tables: vec![Table { file: "trials.md", caption: "All seeds (mm):".into(), markdown: rows }],
        ..Part::default()
    })
}

/// Outcomes of seeds 1 to `trials`, in parallel, in their order.
fn outcomes(scenario: &ResolvedScenario, trials: usize, done: &(dyn Fn() + Sync)) -> Result<Vec<Outcome>, StudyError> {
    let run = |seed: usize| {
        let report = pipeline::run(scenario, seed as u64, &mut (), &|_, _| {});
        done();
        report.map(|report| report.outcome).map_err(|error| StudyError::Run(format!("seed {seed}: {error}")))
    };
    (1..=trials).into_par_iter().map(run).collect()
}

/// Values of a measure in ascending order, and what it tells.
fn values(outcomes: &[Outcome], name: &str) -> (Vec<f64>, String) {
    let all = outcomes.iter().flat_map(|outcome| &outcome.measures).filter(|measure| measure.name == name);
    let label = all.clone().next().map_or_else(String::new, |measure| measure.label.clone());
    let mut values: Vec<f64> = all.filter_map(|measure| measure.value).collect();
    values.sort_by(f64::total_cmp);
    (values, label)
}

/// Median and range of ascending values.
fn spread(values: &[f64]) -> String {
    match (values.get(values.len() / 2), values.first(), values.last()) {
        (Some(median), Some(first), Some(last)) => format!("{median:.3} | {first:.3} to {last:.3}"),
        _ => "– | –".into(),
    }
}

/// Share of `count` that is at or below each of ascending values, in %.
fn staircase(values: &[f64], count: usize) -> Vec<[f64; 2]> {
    let share = |index: usize| 1e2 * index as f64 / count.max(1) as f64;
    let steps =
        values.iter().enumerate().flat_map(|(index, value)| [[*value, share(index)], [*value, share(index + 1)]]);
    std::iter::once([0.0, 0.0]).chain(steps).collect()
}
