//! Texts and properties: the task before the run, the outcome after it.

use std::fmt::Write as _;
use std::sync::Arc;

use rerun::external::arrow::array::{ArrayRef, BooleanArray, Float64Array, StringArray, UInt64Array};
use rerun::{AnyValues, ComponentIdentifier, RecordingStream, RecordingStreamResult, TextDocument};

use crate::outcome::{Limit, Measure, Outcome};
use crate::report::with_unit;
use crate::scenario::ResolvedScenario;

/// Where the task is told.
pub(super) const TASK: &str = "/summary/task";

/// Where the outcome is told.
pub(super) const OUTCOME: &str = "/summary/outcome";

/// Sends what is to be done and by which the recording is found again.
pub(super) fn send_task(stream: &RecordingStream, scenario: &ResolvedScenario, seed: u64) -> RecordingStreamResult<()> {
    stream.log_static(TASK, &TextDocument::from_markdown(task_text(scenario, seed)))?;
    // a run that is killed keeps this text
    stream.log_static(OUTCOME, &TextDocument::from_markdown("# No outcome\n\nThe run has not come to its end."))?;
    let run = AnyValues::default()
        .with_component_from_data("scenario", text(&scenario.name))
        .with_component_from_data("task", text(scenario.kind()))
        .with_component_from_data("seed", Arc::new(UInt64Array::from(vec![seed])))
        .with_component_from_data("version", text(env!("CARGO_PKG_VERSION")));
    stream.send_property("run", &run)
}

/// Sends what came of it.
pub(super) fn send_outcome(stream: &RecordingStream, outcome: &Outcome) -> RecordingStreamResult<()> {
    stream.log_static(OUTCOME, &TextDocument::from_markdown(outcome_text(outcome)))?;
    let success: ArrayRef = Arc::new(BooleanArray::from(vec![outcome.success]));
    let verdict = AnyValues::default().with_component_from_data("success", success);
    let values = outcome.measures.iter().fold(verdict, |values, measure| {
        let value: ArrayRef = Arc::new(Float64Array::from(vec![measure.value]));
        // a measure without a name is in the table only
        match ComponentIdentifier::try_new(&measure.name) {
            Ok(name) => values.with_component_from_data(name, value),
            Err(_) => values,
        }
    });
    stream.send_property("outcome", &values)
}

/// Sends why there is no outcome.
pub(super) fn send_failure(stream: &RecordingStream, reason: &str) -> RecordingStreamResult<()> {
    stream.log_static(OUTCOME, &TextDocument::from_markdown(format!("# No outcome\n\nThe run broke off: {reason}")))?;
    let success: ArrayRef = Arc::new(BooleanArray::from(vec![false]));
    stream.send_property("outcome", &AnyValues::default().with_component_from_data("success", success))
}

fn text(words: &str) -> ArrayRef {
    Arc::new(StringArray::from(vec![words]))
}

fn task_text(scenario: &ResolvedScenario, seed: u64) -> String {
    let header = scenario.header();
    format!(
        "# {}\n\n{}\n\nScenario `{}`, seed {seed}.\n\n```toml\n{}\n```\n",
        header.title,
        header.description,
        scenario.name,
        scenario.source.trim_end()
    )
}

fn outcome_text(outcome: &Outcome) -> String {
    let verdict = if outcome.success { "Success" } else { "Failure" };
    let mut text =
        format!("# {verdict}\n\nScenario `{}`, seed {}, wield {}.\n", outcome.scenario, outcome.seed, outcome.version);
    list(&mut text, "What went wrong", &outcome.failures);
    text.push_str("\n| measure | value | limit | |\n|---|---:|---:|---|\n");
    outcome.measures.iter().for_each(|measure| line(&mut text, measure));
    list(&mut text, "Notes", &outcome.notes);
    text
}

fn list(text: &mut String, title: &str, sentences: &[String]) {
    if !sentences.is_empty() {
        // writing to a string cannot fail
        let _ = write!(text, "\n## {title}\n\n");
        sentences.iter().for_each(|sentence| text.extend(["- ", sentence, "\n"]));
    }
}

fn line(text: &mut String, measure: &Measure) {
    let number = |value: f64| with_unit(Some(value), &measure.unit);
    let value = measure.value.map_or_else(|| "-".into(), number);
    let limit = match measure.limit {
        Some(Limit::AtMost(limit)) => format!("at most {}", number(limit)),
        Some(Limit::AtLeast(limit)) => format!("at least {}", number(limit)),
        None => String::new(),
    };
    let verdict = match measure.passed {
        Some(true) => "kept",
        Some(false) => "**missed**",
        None => "",
    };
    let label = measure.label.replace('|', "\\|");
    // writing to a string cannot fail
    let _ = writeln!(text, "| {label} | {value} | {limit} | {verdict} |");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outcome_tells_verdict_values_and_limits() {
        let outcome = Outcome {
            schema: crate::outcome::OUTCOME_SCHEMA.into(),
            scenario: "push_stick".into(),
            task: "push".into(),
            seed: 7,
            version: "0.1.0".into(),
            success: false,
            failures: vec!["the object stopped 12 mm before its goal".into()],
            measures: vec![
                Measure::judged("goal_error_mm", "distance from the goal", 12.04, "mm", Limit::AtMost(5.0)),
                Measure::reported("contact_losses", "contacts lost", 2.0, "1"),
                Measure::reported("coasting_mm", "way after a|b", None, "mm"),
            ],
            notes: vec!["seen late".into()],
            trajectory_digest: String::new(),
        };
        let text = outcome_text(&outcome);
        for expected in [
            "# Failure",
            "- the object stopped 12 mm before its goal",
            "| distance from the goal | 12.04 mm | at most 5 mm | **missed** |",
            "| contacts lost | 2 |  |  |",
            "| way after a\\|b | - |  |  |",
            "- seen late",
        ] {
            assert!(text.contains(expected), "{expected}\n{text}");
        }
    }
}
