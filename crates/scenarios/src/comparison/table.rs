//! A comparison as text for a terminal: a table of all variants, and sentences.

use super::sentences::{amount, headed, limit, probability};
use super::{Comparison, Difference, Spread, Variant, remarks, statements};
use crate::report::{align_right, number, table};

/// Describes a comparison: successes, the middle of every measure, differences from the first variant, sentences.
#[must_use]
pub fn text(comparison: &Comparison) -> String {
    let (count, first) = (comparison.seeds.len(), comparison.seeds.first().copied().unwrap_or_default());
    let last = comparison.seeds.last().copied().unwrap_or_default();
    let mut text = format!(
        "{}: {} variants, {count} trials each with the same seeds {first} to {last}\n{}\n",
        comparison.scenario,
        comparison.variants.len(),
        variants(comparison)
    );
    if !comparison.measures.is_empty() {
        text += &format!("median [95 % interval]\n{}\n", medians(comparison));
        text += &format!("difference from {}, seed by seed\n{}\n", first_name(comparison), differences(comparison));
    }
    for remark in remarks(comparison) {
        text += &format!("{remark}\n");
    }
    for statement in statements(comparison) {
        text += &format!("{}:\n  {}\n", statement.head, statement.parts.join("\n  "));
    }
    text
}

fn first_name(comparison: &Comparison) -> &str {
    comparison.variants.first().map_or("?", |variant| variant.name.as_str())
}

fn variants(comparison: &Comparison) -> comfy_table::Table {
    let header = ["variant", "success", "95 % interval (%)", "against the first", "why not"];
    let mut table = table(header.map(str::to_owned).to_vec());
    for (index, variant) in comparison.variants.iter().enumerate() {
        let [low, high] = variant.success_interval_95;
        let against = comparison.success.iter().find(|success| success.variant == index);
        table.add_row([
            variant.name.clone(),
            format!("{} of {}", variant.successes, variant.statuses.len()),
            format!("{:.1} to {:.1}", 100.0 * low, 100.0 * high),
            against.map_or_else(String::new, |found| {
                format!("{}, {}", found.verdict.as_str(), probability(found.corrected_p))
            }),
            reason(variant),
        ]);
    }
    align_right(&mut table, [1, 2]);
    table
}

/// The commonest kind of failure, up to its numbers, with how often it came.
fn reason(variant: &Variant) -> String {
    match variant.failed.as_slice() {
        [] => String::new(),
        [first, ..] => {
            let why = first.failures.first().map_or("", String::as_str);
            format!("{} trials; seed {}: {why}", variant.failed.len(), first.seed)
        }
    }
}

fn medians(comparison: &Comparison) -> comfy_table::Table {
    let names = comparison.variants.iter().map(|variant| variant.name.clone());
    let header = ["measure".to_owned()].into_iter().chain(names).chain(["limit".to_owned()]);
    let mut table = table(header.collect());
    for measure in &comparison.measures {
        let cells = measure.variants.iter().map(median);
        table.add_row([headed(measure)].into_iter().chain(cells).chain([limit(measure)]));
    }
    align_right(&mut table, 1..=comparison.variants.len());
    table
}

/// "5.1 [4.9, 5.3]", and of how many values, if not of all.
pub(super) fn median(spread: &Spread) -> String {
    let Some(location) = spread.location else { return "none".into() };
    let interval = location
        .median_interval_95
        .map_or_else(String::new, |[low, high]| format!(" [{}, {}]", number(low), number(high)));
    let missing = spread.values.len() - location.count;
    let note = if missing == 0 { String::new() } else { format!(" ({missing} missing)") };
    format!("{}{interval}{note}", number(location.median))
}

fn differences(comparison: &Comparison) -> comfy_table::Table {
    let header = ["measure", "variant", "difference", "corrected p", "verdict", "pairs"];
    let mut table = table(header.map(str::to_owned).to_vec());
    for measure in &comparison.measures {
        for difference in &measure.differences {
            let name = comparison.variants.get(difference.variant).map_or("?", |variant| variant.name.as_str());
            table.add_row([
                measure.label.clone(),
                name.to_owned(),
                amount(difference, &measure.unit),
                difference.corrected_p.map_or_else(|| "none".into(), probability),
                verdict(difference),
                pairs(difference),
            ]);
        }
    }
    table
}

/// "41 (9 missing)": how many pairs there are, and how many lack a value.
pub(super) fn pairs(difference: &Difference) -> String {
    let count = difference.test.map_or(0, |test| test.pairs);
    match difference.missing_seeds.len() {
        0 => count.to_string(),
        missing => format!("{count} ({missing} missing)"),
    }
}

/// The verdict, and to which side it is.
pub(super) fn verdict(difference: &Difference) -> String {
    let side = match difference.better {
        Some(true) => ", better",
        Some(false) => ", worse",
        None => "",
    };
    format!("{}{side}", difference.verdict.as_str())
}
