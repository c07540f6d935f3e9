//! A comparison in sentences: for each further variant, what is better, worse, and not told apart from the first.

use super::{ComparedMeasure, Comparison, Difference, Limits, SuccessDifference, Verdict};
use crate::report::{number, with_unit};

/// What is said of one variant against the first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Statement {
    /// "l against stick".
    pub head: String,
    /// Success; then what is better, worse, different, not told apart.
    pub parts: Vec<String>,
}

/// What is said of each variant after the first.
#[must_use]
pub fn statements(comparison: &Comparison) -> Vec<Statement> {
    comparison.success.iter().map(|success| statement(comparison, success)).collect()
}

/// What is said of variants whose trials are all the same run.
#[must_use]
pub fn remarks(comparison: &Comparison) -> Vec<String> {
    let same = |variant: &&super::Variant| variant.independent_trials < variant.statuses.len();
    let names: Vec<&str> = comparison.variants.iter().filter(same).map(|variant| variant.name.as_str()).collect();
    if names.is_empty() {
        Vec::new()
    } else {
        vec![format!("{}: {}", names.join(", "), crate::report::SAME_RUN.trim_end())]
    }
}

/// "p = 0.012", "p < 0.001": a probability as people write it.
#[must_use]
pub(super) fn probability(p: f64) -> String {
    if p < 0.001 { "p < 0.001".into() } else { format!("p = {p:.3}") }
}

/// A difference with its sign.
pub(super) fn signed(value: f64) -> String {
    if value > 0.0 { format!("+{}", number(value)) } else { number(value).replace('-', "\u{2212}") }
}

/// "+0.5 mm (95 % interval 0.4 to 0.6)": estimate and interval of a difference.
pub(super) fn amount(difference: &Difference, unit: &str) -> String {
    let Some(test) = difference.test else { return "no pair".into() };
    let unit = if unit.is_empty() || unit == "1" { String::new() } else { format!(" {unit}") };
    match test.interval_95 {
        Some([low, high]) => {
            format!("{}{unit} (95 % interval {} to {})", signed(test.estimate), signed(low), signed(high))
        }
        None => format!("{}{unit}", signed(test.estimate)),
    }
}

fn statement(comparison: &Comparison, success: &SuccessDifference) -> Statement {
    let name = |index: usize| comparison.variants.get(index).map_or("?", |variant| variant.name.as_str());
    let (this, first) = (name(success.variant), name(0));
    let mut parts = vec![successes(comparison, success, first)];
    let differences = comparison.measures.iter().filter_map(|measure| {
        let found = measure.differences.iter().find(|difference| difference.variant == success.variant)?;
        Some((measure, found))
    });
    let differences: Vec<(&ComparedMeasure, &Difference)> = differences.collect();
    for (heading, better) in [("better", Some(true)), ("worse", Some(false)), ("different", None)] {
        let such = differences.iter().filter(|(_, found)| found.verdict == Verdict::Real && found.better == better);
        let list: Vec<String> =
            such.map(|(measure, found)| format!("{} by {}", measure.label, amount(found, &measure.unit))).collect();
        if !list.is_empty() {
            parts.push(format!("{heading}: {}", list.join(", ")));
        }
    }
    for (verdict, heading) in [(Verdict::NotToldApart, "not told apart"), (Verdict::TooFew, "too few pairs to tell")] {
        let list: Vec<&str> = differences
            .iter()
            .filter(|(measure, found)| found.verdict == verdict && measure.limit != Limits::None)
            .map(|(measure, _)| measure.label.as_str())
            .collect();
        if !list.is_empty() {
            parts.push(format!("{heading}: {}", list.join(", ")));
        }
    }
    Statement { head: format!("{this} against {first}"), parts }
}

fn successes(comparison: &Comparison, success: &SuccessDifference, first: &str) -> String {
    let count = |index: usize| comparison.variants.get(index).map_or(0, |variant| variant.successes);
    let (here, there) = (count(success.variant), count(0));
    let trials = comparison.seeds.len();
    let counts = format!("{here} of {trials} trials succeeded, with {first} {there}");
    match success.verdict {
        Verdict::Real if here > there => {
            format!("succeeds more often: {counts} ({})", probability(success.corrected_p))
        }
        Verdict::Real => format!("succeeds less often: {counts} ({})", probability(success.corrected_p)),
        Verdict::NotToldApart => format!("success not told apart: {counts} ({})", probability(success.corrected_p)),
        Verdict::TooFew => format!("too few trials to tell success: {counts}"),
    }
}

/// What a measure is called, with its unit.
pub(super) fn headed(measure: &ComparedMeasure) -> String {
    match measure.unit.as_str() {
        "" | "1" => measure.label.clone(),
        unit => format!("{} ({unit})", measure.label),
    }
}

/// "at most 5 mm", "differs", or nothing.
pub(super) fn limit(measure: &ComparedMeasure) -> String {
    match measure.limit {
        Limits::None => String::new(),
        Limits::Various => "differs".into(),
        Limits::Same(crate::outcome::Limit::AtMost(limit)) => {
            format!("at most {}", with_unit(Some(limit), &measure.unit))
        }
        Limits::Same(crate::outcome::Limit::AtLeast(limit)) => {
            format!("at least {}", with_unit(Some(limit), &measure.unit))
        }
    }
}
