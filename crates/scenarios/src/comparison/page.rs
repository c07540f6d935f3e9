//! A comparison as a page: one file that a browser shows without a network and without scripts.

use std::fmt::Write as _;

use super::sentences::{amount, headed, limit, probability};
use super::{ComparedMeasure, Comparison, Difference, Limits, Variant, Verdict, charts, remarks, statements};
use crate::plot::escaped;
use crate::report::number;
use crate::trials::Status;

const STYLE: &str = include_str!("page.css");
/// Variants are told apart by this many colors.
const COLORS: usize = 8;

/// The page; `recording` names the recording beside it, if there is one.
#[must_use]
pub fn page(comparison: &Comparison, recording: Option<&str>) -> String {
    let title = format!("{}: {}", comparison.scenario, names(comparison).join(", "));
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n",
        escaped(&title)
    );
    head(&mut out, comparison, recording);
    successes(&mut out, comparison);
    if !comparison.measures.is_empty() {
        out.push_str("<section>\n<h2>Measures</h2>\n");
        medians(&mut out, comparison);
        differences(&mut out, comparison);
        out.push_str("</section>\n");
        for (index, measure) in comparison.measures.iter().enumerate() {
            pictures(&mut out, comparison, measure, index);
        }
    }
    failures(&mut out, comparison);
    out.push_str(METHOD);
    out.push_str("</main>\n</body>\n</html>\n");
    out
}

const METHOD: &str = "<section>\n<h2>How this was computed</h2>\n<p class=\"note\">\
    Every variant ran the same seeds; a seed decides about everything that varies. Boxes: quartiles and full range; diamonds \
    with whiskers: median, or estimate of a difference, with its 95 % interval. Success rates: Wilson's interval; compared by \
    McNemar's exact test. Medians: interval between order statistics. Differences seed by seed: Hodges and Lehmann's estimate, \
    its interval and probability by Wilcoxon's signed ranks, exact up to 50 pairs (ties too; zero differences take no part in the \
    test), normal with corrections beyond. Probabilities are corrected by Holm for the number of variants, measure by measure, \
    not for the number of measures. Real: corrected p below 0.05. Too few: so few pairs that no outcome could have been \
    real.</p>\n</section>\n";

fn names(comparison: &Comparison) -> Vec<&str> {
    comparison.variants.iter().map(|variant| variant.name.as_str()).collect()
}

fn name(comparison: &Comparison, index: usize) -> String {
    escaped(comparison.variants.get(index).map_or("?", |variant| variant.name.as_str()))
}

/// A variant's name with the square of its color.
fn keyed(comparison: &Comparison, index: usize) -> String {
    format!(
        "<span class=\"name\"><span class=\"key c{}\" aria-hidden=\"true\"></span>{}</span>",
        index % COLORS,
        name(comparison, index)
    )
}

fn head(out: &mut String, comparison: &Comparison, recording: Option<&str>) {
    let heading = names(comparison).join(", ");
    let [first, last] =
        [comparison.seeds.first(), comparison.seeds.last()].map(|seed| seed.copied().unwrap_or_default());
    let _ = write!(
        out,
        "<header>\n<h1>{}</h1>\n<p class=\"about\">{}</p>\n<p class=\"about\">Scenario <code>{}</code>, task {}, {} trials of \
         each variant with the seeds {first} to {last}; wield {}.",
        escaped(&heading),
        escaped(&comparison.title),
        escaped(&comparison.scenario),
        escaped(&comparison.task),
        comparison.seeds.len(),
        escaped(&comparison.version)
    );
    if let Some(recording) = recording {
        let file = escaped(recording);
        let _ = write!(out, " One seed of each side by side: <code>rerun {file}</code>.");
    }
    out.push_str("</p>\n<div class=\"verdict\" role=\"note\" aria-label=\"verdict\">\n");
    for remark in remarks(comparison) {
        let _ = writeln!(out, "<p>{}</p>", escaped(&remark));
    }
    for statement in statements(comparison) {
        let _ = writeln!(out, "<p><strong>{}</strong></p>\n<ul>", escaped(&statement.head));
        for part in statement.parts {
            let _ = writeln!(out, "<li>{}</li>", escaped(&part));
        }
        out.push_str("</ul>\n");
    }
    out.push_str("</div>\n</header>\n");
}

fn successes(out: &mut String, comparison: &Comparison) {
    out.push_str("<section>\n<h2>Success</h2>\n<div class=\"pair\">\n<figure>\n");
    out.push_str(&charts::successes(comparison).svg("success"));
    out.push_str(
        "</figure>\n<div class=\"scroll\"><table>\n<caption>The first variant is what the others are compared with</caption>\n\
         <thead><tr><th scope=\"col\">variant</th><th scope=\"col\">made of</th><th scope=\"col\" class=\"n\">success</th>\
         <th scope=\"col\" class=\"n\">95 % interval</th><th scope=\"col\">against the first</th></tr></thead>\n<tbody>\n",
    );
    for (index, variant) in comparison.variants.iter().enumerate() {
        let changes: Vec<String> =
            variant.changes.iter().map(|change| format!("<code>{}</code>", escaped(&change.to_string()))).collect();
        let [low, high] = variant.success_interval_95.map(|share| 100.0 * share);
        let against = comparison.success.iter().find(|success| success.variant == index).map(|found| {
            let discordant = format!("only it {}, only the first {}", found.only_this, found.only_first);
            let class = if found.verdict == Verdict::Real { " class=\"real\"" } else { "" };
            format!(
                "<span{class}>{}</span>, {}; {discordant}",
                found.verdict.as_str(),
                escaped(&probability(found.corrected_p))
            )
        });
        let _ = writeln!(
            out,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td class=\"n\">{} of {}</td><td class=\"n\">{low:.1} to {high:.1} %</td>\
             <td>{}</td></tr>",
            keyed(comparison, index),
            changes.join("<br>"),
            variant.successes,
            variant.statuses.len(),
            against.unwrap_or_default()
        );
    }
    out.push_str("</tbody>\n</table></div>\n</div>\n</section>\n");
}

fn medians(out: &mut String, comparison: &Comparison) {
    out.push_str("<div class=\"scroll\"><table>\n<caption>Median of each measure, with its 95 % interval</caption>\n<thead><tr><th scope=\"col\">measure</th>");
    for index in 0..comparison.variants.len() {
        let _ = write!(out, "<th scope=\"col\" class=\"n\">{}</th>", keyed(comparison, index));
    }
    out.push_str("<th scope=\"col\">limit</th></tr></thead>\n<tbody>\n");
    for measure in &comparison.measures {
        let _ = write!(out, "<tr><th scope=\"row\">{}</th>", escaped(&headed(measure)));
        for spread in &measure.variants {
            let _ = write!(out, "<td class=\"n\">{}</td>", escaped(&super::table::median(spread)));
        }
        let _ = writeln!(out, "<td>{}</td></tr>", escaped(&limit(measure)));
    }
    out.push_str("</tbody>\n</table></div>\n");
}

fn differences(out: &mut String, comparison: &Comparison) {
    let _ = write!(
        out,
        "<div class=\"scroll\"><table>\n<caption>Difference from {}, seed by seed</caption>\n<thead><tr><th scope=\"col\">measure</th>\
         <th scope=\"col\">variant</th><th scope=\"col\">difference</th><th scope=\"col\">corrected p</th>\
         <th scope=\"col\">verdict</th><th scope=\"col\" class=\"n\">pairs</th></tr></thead>\n<tbody>\n",
        name(comparison, 0)
    );
    for measure in &comparison.measures {
        for difference in &measure.differences {
            let p = difference.corrected_p.map_or_else(|| "none".into(), probability);
            let _ = writeln!(
                out,
                "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td class=\"n\">{}</td></tr>",
                escaped(&measure.label),
                keyed(comparison, difference.variant),
                escaped(&amount(difference, &measure.unit)),
                escaped(&p),
                verdict(difference),
                super::table::pairs(difference)
            );
        }
    }
    out.push_str("</tbody>\n</table></div>\n");
    missing(out, comparison);
}

fn verdict(difference: &Difference) -> String {
    let class = match (difference.verdict, difference.better) {
        (Verdict::Real, Some(true)) => "real better",
        (Verdict::Real, Some(false)) => "real worse",
        (Verdict::Real, None) => "real",
        _ => "",
    };
    format!("<span class=\"{class}\">{}</span>", super::table::verdict(difference))
}

/// Names the seeds whose pairs lack a value: once for each variant, if it is the same for all measures.
fn missing(out: &mut String, comparison: &Comparison) {
    let mut told: Vec<(usize, &[u64])> = Vec::new();
    for (measure, difference) in
        comparison.measures.iter().flat_map(|measure| measure.differences.iter().map(move |found| (measure, found)))
    {
        let pair = (difference.variant, difference.missing_seeds.as_slice());
        if difference.missing_seeds.is_empty() || told.contains(&pair) {
            continue;
        }
        told.push(pair);
        let _ = writeln!(
            out,
            "<p class=\"note\">{}: no pair of values from seeds {} ({} and others that lack the same).</p>",
            keyed(comparison, difference.variant),
            seeds(&difference.missing_seeds),
            escaped(&measure.label)
        );
    }
}

/// Seeds as runs: "1 to 5, 9".
fn seeds(seeds: &[u64]) -> String {
    let runs = seeds.chunk_by(|a, b| a.checked_add(1) == Some(*b));
    let text = runs.map(|run| match run {
        [first, .., last] => format!("{first} to {last}"),
        _ => run.first().map_or_else(String::new, u64::to_string),
    });
    text.collect::<Vec<_>>().join(", ")
}

fn pictures(out: &mut String, comparison: &Comparison, measure: &ComparedMeasure, index: usize) {
    let note = match measure.limit {
        Limits::None => " <span class=\"note\">not judged</span>",
        Limits::Various => " <span class=\"note\">limits differ between variants</span>",
        Limits::Same(_) => "",
    };
    let _ = write!(
        out,
        "<section>\n<h3>{}{note}</h3>\n<div class=\"pair\">\n<figure>\n{}</figure>\n",
        escaped(&measure.label),
        charts::spreads(comparison, measure).svg(&format!("values-{index}"))
    );
    if let Some(chart) = charts::differences(comparison, measure) {
        let _ = write!(out, "<figure>\n{}</figure>\n", chart.svg(&format!("differences-{index}")));
    }
    out.push_str("</div>\n</section>\n");
}

fn failures(out: &mut String, comparison: &Comparison) {
    out.push_str("<section>\n<h2>Failures</h2>\n");
    if comparison.variants.iter().all(|variant| variant.failed.is_empty()) {
        out.push_str("<p>None.</p>\n");
    }
    for (index, variant) in comparison.variants.iter().enumerate().filter(|(_, variant)| !variant.failed.is_empty()) {
        let _ = write!(
            out,
            "<h3>{}</h3>\n<p class=\"note\">{}</p>\n<div class=\"scroll\"><table>\n<thead><tr><th scope=\"col\">seeds</th>\
             <th scope=\"col\">result</th><th scope=\"col\">reason</th></tr></thead>\n<tbody>\n",
            keyed(comparison, index),
            tally(variant)
        );
        for (such, status, reasons) in grouped(variant) {
            let reasons: Vec<String> = reasons.iter().map(|reason| escaped(reason)).collect();
            let _ = writeln!(
                out,
                "<tr><td>{}</td><td>{}</td><td>{}</td></tr>",
                seeds(&such),
                status.as_str(),
                reasons.join("<br>")
            );
        }
        out.push_str("</tbody>\n</table></div>\n");
    }
    out.push_str("</section>\n");
}

/// Failed trials of the same kind and reasons together, in the order of their first seeds.
fn grouped(variant: &Variant) -> Vec<(Vec<u64>, Status, &[String])> {
    let mut groups: Vec<(Vec<u64>, Status, &[String])> = Vec::new();
    for trial in &variant.failed {
        let same = |(_, status, reasons): &&mut (Vec<u64>, Status, &[String])| {
            *status == trial.status && *reasons == trial.failures.as_slice()
        };
        match groups.iter_mut().find(same) {
            Some((seeds, ..)) => seeds.push(trial.seed),
            None => groups.push((vec![trial.seed], trial.status, &trial.failures)),
        }
    }
    groups
}

/// "3 missed, 1 crashed".
fn tally(variant: &Variant) -> String {
    let counts = [Status::Missed, Status::Crashed, Status::Refused].map(|status| {
        let count = variant.failed.iter().filter(|trial| trial.status == status).count();
        (count > 0).then(|| format!("{} {}", number(count as f64), status.as_str()))
    });
    counts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_in_a_row_are_told_by_their_ends() {
        assert_eq!(seeds(&[1, 2, 3, 7, 9, 10]), "1 to 3, 7, 9 to 10");
        assert_eq!(seeds(&[u64::MAX]), u64::MAX.to_string());
    }
}
