//! Reports: tables for people and JSON for programs.

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use serde::Serialize;

use crate::outcome::{Limit, Measure, Outcome};
use crate::pipeline::Report;
use crate::sweep::{LevelSummary, SweepSummary};
use crate::tasks::DemonstrationsReport;
use crate::trials::{Summary, Trial, TrialsReport};

/// Tables are fitted to terminals of at least this many columns.
const NARROWEST_TERMINAL: u16 = 60;

/// Said of trials that are all the same run.
pub const SAME_RUN: &str = "all trials are one and the same run, to the last bit: nothing in this scenario is drawn from its seed, so \
                            that more trials tell nothing more; [variation] draws values for each seed\n";

/// Writes a result as JSON: indented, its keys in the order of the struct, with a newline at the end.
///
/// # Errors
/// If a number cannot be written; results hold finite numbers only.
pub fn json<T: Serialize>(result: &T) -> Result<String, serde_json::Error> {
    serde_json::to_string_pretty(result).map(|text| text + "\n")
}

/// Describes one run: its measures, failures and notes, and how long it took.
#[must_use]
pub fn run_text(report: &Report) -> String {
    let outcome = &report.outcome;
    // a task that cannot be done was not measured
    let verdict = match (outcome.success, outcome.measures.is_empty()) {
        (true, _) => "succeeded",
        (false, false) => "missed its limits",
        (false, true) => "cannot be done as stated",
    };
    let mut text = format!("{} with seed {} {verdict}\n", outcome.scenario, outcome.seed);
    if !outcome.measures.is_empty() {
        text += &format!("{}\n", measures_table(outcome));
    }
    for failure in &outcome.failures {
        text += &format!("failure: {failure}\n");
    }
    for note in &outcome.notes {
        text += &format!("note: {note}\n");
    }
    text + &timing_line(report)
}

/// Describes many runs: a line for each, the success rate with its interval, mean and worst of the judged measures.
#[must_use]
pub fn trials_text(report: &TrialsReport) -> String {
    let [low, high] = report.success_interval_95;
    let mut text = format!("{}\n", trials_table(report));
    text += &format!(
        "{} of {} trials succeeded: {:.1} % (95 % interval {:.1} to {:.1} %, Wilson); wanted at least {} %\n",
        report.successes,
        report.trials.len(),
        100.0 * report.success_rate,
        100.0 * low,
        100.0 * high,
        number(100.0 * report.min_success),
    );
    if report.independent_trials < report.trials.len() {
        text += SAME_RUN;
    }
    if !report.measures.is_empty() {
        text += &format!("{}\n", summary_table(&report.measures));
    }
    text
}

/// Describes a campaign: how its runs ended, altogether and for each level of each factor that has few.
#[must_use]
pub fn sweep_text(summary: &SweepSummary) -> String {
    let LevelSummary { done, success, missed, crashed, refused, invalid, success_interval_95, .. } = &summary.all;
    let [low, high] = success_interval_95.map(|share| 100.0 * share);
    let rate = 100.0 * summary.all.success_rate().unwrap_or(0.0);
    let not_run = not_run(*invalid);
    let mut text = format!(
        "{}: {done} of {} runs: {success} success, {missed} missed, {crashed} crashed, {refused} refused{not_run}\n\
         success rate: {rate:.1} % (95 % interval {low:.1} to {high:.1} %, Wilson)\n",
        summary.scenario, summary.planned
    );
    for factor in summary.factors.iter().filter(|factor| factor.levels.len() > 1) {
        text += &format!("{}\n", levels_table(&factor.key, &factor.levels, &summary.all));
    }
    text
}

/// How many runs were not made, if any, because their values make no valid scenario.
pub(crate) fn not_run(invalid: usize) -> String {
    if invalid == 0 { String::new() } else { format!(", {invalid} invalid (not run)") }
}

/// A line for each level: runs, success rate with its interval, medians of the judged measures.
fn levels_table(key: &str, levels: &[LevelSummary], all: &LevelSummary) -> Table {
    let medians = all.measures.iter().map(|measure| format!("median {} ({})", measure.name, measure.unit));
    let header = [key.to_owned(), "runs".into(), "success".into(), "95 % interval".into()];
    let mut table = table(header.into_iter().chain(medians).collect());
    for level in levels {
        let [low, high] = level.success_interval_95.map(|share| 100.0 * share);
        let value = level.value.as_ref().map_or_else(String::new, ToString::to_string);
        let rate = level.success_rate().map_or_else(|| "none".into(), |rate| format!("{:.1} %", 100.0 * rate));
        let median = |name: &str| level.measures.iter().find(|measure| measure.name == name);
        let medians = all
            .measures
            .iter()
            .map(|measure| median(&measure.name).map_or_else(|| "none".into(), |measure| number(measure.median)));
        let cells = [value, level.made().to_string(), rate, format!("{low:.1} to {high:.1} %")];
        table.add_row(cells.into_iter().chain(medians));
    }
    align_right(&mut table, 1..4 + all.measures.len());
    table
}

/// Describes what a synthetic human showed: a line for each trial, and why there are too few successes if so.
#[must_use]
pub fn demonstrations_text(report: &DemonstrationsReport) -> String {
    let header =
        ["trial", "result", "distance to goal (mm)", "duration (s)", "touches", "renewed holds", "file", "reason"];
    let mut table = table(header.map(str::to_owned).to_vec());
    for trial in &report.trials {
        table.add_row([
            trial.trial.to_string(),
            if trial.success { "success" } else { "failed" }.to_owned(),
            number(trial.goal_error_mm),
            number(trial.duration_s),
            trial.touches_s.len().to_string(),
            trial.renewed_holds.to_string(),
            trial.file.clone(),
            trial.failure.clone().unwrap_or_default(),
        ]);
    }
    align_right(&mut table, [0].into_iter().chain(2..6));
    let (successes, tried) = (report.successes, report.trials.len());
    let mut text =
        format!("{table}\n{successes} of {tried} trials of {} with seed {} succeeded\n", report.scenario, report.seed);
    if let Some(shortage) = &report.shortage {
        text += &format!("failure: {shortage}\n");
    }
    text
}

/// Four significant digits, without trailing zeros; in powers of ten where it would be long.
#[must_use]
pub fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    let magnitude = rounded.abs();
    if rounded == 0.0 {
        "0".into()
    } else if (1e-4..1e7).contains(&magnitude) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// "≤ 5 mm": a limit as people write it.
fn limit_text(limit: Option<Limit>, unit: &str) -> String {
    match limit {
        Some(Limit::AtMost(limit)) => format!("at most {}", with_unit(Some(limit), unit)),
        Some(Limit::AtLeast(limit)) => format!("at least {}", with_unit(Some(limit), unit)),
        None => String::new(),
    }
}

pub(crate) fn with_unit(value: Option<f64>, unit: &str) -> String {
    match value {
        None => "none".into(),
        Some(value) if unit.is_empty() || unit == "1" => number(value),
        Some(value) => format!("{} {unit}", number(value)),
    }
}

fn mark(passed: Option<bool>) -> &'static str {
    match passed {
        Some(true) => "pass",
        Some(false) => "FAIL",
        None => "",
    }
}

pub(crate) fn table(header: Vec<String>) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::ASCII_MARKDOWN).set_header(header);
    // a terminal that is narrower than this, or does not know its width, breaks lines better than words
    if table.width().is_some_and(|width| width >= NARROWEST_TERMINAL) {
        table.set_content_arrangement(ContentArrangement::Dynamic);
    }
    table
}

pub(crate) fn align_right(table: &mut Table, columns: impl IntoIterator<Item = usize>) {
    for column in columns {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
}

fn measures_table(outcome: &Outcome) -> Table {
    let mut table = table(["measure", "value", "limit", ""].map(str::to_owned).to_vec());
    for measure in &outcome.measures {
        let value = with_unit(measure.value, &measure.unit);
        let limit = limit_text(measure.limit, &measure.unit);
        table.add_row([measure.label.clone(), value, limit, mark(measure.passed).to_owned()]);
    }
    align_right(&mut table, [1]);
    table
}

fn trials_table(report: &TrialsReport) -> Table {
    let labels = report.measures.iter().map(|measure| match measure.unit.as_str() {
        "" | "1" => measure.label.clone(),
        unit => format!("{} ({unit})", measure.label),
    });
    let header = ["seed".to_owned(), "result".to_owned()].into_iter().chain(labels).chain(["reason".to_owned()]);
    let mut table = table(header.collect());
    for trial in &report.trials {
        let values =
            report.measures.iter().map(|summary| value_in(trial, &summary.name).map_or_else(|| "-".into(), number));
        let row = [trial.seed.to_string(), trial.status.as_str().to_owned()]
            .into_iter()
            .chain(values)
            .chain([trial.reason()]);
        table.add_row(row);
    }
    align_right(&mut table, [0].into_iter().chain(2..2 + report.measures.len()));
    table
}

fn value_in(trial: &Trial, name: &str) -> Option<f64> {
    trial.measures.iter().find(|measure: &&Measure| measure.name == name)?.value
}

fn summary_table(measures: &[Summary]) -> Table {
    let mut table = table(["measure", "mean", "worst", "limit", "trials"].map(str::to_owned).to_vec());
    for measure in measures {
        table.add_row([
            measure.label.clone(),
            with_unit(measure.mean, &measure.unit),
            with_unit(measure.worst, &measure.unit),
            limit_text(measure.limit, &measure.unit),
            measure.count.to_string(),
        ]);
    }
    align_right(&mut table, [1, 2, 4]);
    table
}

fn timing_line(report: &Report) -> String {
    let total: f64 = report.timings_s.iter().map(|(_, seconds)| seconds).sum();
    let stages = report.timings_s.iter().map(|(stage, seconds)| format!("{stage} {seconds:.2} s"));
    let stages = stages.collect::<Vec<_>>().join(", ");
    let simulate = report.timings_s.iter().find(|(stage, _)| *stage == "simulate").map_or(0.0, |(_, seconds)| *seconds);
    let factor = if simulate > 0.0 {
        format!(": {} times real time", number((report.simulated_s / simulate * 10.0).round() / 10.0))
    } else {
        String::new()
    };
    format!("time: {total:.2} s ({stages}); simulated {} s{factor}\n", number(report.simulated_s))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outcome::OUTCOME_SCHEMA;

    fn report() -> Report {
        let outcome = Outcome {
            schema: OUTCOME_SCHEMA.into(),
            scenario: "push".into(),
            task: "push".into(),
            seed: 7,
            version: "0".into(),
            success: false,
            failures: vec!["the object rests 6 mm from its goal".into()],
            measures: vec![
                Measure::judged("goal_error_mm", "distance to the goal", 6.0, "mm", Limit::AtMost(5.0)),
                Measure::reported("contacts", "contact changes", None, "1"),
            ],
            notes: vec!["a note".into()],
            trajectory_digest: "00".into(),
        };
        Report { outcome, timings_s: vec![("plan", 0.5), ("simulate", 2.0)], simulated_s: 20.0 }
    }

    #[test]
    fn a_run_is_told_in_full() {
        let text = run_text(&report());
        for part in [
            "push with seed 7 missed its limits",
            "| distance to the goal | 6 mm  | at most 5 mm | FAIL |",
            "none",
            "failure: the object rests 6 mm from its goal",
            "note: a note",
            "time: 2.50 s (plan 0.50 s, simulate 2.00 s); simulated 20 s: 10 times real time",
        ] {
            let squeezed = text.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(squeezed.contains(&part.split_whitespace().collect::<Vec<_>>().join(" ")), "{part}\n{text}");
        }
    }

    #[test]
    fn a_task_that_cannot_be_done_is_told_without_a_table() {
        let Report { outcome, timings_s, simulated_s } = report();
        let text = run_text(&Report { outcome: Outcome { measures: vec![], ..outcome }, timings_s, simulated_s });
        assert!(text.starts_with("push with seed 7 cannot be done as stated\nfailure: the object rests"), "{text}");
    }

    #[test]
    fn numbers_keep_four_digits() {
        let expect = [
            (0.0, "0"),
            (-0.0, "0"),
            (5.0, "5"),
            (1.23456, "1.235"),
            (123456.0, "123500"),
            (1e-9, "1e-9"),
            (-2.5, "-2.5"),
        ];
        for (value, expected) in expect {
            assert_eq!(number(value), expected);
        }
    }

    #[test]
    fn json_keeps_the_order_of_the_struct_and_ends_in_a_newline() {
        let text = json(&report().outcome).unwrap();
        assert!(text.ends_with("}\n"));
        assert!(text.find("\"schema\"") < text.find("\"seed\"") && text.find("\"seed\"") < text.find("\"measures\""));
    }
}
