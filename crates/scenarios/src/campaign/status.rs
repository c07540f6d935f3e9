//! How far a campaign is, told from its files alone: never from the word of an engine.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{CampaignFolder, FolderError, Manifest};
use crate::statistics::wilson;
use crate::trials::{Status, distinct};

/// Version of the layout of a progress report.
pub const STATUS_SCHEMA: &str = "wield.status/1";

/// How far a campaign is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CampaignStatus {
    /// Version of this layout: [`STATUS_SCHEMA`].
    pub schema: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Number of planned runs.
    pub planned: usize,
    /// Number of runs that ended.
    pub done: usize,
    /// Of these, how many ended in which way.
    pub success: usize,
    /// A limit was missed.
    pub missed: usize,
    /// The run crashed or diverged.
    pub crashed: usize,
    /// The scenario makes no sense with these values.
    pub refused: usize,
    /// The values of the point make no valid scenario: nothing was run.
    pub invalid: usize,
    /// Wilson's 95 % interval of the share of runs that kept all limits, of those that could be run.
    pub success_interval_95: [f64; 2],
    /// Clock time of all runs that ended, s.
    pub wall_s: f64,
    /// The most frequent first failures, with their number.
    pub reasons: Vec<(String, usize)>,
    /// Index of the first runs that are missing, at most ten.
    pub first_missing: Vec<u64>,
}

/// Failures that are listed.
const LISTED: usize = 5;

impl CampaignStatus {
    /// Looks through the journals of a campaign.
    ///
    /// # Errors
    /// A [`FolderError`].
    pub fn of(folder: &CampaignFolder, manifest: &Manifest) -> Result<Self, FolderError> {
        let mut ended: Vec<Option<(Status, Option<String>)>> = vec![None; manifest.runs.len()];
        let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
        let mut wall_s = 0.0;
        folder.rows(&mut |path, _, row| {
            let planned = usize::try_from(row.index).ok().and_then(|index| Some((index, manifest.runs.get(index)?)));
            let known = planned.filter(|(_, run)| run.run_id == row.run_id);
            let Some(mark) = known.and_then(|(index, _)| ended.get_mut(index)) else {
                return Err(FolderError::Stranger { path: path.to_owned(), run_id: row.run_id.to_string() });
            };
            if mark.is_none() {
                wall_s += row.wall_s;
                if let Some(reason) = row.failures.first() {
                    *reasons.entry(without_numbers(reason)).or_default() += 1;
                }
            }
            *mark = Some((row.status, row.trajectory_digest));
            Ok(())
        })?;
        let count = |status| ended.iter().flatten().filter(|(found, _)| *found == status).count();
        let (done, invalid) = (ended.iter().flatten().count(), count(Status::Invalid));
        let made = ended.iter().flatten().filter(|(status, _)| *status != Status::Invalid);
        let (runs, successes) = distinct(made.map(|(status, digest)| (digest.as_deref(), *status)));
        let mut reasons: Vec<(String, usize)> = reasons.into_iter().collect();
        reasons.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        reasons.truncate(LISTED);
        let missing = manifest.runs.iter().zip(&ended).filter(|(_, ended)| ended.is_none());
        Ok(Self {
            schema: STATUS_SCHEMA.into(),
            scenario: manifest.base.scenario.clone(),
            planned: manifest.runs.len(),
            done,
            success: count(Status::Success),
            missed: count(Status::Missed),
            crashed: count(Status::Crashed),
            refused: count(Status::Refused),
            invalid,
            success_interval_95: wilson(successes, runs),
            wall_s,
            reasons,
            first_missing: missing.map(|(run, _)| run.index).take(10).collect(),
        })
    }

    /// Clock time of one run, s; `None` before the first ended.
    #[must_use]
    pub fn wall_per_run_s(&self) -> Option<f64> {
        (self.made() > 0).then(|| self.wall_s / self.made() as f64)
    }

    /// Runs that ended and could be run at all.
    #[must_use]
    pub fn made(&self) -> usize {
        self.done - self.invalid
    }

    /// Runs that have not ended.
    #[must_use]
    pub fn left(&self) -> usize {
        self.planned - self.done
    }
}

/// The words of a failure, its numbers left out, so that equal failures count together.
fn without_numbers(reason: &str) -> String {
    let is_number = |word: &str| {
        let bare = word.trim_matches(|letter: char| "(),;.[]".contains(letter));
        !bare.is_empty() && bare.parse::<f64>().is_ok()
    };
    reason.split(' ').map(|word| if is_number(word) { "…" } else { word }).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_failures_with_other_numbers_count_together() {
        let text = "distance to goal is 12.345 mm; expected at most 5 mm";
        assert_eq!(without_numbers(text), "distance to goal is … mm; expected at most … mm");
        assert_eq!(without_numbers("(0.3, 4)"), "… …");
    }
}
