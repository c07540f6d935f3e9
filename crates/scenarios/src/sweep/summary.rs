//! What the runs of a campaign say together: how they ended, and what each level of each factor does to that.

use serde::Serialize;
use toml::Value;

use crate::campaign::{CampaignFolder, FolderError, Manifest, Row, Shard};
use crate::statistics::wilson;
use crate::trials::{Status, distinct};

/// Version of the layout of a summary.
pub const SUMMARY_SCHEMA: &str = "wield.sweep/1";

/// A factor with more values than this is not summed up level by level.
const MOST_LEVELS: usize = 12;

/// What the runs of a campaign, or of one shard of it, say together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepSummary {
    /// Version of this layout: [`SUMMARY_SCHEMA`].
    pub schema: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Number of runs that were planned.
    pub planned: usize,
    /// How those that ended did so.
    pub all: LevelSummary,
    /// The same for each level of each factor that has few.
    pub factors: Vec<FactorSummary>,
}

/// A factor, level by level.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FactorSummary {
    /// Its key.
    pub key: String,
    /// Its levels; numbers in increasing order, others as they come first.
    pub levels: Vec<LevelSummary>,
}

/// How the runs of one level ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelSummary {
    /// The value of the factor; `null` for all runs together.
    pub value: Option<Value>,
    /// Runs that ended.
    pub done: usize,
    /// Of these, those that kept all limits.
    pub success: usize,
    /// Those that missed a limit.
    pub missed: usize,
    /// Those that crashed or diverged.
    pub crashed: usize,
    /// Those that make no sense with their seed.
    pub refused: usize,
    /// Those that were not run, because the values of their point make no valid scenario.
    pub invalid: usize,
    /// Wilson's 95 % interval of the share of those that kept all limits, of those that could be run.
    pub success_interval_95: [f64; 2],
    /// The judged measures.
    pub measures: Vec<MeasureSummary>,
}

/// A judged measure over several runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeasureSummary {
    /// Its name.
    pub name: String,
    /// Its unit for people.
    pub unit: String,
    /// Number of runs that have a value.
    pub count: usize,
    /// Median of these.
    pub median: f64,
}

/// What is kept of a row: how it ended, and its judged measures.
struct Ended {
    status: Status,
    digest: Option<String>,
    measures: Vec<(String, String, f64)>,
}

impl Ended {
    fn of(row: Row) -> Self {
        let judged = row.measures.into_iter().filter(|measure| measure.limit.is_some());
        let measures = judged.filter_map(|measure| Some((measure.name, measure.unit, measure.value?))).collect();
        Self { status: row.status, digest: row.trajectory_digest, measures }
    }
}

impl SweepSummary {
    /// Sums up the runs of a shard that are in the journals.
    ///
    /// # Errors
    /// A [`FolderError`] if a journal cannot be read.
    pub fn of(folder: &CampaignFolder, manifest: &Manifest, shard: Shard) -> Result<Self, FolderError> {
        let mut ended: Vec<Option<Ended>> = manifest.runs.iter().map(|_| None).collect();
        folder.rows(&mut |_, _, row| {
            let entry = usize::try_from(row.index).ok().and_then(|index| ended.get_mut(index));
            if let Some(entry) = entry.filter(|_| shard.holds(row.index)) {
                *entry = Some(Ended::of(row));
            }
            Ok(())
        })?;
        let level = |value: Option<Value>, chosen: &dyn Fn(&[Value]) -> bool| {
            let pairs = manifest.runs.iter().zip(&ended).filter(|(run, _)| chosen(&run.values));
            LevelSummary::new(value, &pairs.filter_map(|(_, ended)| ended.as_ref()).collect::<Vec<_>>())
        };
        let factor = |(place, factor): (usize, &crate::campaign::Factor)| {
            let levels = levels(manifest, place)?;
            let summed = |value: Value| level(Some(value.clone()), &|values| values.get(place) == Some(&value));
            Some(FactorSummary { key: factor.key.clone(), levels: levels.into_iter().map(summed).collect() })
        };
        Ok(Self {
            schema: SUMMARY_SCHEMA.into(),
            scenario: manifest.base.scenario.clone(),
            planned: manifest.runs.iter().filter(|run| shard.holds(run.index)).count(),
            all: level(None, &|_| true),
            factors: manifest.base.factors.iter().enumerate().filter_map(factor).collect(),
        })
    }
}

impl LevelSummary {
    fn new(value: Option<Value>, ended: &[&Ended]) -> Self {
        let count = |status| ended.iter().filter(|ended| ended.status == status).count();
        let (success, invalid) = (count(Status::Success), count(Status::Invalid));
        let made = ended.iter().filter(|ended| ended.status != Status::Invalid);
        let (runs, successes) = distinct(made.map(|ended| (ended.digest.as_deref(), ended.status)));
        Self {
            value,
            done: ended.len(),
            success,
            missed: count(Status::Missed),
            crashed: count(Status::Crashed),
            refused: count(Status::Refused),
            invalid,
            success_interval_95: wilson(successes, runs),
            measures: measures(ended),
        }
    }

    /// Runs that ended and could be run at all.
    #[must_use]
    pub fn made(&self) -> usize {
        self.done - self.invalid
    }

    /// Share of the runs that could be made which kept all limits; `None` before the first ended.
    #[must_use]
    pub fn success_rate(&self) -> Option<f64> {
        (self.made() > 0).then(|| self.success as f64 / self.made() as f64)
    }

    /// Number of runs that came to no outcome.
    #[must_use]
    pub fn without_outcome(&self) -> usize {
        self.crashed + self.refused
    }
}

/// The distinct values of the factor at `place`; `None` if they are many.
fn levels(manifest: &Manifest, place: usize) -> Option<Vec<Value>> {
    let mut levels: Vec<Value> = Vec::new();
    for value in manifest.runs.iter().filter_map(|run| run.values.get(place)) {
        if !levels.contains(value) {
            levels.push(value.clone());
        }
        if levels.len() > MOST_LEVELS {
            return None;
        }
    }
    let number = |value: &Value| value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64));
    if levels.iter().all(|value| number(value).is_some()) {
        levels.sort_by(|a, b| number(a).unwrap_or(0.0).total_cmp(&number(b).unwrap_or(0.0)));
    }
    Some(levels)
}

/// Medians of the judged measures, in the order in which they come first.
fn measures(ended: &[&Ended]) -> Vec<MeasureSummary> {
    let mut found: Vec<(&str, &str, Vec<f64>)> = Vec::new();
    for (name, unit, value) in ended.iter().flat_map(|ended| &ended.measures) {
        match found.iter_mut().find(|(other, ..)| other == name) {
            Some((.., values)) => values.push(*value),
            None => found.push((name, unit, vec![*value])),
        }
    }
    let summed = |(name, unit, values): (&str, &str, Vec<f64>)| {
        let (name, unit, count) = (name.to_owned(), unit.to_owned(), values.len());
        Some(MeasureSummary { name, unit, count, median: median(values)? })
    };
    found.into_iter().filter_map(summed).collect()
}

/// The median; between the two in the middle of an even number.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let upper = *values.get(values.len() / 2)?;
    if values.len() % 2 == 1 {
        return Some(upper);
    }
    Some(0.5 * (values.get(values.len() / 2 - 1)? + upper))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::Assets;
    use crate::campaign::{Factor, InvalidPoints, Journal, PlannedRun, plan};
    use crate::outcome::{Limit, Measure};

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(median(vec![]), None);
        assert_eq!(median(vec![3.0, 1.0, 9.0]), Some(3.0));
        assert_eq!(median(vec![4.0, 1.0, 9.0, 2.0]), Some(3.0));
    }

    fn row(run: &PlannedRun, status: Status, error_mm: f64) -> Row {
        let mut row = Row::without_outcome(run, status, String::new(), 1.0);
        row.measures = vec![
            Measure::judged("goal_error_mm", "error", error_mm, "mm", Limit::AtMost(5.0)),
            Measure::reported("force_n", "force", 1.0, "N"),
        ];
        row
    }

    #[test]
    fn each_level_is_summed_up_alone() {
        let project = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        let assets = Assets::at(format!("{project}/assets"));
        let file = std::path::PathBuf::from(format!("{project}/scenarios/push_stick.toml"));
        let scenario = crate::scenario::load(&file, &assets).unwrap();
        let points: Vec<_> =
            [0.4, 0.2].iter().flat_map(|&value| (1..=2).map(move |seed| (vec![Value::Float(value)], seed))).collect();
        let factors = vec![Factor { key: "object.table_friction".into() }];
        let manifest = plan(&scenario, &file, &assets, factors, &points, InvalidPoints::Refuse, &|_| {}).unwrap();
        let root = tempfile::tempdir().unwrap();
        let folder = CampaignFolder::at(root.path());
        folder.prepare(&manifest).unwrap();
        let mut journal = Journal::begin(&folder.journals(), Shard::WHOLE).unwrap();
        let rows = [(0, Status::Missed, 9.0), (1, Status::Success, 3.0), (2, Status::Crashed, 4.0)];
        for (index, status, error_mm) in rows {
            journal.append(&row(&manifest.runs[index], status, error_mm)).unwrap();
        }
        let summary = SweepSummary::of(&folder, &manifest, Shard::WHOLE).unwrap();
        assert_eq!((summary.planned, summary.all.done, summary.all.success, summary.all.crashed), (4, 3, 1, 1));
        let levels = &summary.factors[0].levels;
        let found: Vec<_> = levels.iter().map(|level| (level.value.clone(), level.done, level.success)).collect();
        assert_eq!(found, [(Some(Value::Float(0.2)), 1, 0), (Some(Value::Float(0.4)), 2, 1)]);
        assert_eq!(levels[1].measures.len(), 1, "only what is judged");
        assert_eq!((levels[1].measures[0].count, levels[1].measures[0].median), (2, 6.0));
        // the second of two shards has the runs 1 and 3
        let half = SweepSummary::of(&folder, &manifest, Shard { index: 1, count: 2 }).unwrap();
        assert_eq!((half.planned, half.all.done, half.all.success), (2, 1, 1));
    }
}
