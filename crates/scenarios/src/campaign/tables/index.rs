//! Where the row of each finished run stands, so that tables can be written by index without holding all rows.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Seek};
use std::path::{Path, PathBuf};

use crate::campaign::{CampaignFolder, FolderError, Manifest, Row};
use crate::outcome::{Limit, Measure};

/// The finished runs of a campaign.
pub(super) struct RowIndex<'a> {
    manifest: &'a Manifest,
    journals: Vec<PathBuf>,
    /// For each planned run the journal and the byte at which its row begins, if it is done.
    places: Vec<Option<(usize, u64)>>,
    /// What is measured, by name.
    measures: BTreeMap<String, Measured>,
}

/// What the rows say of a measure.
pub(super) struct Measured {
    /// The smallest index of a run that has it, and its place there.
    first: (u64, usize),
    /// Name, label and unit.
    pub measure: Measure,
    /// The limit, if it is the same in all runs.
    pub limit: Option<Limit>,
}

impl<'a> RowIndex<'a> {
    /// Looks through all journals; two copies of a run must be equal.
    pub fn of(folder: &CampaignFolder, manifest: &'a Manifest) -> Result<Self, FolderError> {
        let places = vec![None; manifest.runs.len()];
        let mut index = Self { manifest, journals: Vec::new(), places, measures: BTreeMap::new() };
        folder.rows(&mut |path, at, row| index.enter(folder, path, at, &row))?;
        Ok(index)
    }

    fn enter(&mut self, folder: &CampaignFolder, path: &Path, at: u64, row: &Row) -> Result<(), FolderError> {
        let planned = usize::try_from(row.index).ok().filter(|&index| {
            self.manifest.runs.get(index).is_some_and(|run| run.run_id == row.run_id && run.seed == row.seed)
        });
        let Some((planned, place)) = planned.and_then(|index| Some((index, self.places.get(index)?))) else {
            return Err(FolderError::Stranger { path: path.to_owned(), run_id: row.run_id.to_string() });
        };
        if let Some((journal, at)) = *place {
            let path = self.journals.get(journal).cloned().unwrap_or_default();
            let first = read_row(&path, at).map_err(|source| FolderError::Io { path, source })?;
            return match first == *row {
                true => Ok(()),
                false => Err(contradiction(folder, &first, row)),
            };
        }
        if self.journals.last().is_none_or(|last| last != path) {
            self.journals.push(path.to_owned());
        }
        if let Some(place) = self.places.get_mut(planned) {
            *place = Some((self.journals.len() - 1, at));
        }
        for (place, measure) in row.measures.iter().enumerate() {
            let first = (row.index, place);
            let known = self.measures.entry(measure.name.clone()).or_insert_with(|| Measured {
                first,
                measure: measure.clone(),
                limit: measure.limit,
            });
            known.limit = known.limit.filter(|limit| Some(*limit) == measure.limit);
            if first < known.first {
                (known.first, known.measure) = (first, measure.clone());
            }
        }
        Ok(())
    }

    /// Number of finished runs.
    pub fn len(&self) -> usize {
        self.places.iter().flatten().count()
    }

    /// The measures, in the order in which the first runs have them.
    pub fn measures(&self) -> Vec<&Measured> {
        let mut measures: Vec<&Measured> = self.measures.values().collect();
        measures.sort_by_key(|measured| measured.first);
        measures
    }

    /// Reads the rows by index.
    pub fn reader(&self) -> RowReader<'_> {
        RowReader { index: self, next: 0, open: None }
    }
}

fn contradiction(folder: &CampaignFolder, first: &Row, second: &Row) -> FolderError {
    let what = if first.version != second.version {
        format!("one by version {}, one by {}", first.version, second.version)
    } else {
        format!("{} and {}", first.status.as_str(), second.status.as_str())
    };
    FolderError::Contradiction { path: folder.path().to_owned(), index: first.index, what }
}

fn read_row(path: &Path, at: u64) -> io::Result<Row> {
    row_at(&mut BufReader::new(File::open(path)?), at)
}

fn row_at(journal: &mut BufReader<File>, at: u64) -> io::Result<Row> {
    // within what is buffered this costs nothing
    let here = journal.stream_position()?;
    journal.seek_relative(at.cast_signed() - here.cast_signed())?;
    let mut line = Vec::new();
    journal.read_until(b'\n', &mut line)?;
    Ok(serde_json::from_slice(&line)?)
}

/// Reads rows by index.
pub(super) struct RowReader<'a> {
    index: &'a RowIndex<'a>,
    next: usize,
    /// The journal that was read last.
    open: Option<(usize, BufReader<File>)>,
}

impl RowReader<'_> {
    /// The next rows, at most `count`; none at the end.
    pub fn batch(&mut self, count: usize) -> io::Result<Vec<Row>> {
        let mut rows = Vec::new();
        while rows.len() < count {
            let Some(place) = self.index.places.get(self.next) else { break };
            self.next += 1;
            let Some((journal, at)) = *place else { continue };
            rows.push(self.row(journal, at)?);
        }
        Ok(rows)
    }

    fn row(&mut self, journal: usize, at: u64) -> io::Result<Row> {
        if self.open.as_ref().is_none_or(|(open, _)| *open != journal) {
            let path = self.index.journals.get(journal).ok_or(io::ErrorKind::NotFound)?;
            self.open = Some((journal, BufReader::new(File::open(path)?)));
        }
        match &mut self.open {
            Some((_, open)) => row_at(open, at),
            None => Err(io::ErrorKind::NotFound.into()),
        }
    }
}
