//! The folder of one run: it is written beside, under a temporary name, and takes its place when the run has ended.
//!
//! What an earlier run left stays until then: a run that is refused or killed takes nothing away.

use std::fs::{File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use crate::files::remove_if_present;

/// Name of the result's file.
pub const OUTCOME: &str = "outcome.json";
/// Name of the scenario with all defaults written out.
pub const SCENARIO: &str = "scenario.toml";
/// Name of the recording.
pub const RECORDING: &str = "recording.rrd";
/// Name of the table of the state at every control instant.
pub const TELEMETRY: &str = "telemetry.parquet";
/// Name of a recording that did not come to its end.
const CUT_SHORT: &str = "recording.partial.rrd";
/// What a run may leave.
const FILES: [&str; 5] = [OUTCOME, SCENARIO, RECORDING, CUT_SHORT, TELEMETRY];
/// Held for as long as a run writes.
const LOCK: &str = "lock";

/// A run's folder while it is written.
#[derive(Debug)]
pub struct SeedFolder {
    folder: PathBuf,
    partial: PathBuf,
    lock: File,
}

impl SeedFolder {
    /// Begins to write what is to be `folder`; what a killed run left half-made is removed.
    ///
    /// # Errors
    /// If the folder cannot be written, or if another run is writing it: [`io::ErrorKind::ResourceBusy`].
    pub fn begin(folder: &Path) -> io::Result<Self> {
        let mut name = folder.file_name().unwrap_or_default().to_os_string();
        name.push(".partial");
        let partial = folder.with_file_name(name);
        std::fs::create_dir_all(&partial)?;
        let lock = File::create(partial.join(LOCK))?;
        // a file system that knows no locks, as some network ones, is written all the same
        if let Err(TryLockError::WouldBlock) = lock.try_lock() {
            let reason = "another run is writing it; give this one another --out";
            return Err(io::Error::new(io::ErrorKind::ResourceBusy, reason));
        }
        FILES.iter().try_for_each(|name| remove_if_present(&partial.join(name)))?;
        Ok(Self { folder: folder.to_owned(), partial, lock })
    }

    /// Where the run's files are until it has ended.
    pub fn partial(&self) -> &Path {
        &self.partial
    }

    /// Puts the run's files in the place of those of an earlier run.
    ///
    /// # Errors
    /// If the folder cannot be written.
    pub fn finish(self) -> io::Result<()> {
        std::fs::create_dir_all(&self.folder)?;
        for name in FILES {
            let (made, wanted) = (self.partial.join(name), self.folder.join(name));
            match std::fs::rename(&made, &wanted) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => remove_if_present(&wanted)?,
                result => result?,
            }
        }
        self.forget();
        Ok(())
    }

    /// Removes what the run has made so far; what cannot be removed stays.
    pub fn forget(self) {
        for name in FILES.iter().chain([&LOCK]) {
            let _ = remove_if_present(&self.partial.join(name));
        }
        let _ = std::fs::remove_dir(&self.partial);
        drop(self.lock);
    }

    /// A text in which the run's files are named where they are in the end.
    pub fn renamed(&self, text: &str) -> String {
        text.replace(&self.partial.display().to_string(), &self.folder.display().to_string())
    }
}

/// Seeds whose folders are in `out`, but for `these`: an earlier call with more trials left them.
pub fn other_seeds(out: &Path, these: std::ops::Range<u64>) -> Vec<u64> {
    let entries = std::fs::read_dir(out).into_iter().flatten().flatten();
    let seed = |entry: std::fs::DirEntry| entry.file_name().to_str()?.strip_prefix("seed-")?.parse::<u64>().ok();
    let mut others: Vec<u64> = entries.filter_map(seed).filter(|seed| !these.contains(seed)).collect();
    others.sort_unstable();
    others
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn files_of_an_earlier_run_stay_until_this_one_has_ended() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("seed-1");
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(folder.join(OUTCOME), "old").unwrap();
        std::fs::write(folder.join(RECORDING), "old").unwrap();
        std::fs::write(folder.join("notes.txt"), "mine").unwrap();
        SeedFolder::begin(&folder).unwrap().forget();
        assert_eq!(names(root.path()), ["seed-1"]);
        assert_eq!(names(&folder), ["notes.txt", OUTCOME, RECORDING]);

        let run = SeedFolder::begin(&folder).unwrap();
        std::fs::write(run.partial().join(OUTCOME), "new").unwrap();
        assert_eq!(std::fs::read(folder.join(OUTCOME)).unwrap(), b"old");
        run.finish().unwrap();
        assert_eq!(std::fs::read(folder.join(OUTCOME)).unwrap(), b"new");
        // the recording told of the earlier run; what the program does not write is not its own
        assert_eq!(names(&folder), ["notes.txt", OUTCOME]);
        assert_eq!(names(root.path()), ["seed-1"]);
    }

    #[test]
    fn two_runs_cannot_write_one_folder_and_a_killed_one_does_not_keep_it() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("seed-1");
        let first = SeedFolder::begin(&folder).unwrap();
        assert_eq!(SeedFolder::begin(&folder).unwrap_err().kind(), io::ErrorKind::ResourceBusy);
        std::fs::write(first.partial().join(SCENARIO), "half").unwrap();
        drop(first);
        let second = SeedFolder::begin(&folder).unwrap();
        assert_eq!(names(second.partial()), [LOCK]);
    }

    #[test]
    fn seeds_of_earlier_calls_are_found() {
        let root = tempfile::tempdir().unwrap();
        for name in ["seed-1", "seed-12", "seed-3", "seed-3.partial", "seeds", "trials.json"] {
            std::fs::create_dir(root.path().join(name)).unwrap();
        }
        assert_eq!(other_seeds(root.path(), 1..3), [3, 12]);
        assert!(other_seeds(&root.path().join("none"), 1..3).is_empty());
    }
}
