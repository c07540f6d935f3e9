//! The folder of a campaign: what is where in it, and what of it is done.

use std::io;
use std::path::{Path, PathBuf};

use super::{JournalReader, Manifest, ManifestError, Row};
use crate::assets::stems;
use crate::files::{prepare_folder, write_whole};

/// Name of the manifest.
const MANIFEST: &str = "manifest.jsonl";
/// Name of the folder of journals.
const JOURNALS: &str = "journal";

/// The folder of a campaign.
#[derive(Clone, Debug)]
pub struct CampaignFolder {
    path: PathBuf,
}

/// Why a campaign's folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// Its manifest cannot be read.
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    /// It holds another campaign.
    #[error("{} holds another campaign ({difference}); name another folder with --out, or remove it", path.display())]
    Other {
        /// The folder.
        path: PathBuf,
        /// In what they differ.
        difference: String,
    },
    /// Two copies of a run differ, which the same program never does.
    #[error("{}: run {index} was made twice, with different results: {what}", path.display())]
    Contradiction {
        /// The folder.
        path: PathBuf,
        /// Index of the run.
        index: u64,
        /// In what they differ.
        what: String,
    },
    /// A row belongs to no planned run.
    #[error("{}: found the row of run {run_id}; expected one of the manifest's", path.display())]
    Stranger {
        /// The journal.
        path: PathBuf,
        /// Identity of the run.
        run_id: String,
    },
    /// A run is no longer what was planned.
    #[error("run {index}: {reason}")]
    Changed {
        /// Index of the run.
        index: u64,
        /// What changed.
        reason: String,
    },
    /// The file system refused.
    #[error("{}: {source}", path.display())]
    Io {
        /// File or folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

impl CampaignFolder {
    /// The campaign's folder at `path`, whether it is there or not.
    #[must_use]
    pub fn at(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into() }
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where its journals are.
    #[must_use]
    pub fn journals(&self) -> PathBuf {
        self.path.join(JOURNALS)
    }

    /// Whether there is a campaign in it.
    #[must_use]
    pub fn exists(&self) -> bool {
        self.path.join(MANIFEST).exists()
    }

    /// Reads its manifest.
    ///
    /// # Errors
    /// A [`FolderError`].
    pub fn manifest(&self) -> Result<Manifest, FolderError> {
        Ok(Manifest::read(&self.path.join(MANIFEST))?)
    }

    /// Writes `manifest` into it, or makes sure that the one which is there says the same.
    ///
    /// # Errors
    /// A [`FolderError`] if it holds another campaign or cannot be written.
    pub fn prepare(&self, manifest: &Manifest) -> Result<(), FolderError> {
        if self.exists() {
            let there = self.manifest()?;
            return match difference(&there, manifest) {
                None => Ok(()),
                Some(difference) => Err(FolderError::Other { path: self.path.clone(), difference }),
            };
        }
        let io = |source| FolderError::Io { path: self.path.clone(), source };
        prepare_folder(&self.path).map_err(io)?;
        let mut bytes = Vec::new();
        manifest.write(&mut bytes).map_err(io)?;
        write_whole(&self.path.join(MANIFEST), &bytes).map_err(io)
    }

    /// Calls `each` for every row of every journal, with the journal and the byte at which the row begins.
    ///
    /// # Errors
    /// A [`FolderError`], that of `each` too.
    pub fn rows(&self, each: &mut dyn FnMut(&Path, u64, Row) -> Result<(), FolderError>) -> Result<(), FolderError> {
        let folder = self.journals();
        for name in stems(&folder, "jsonl") {
            let path = folder.join(format!("{name}.jsonl"));
            let io = |source| FolderError::Io { path: path.clone(), source };
            let mut journal = JournalReader::open(&path).map_err(io)?;
            while let Some((at, row)) = journal.next_row().map_err(io)? {
                each(&path, at, row)?;
            }
        }
        Ok(())
    }

    /// Copies the journals of another folder of the same campaign into this one.
    ///
    /// # Errors
    /// A [`FolderError`] if a file cannot be read or written.
    pub fn take_in(&self, other: &Self) -> Result<(), FolderError> {
        let (from, to) = (other.journals(), self.journals());
        let io = |path: &Path| {
            let path = path.to_owned();
            move |source| FolderError::Io { path, source }
        };
        std::fs::create_dir_all(&to).map_err(io(&to))?;
        for name in stems(&from, "jsonl") {
            let path = from.join(format!("{name}.jsonl"));
            let bytes = std::fs::read(&path).map_err(io(&path))?;
            // named by their content, so that taking them in twice is taking them in once
            let digest = blake3::hash(&bytes).to_hex();
            let copy = to.join(format!("taken-{}.jsonl", &digest[..16]));
            write_whole(&copy, &bytes).map_err(io(&copy))?;
        }
        Ok(())
    }

    /// The rows of the runs that ended, by index.
    ///
    /// # Errors
    /// A [`FolderError`] if a journal cannot be read or tells of other runs, or if two copies of a run differ.
    pub fn ordered_rows(&self, manifest: &Manifest) -> Result<Vec<Row>, FolderError> {
        let mut rows: Vec<Option<Row>> = vec![None; manifest.runs.len()];
        self.rows(&mut |path, _, row| {
            let index = usize::try_from(row.index)
                .ok()
                .filter(|&index| manifest.runs.get(index).is_some_and(|run| run.run_id == row.run_id));
            let stranger = || FolderError::Stranger { path: path.to_owned(), run_id: row.run_id.to_string() };
            let place = index.and_then(|index| rows.get_mut(index)).ok_or_else(stranger)?;
            match place {
                Some(other) if *other != row => {
                    let what = format!("{} and {}", other.status.as_str(), row.status.as_str());
                    Err(FolderError::Contradiction { path: self.path.clone(), index: row.index, what })
                }
                place => {
                    *place = Some(row);
                    Ok(())
                }
            }
        })?;
        Ok(rows.into_iter().flatten().collect())
    }

    /// The row of a run, if it is done.
    ///
    /// # Errors
    /// A [`FolderError`] if a journal cannot be read.
    pub fn row(&self, index: u64) -> Result<Option<Row>, FolderError> {
        let mut found = None;
        self.rows(&mut |_, _, row| {
            if row.index == index {
                found = Some(row);
            }
            Ok(())
        })?;
        Ok(found)
    }

    /// Which runs of `manifest` are done, by index.
    ///
    /// # Errors
    /// A [`FolderError`] if a journal cannot be read or tells of other runs.
    pub fn done(&self, manifest: &Manifest) -> Result<Vec<bool>, FolderError> {
        let mut done = vec![false; manifest.runs.len()];
        self.rows(&mut |path, _, row| {
            let planned = usize::try_from(row.index).ok().and_then(|index| Some((index, manifest.runs.get(index)?)));
            match planned.filter(|(_, run)| run.run_id == row.run_id).and_then(|(index, _)| done.get_mut(index)) {
                Some(mark) => *mark = true,
                None => return Err(FolderError::Stranger { path: path.to_owned(), run_id: row.run_id.to_string() }),
            }
            Ok(())
        })?;
        Ok(done)
    }
}

/// In what two manifests differ, if in anything that matters to results.
fn difference(there: &Manifest, here: &Manifest) -> Option<String> {
    if there.runs.len() != here.runs.len() {
        return Some(format!("it has {} runs, this one {}", there.runs.len(), here.runs.len()));
    }
    let differs = |(there, here): (&super::PlannedRun, &super::PlannedRun)| there.run_id != here.run_id;
    let index = there.runs.iter().zip(&here.runs).position(differs)?;
    Some(format!("run {index} differs: the scenario, a file that it names, or the design was changed"))
}
