//! The pictures of a comparison.

use super::sentences::{amount, headed};
use super::{ComparedMeasure, Comparison};
use crate::outcome::Limit;
use crate::plot::{RowChart, RowMark};
use crate::report::with_unit;

const PERCENT: f64 = 100.0;

/// Share of successful trials of every variant, as bars with their intervals.
pub(super) fn successes(comparison: &Comparison) -> RowChart {
    let counts = comparison.variants.iter().map(|variant| {
        let [low, high] = variant.success_interval_95.map(|share| PERCENT * share);
        format!("{} {} of {} ({low:.0} to {high:.0} %)", variant.name, variant.successes, variant.statuses.len())
    });
    let counts: Vec<String> = counts.collect();
    let mut chart = RowChart::new("Successful trials", "share of trials (%)", counts.join("; "));
    chart.range = Some([0.0, PERCENT]);
    for (index, variant) in comparison.variants.iter().enumerate() {
        let rate = PERCENT * variant.success_rate;
        let interval = variant.success_interval_95.map(|share| PERCENT * share);
        let marks = vec![RowMark::Bar(rate), RowMark::Interval { at: rate, interval: Some(interval) }];
        chart.row(&variant.name, index, marks);
    }
    chart
}

/// All trials of every variant: values, quartiles, median with its interval, the limit.
pub(super) fn spreads(comparison: &Comparison, measure: &ComparedMeasure) -> RowChart {
    let told = comparison.variants.iter().zip(&measure.variants);
    let told: Vec<String> =
        told.map(|(variant, spread)| format!("{}: {}", variant.name, super::table::median(spread))).collect();
    let description = format!("Values of all trials. Median with its 95 % interval: {}", told.join("; "));
    let mut chart = RowChart::new("All trials", &headed(measure), description);
    for (index, (variant, spread)) in comparison.variants.iter().zip(&measure.variants).enumerate() {
        let mut marks = Vec::new();
        if let Some(location) = spread.location {
            let [least, greatest] = location.range;
            let [first, third] = location.quartiles;
            marks.push(RowMark::Box([least, first, third, greatest]));
            marks.push(RowMark::Dots(spread.values.iter().copied().flatten().collect()));
            marks.push(RowMark::Interval { at: location.median, interval: location.median_interval_95 });
        }
        chart.row(&variant.name, index, marks);
    }
    match measure.limit.same() {
        Some(Limit::AtMost(limit)) => chart.limit(limit, &format!("at most {}", with_unit(Some(limit), &measure.unit))),
        Some(Limit::AtLeast(limit)) => {
            chart.limit(limit, &format!("at least {}", with_unit(Some(limit), &measure.unit)));
        }
        None => {}
    }
    chart
}

/// Each further variant less the first, seed by seed; `None` if there is no pair.
pub(super) fn differences(comparison: &Comparison, measure: &ComparedMeasure) -> Option<RowChart> {
    let name = |index: usize| comparison.variants.get(index).map_or("?", |variant| variant.name.as_str());
    let told: Vec<String> = measure
        .differences
        .iter()
        .map(|difference| format!("{}: {}", name(difference.variant), amount(difference, &measure.unit)))
        .collect();
    let description = format!("Differences of pairs of trials with the same seed. Estimates: {}", told.join("; "));
    let unit = if measure.unit == "1" { String::new() } else { format!(" ({})", measure.unit) };
    let mut chart =
        RowChart::new(&format!("Less {}, seed by seed", name(0)), &format!("difference{unit}"), description);
    let first = measure.variants.first()?;
    for difference in &measure.differences {
        let Some(test) = difference.test else { continue };
        let values = measure.variants.get(difference.variant).map_or(&[][..], |spread| spread.values.as_slice());
        let pairs = values.iter().zip(&first.values).filter_map(|(this, first)| Some((*this)? - (*first)?));
        let marks =
            vec![RowMark::Dots(pairs.collect()), RowMark::Interval { at: test.estimate, interval: test.interval_95 }];
        chart.row(name(difference.variant), difference.variant, marks);
    }
    chart.zero();
    chart.has_rows().then_some(chart)
}
