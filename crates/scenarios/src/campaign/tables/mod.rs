//! Tables of a campaign: one row for each run that ended, by index, as Parquet, CSV or lines of JSON.
//!
//! They are made from the journals and hold no clock time, so that equal runs give equal bytes however they were divided
//! among threads, processes and machines.

mod columns;
mod delimited;
mod index;
mod json_lines;
mod parquet;

use std::fs::File;
use std::io;
use std::path::PathBuf;
use std::str::FromStr;

use super::{CampaignFolder, FolderError, Manifest, Row};
use crate::files::write_with;

use columns::{Column, columns};
use index::RowIndex;

/// Rows that are held in memory at once.
const BATCH: usize = 64;

/// A format of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// Apache Parquet, `results.parquet`.
    Parquet,
    /// Comma-separated values, `results.csv`.
    Csv,
    /// One JSON object in a line, `results.jsonl`.
    Jsonl,
}

impl TableFormat {
    /// All formats.
    pub const ALL: [Self; 3] = [Self::Parquet, Self::Csv, Self::Jsonl];

    /// Ending of its files.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Parquet => "parquet",
            Self::Csv => "csv",
            Self::Jsonl => "jsonl",
        }
    }

    fn write(self, manifest: &Manifest, columns: &[Column], rows: Rows<'_>, file: &mut File) -> io::Result<()> {
        match self {
            Self::Parquet => parquet::write(manifest, columns, rows, file),
            Self::Csv => delimited::write(columns, rows, file),
            Self::Jsonl => json_lines::write(columns, rows, file),
        }
    }
}

impl FromStr for TableFormat {
    type Err = String;

    /// Reads a format by the ending of its files.
    ///
    /// # Errors
    /// In words.
    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|format| format.extension() == text);
        found.ok_or_else(|| format!("found {text:?}; expected parquet, csv or jsonl"))
    }
}

/// Hands out rows by index, [`BATCH`] at most at a time; none at the end.
type Rows<'a> = &'a mut dyn FnMut() -> io::Result<Vec<Row>>;

/// Writes the table of a campaign's finished runs in each of `formats`, and returns the number of rows and the files.
///
/// # Errors
/// A [`FolderError`] if journals cannot be read, if two copies of a run differ, or if a file cannot be written: the
/// tables that were there are then untouched.
pub fn write_tables(
    folder: &CampaignFolder,
    manifest: &Manifest,
    formats: &[TableFormat],
) -> Result<(usize, Vec<PathBuf>), FolderError> {
    let index = RowIndex::of(folder, manifest)?;
    let columns = columns(manifest, &index);
    let mut files = Vec::new();
    for format in formats {
        let path = folder.path().join(format!("results.{}", format.extension()));
        let io = |source| FolderError::Io { path: path.clone(), source };
        let mut reader = index.reader();
        let mut rows = || reader.batch(BATCH);
        write_with(&path, |file| format.write(manifest, &columns, &mut rows, file)).map_err(io)?;
        files.push(path);
    }
    Ok((index.len(), files))
}
