//! From the rows of a campaign to the comparison.

use super::differences::{difference, successes};
use super::result::{
    COMPARISON_SCHEMA, ComparedMeasure, Comparison, FailedTrial, Limits, Spread, SuccessDifference, Variant,
};
use super::{Difference, Verdict};
use crate::campaign::{Manifest, Row};
use crate::outcome::{Limit, Measure};
use crate::statistics::{Location, holm, wilson};
use crate::suggest::did_you_mean;
use crate::trials::{Status, independent};

/// A measure that was asked for and that no run has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("--measure {name}: no run has this measure; expected one of {}{}", known.join(", "), meant(name, known))]
pub struct UnknownMeasure {
    /// What was asked for.
    pub name: String,
    /// What there is.
    pub known: Vec<String>,
}

fn meant(name: &str, known: &[String]) -> String {
    did_you_mean(name, known).map_or_else(String::new, |meant| format!("; {meant}"))
}

/// Finds out from the first runs of all variants whether each measure in `asked` is one that runs have.
///
/// Which measures a run has is told by its scenario alone, if it was simulated to its end. If one of `first` was not, a
/// measure that the others do not have may still be there under other seeds: nothing is known then.
///
/// # Errors
/// An [`UnknownMeasure`].
pub fn check_measures(first: &[&Row], asked: &[String]) -> Result<(), UnknownMeasure> {
    if first.iter().any(|row| row.trajectory_digest.is_none()) {
        return Ok(());
    }
    first_unknown(&known_measures(first.iter().copied()), asked)
}

fn known_measures<'a>(rows: impl Iterator<Item = &'a Row>) -> Vec<&'a Measure> {
    let mut known: Vec<&Measure> = Vec::new();
    for measure in rows.flat_map(|row| &row.measures) {
        if known.iter().all(|other| other.name != measure.name) {
            known.push(measure);
        }
    }
    known
}

fn first_unknown(known: &[&Measure], asked: &[String]) -> Result<(), UnknownMeasure> {
    let unknown = asked.iter().find(|name| known.iter().all(|measure| measure.name != **name));
    unknown.map_or(Ok(()), |name| {
        let known = known.iter().map(|measure| measure.name.clone()).collect();
        Err(UnknownMeasure { name: name.clone(), known })
    })
}

/// Compares the runs of a campaign whose manifest holds the variants one after the other, each with the same seeds.
///
/// `rows` are those of the manifest's runs, in their order; `names` those of the variants. Measures that some run was
/// judged by are compared, and those in `asked`.
///
/// # Errors
/// An [`UnknownMeasure`].
pub fn compare(
    manifest: &Manifest,
    title: &str,
    rows: &[Row],
    names: &[String],
    asked: &[String],
) -> Result<Comparison, UnknownMeasure> {
    let per_variant = (manifest.runs.len() / names.len().max(1)).max(1);
    let groups: Vec<&[Row]> = rows.chunks(per_variant).collect();
    let seeds: Vec<u64> = manifest.runs.iter().take(per_variant).map(|run| run.seed).collect();
    let changes = manifest.runs.chunks(per_variant).map(|runs| runs.first().map(|run| manifest.changes(run)));
    let variants = names
        .iter()
        .zip(&groups)
        .zip(changes)
        .map(|((name, rows), changes)| Variant { changes: changes.unwrap_or_default(), ..variant(name, rows) });
    let chosen = chosen(rows, asked)?;
    Ok(Comparison {
        schema: COMPARISON_SCHEMA.into(),
        version: manifest.base.version.clone(),
        scenario: manifest.base.scenario.clone(),
        title: title.to_owned(),
        task: manifest.base.task.clone(),
        variants: variants.collect(),
        success: compared_successes(&groups),
        measures: chosen.into_iter().map(|measure| compared(measure, &groups, &seeds)).collect(),
        seeds,
    })
}

/// How many of a variant's trials tell something of their own.
fn independent_trials(rows: &[Row]) -> usize {
    independent(rows.iter().map(|row| row.trajectory_digest.as_deref()))
}

fn variant(name: &str, rows: &[Row]) -> Variant {
    let successes = rows.iter().filter(|row| row.status == Status::Success).count();
    let trials = independent_trials(rows);
    let failed = rows.iter().filter(|row| row.status != Status::Success);
    Variant {
        name: name.to_owned(),
        changes: Vec::new(),
        statuses: rows.iter().map(|row| row.status).collect(),
        successes,
        success_rate: if rows.is_empty() { 0.0 } else { successes as f64 / rows.len() as f64 },
        success_interval_95: wilson(successes.min(trials), trials),
        independent_trials: trials,
        failed: failed
            .map(|row| FailedTrial { seed: row.seed, status: row.status, failures: row.failures.clone() })
            .collect(),
    }
}

/// The measures to be compared, in the order in which runs state them.
fn chosen<'a>(rows: &'a [Row], asked: &[String]) -> Result<Vec<&'a Measure>, UnknownMeasure> {
    let known = known_measures(rows.iter());
    first_unknown(&known, asked)?;
    let mut judged: Vec<&str> = Vec::new();
    for measure in rows.iter().flat_map(|row| &row.measures) {
        if measure.limit.is_some() && !judged.contains(&measure.name.as_str()) {
            judged.push(&measure.name);
        }
    }
    let wanted = |measure: &&Measure| judged.contains(&measure.name.as_str()) || asked.contains(&measure.name);
    Ok(known.into_iter().filter(wanted).collect())
}

fn compared_successes(groups: &[&[Row]]) -> Vec<SuccessDifference> {
    let Some((first, others)) = groups.split_first() else { return Vec::new() };
    // two variants of which every trial is the same run are one pair, however often they were run
    let pairs = |rows: &[Row]| independent_trials(first).max(independent_trials(rows)).min(first.len());
    let of = |(index, rows): (usize, &&[Row])| {
        let pairs = pairs(rows);
        successes(index + 1, first.get(..pairs).unwrap_or(first), rows)
    };
    let mut all: Vec<SuccessDifference> = others.iter().enumerate().map(of).collect();
    let corrected = holm(&all.iter().map(|found| found.p).collect::<Vec<_>>());
    let family = all.len();
    for (found, p) in all.iter_mut().zip(corrected) {
        found.corrected_p = p;
        let count = found.both + found.only_first + found.only_this + found.neither;
        found.verdict = Verdict::of(p, count, family);
    }
    all
}

fn compared(measure: &Measure, groups: &[&[Row]], seeds: &[u64]) -> ComparedMeasure {
    let limit = limits(&measure.name, groups);
    let values = |rows: &&[Row]| rows.iter().map(|row| row.value(&measure.name)).collect::<Vec<_>>();
    let columns: Vec<Vec<Option<f64>>> = groups.iter().map(values).collect();
    let others = columns.iter().enumerate().skip(1);
    let first = columns.first().map_or(&[][..], Vec::as_slice);
    let trials: Vec<usize> = groups.iter().map(|rows| independent_trials(rows)).collect();
    let own = |variant: usize| trials.get(variant).copied().unwrap_or_default();
    let mut differences: Vec<Difference> = others
        .map(|(variant, values)| {
            // zip ends with the shortest: trials that are all the same run are one pair
            let pairs = own(0).max(own(variant));
            difference(variant, first, values, seeds.get(..pairs).unwrap_or(seeds))
        })
        .collect();
    correct(&mut differences, limit);
    ComparedMeasure {
        name: measure.name.clone(),
        label: measure.label.clone(),
        unit: measure.unit.clone(),
        limit,
        differences,
        variants: columns.into_iter().map(spread).collect(),
    }
}

fn spread(values: Vec<Option<f64>>) -> Spread {
    let location = Location::of(&values.iter().copied().flatten().collect::<Vec<_>>());
    Spread { values, location }
}

/// Corrects the probabilities of one measure's differences for their number, and judges them.
fn correct(differences: &mut [Difference], limit: Limits) {
    let family = differences.len();
    // a variant without pairs belongs to the family: it was looked at
    let all: Vec<f64> = differences.iter().map(|found| found.test.map_or(1.0, |test| test.p)).collect();
    for (found, p) in differences.iter_mut().zip(holm(&all)) {
        let Some(test) = found.test else { continue };
        found.corrected_p = Some(p);
        found.verdict = Verdict::of(p, test.pairs, family);
        found.better = match limit.same().filter(|_| found.verdict == Verdict::Real && test.estimate != 0.0) {
            Some(Limit::AtMost(_)) => Some(test.estimate < 0.0),
            Some(Limit::AtLeast(_)) => Some(test.estimate > 0.0),
            None => None,
        };
    }
}

/// What the runs were asked to keep of a measure.
fn limits(name: &str, groups: &[&[Row]]) -> Limits {
    let same = |measure: &&Measure| measure.name == name;
    let mut stated = groups.iter().flat_map(|rows| rows.iter()).flat_map(|row| row.measures.iter().filter(same));
    let first = stated.next().and_then(|measure| measure.limit);
    match (first, stated.all(|measure| measure.limit == first)) {
        (Some(limit), true) => Limits::Same(limit),
        (None, true) => Limits::None,
        (_, false) => Limits::Various,
    }
}

#[cfg(test)]
#[path = "build_tests.rs"]
mod tests;
