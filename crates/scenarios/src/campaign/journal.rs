//! Journals: a line of JSON for every run that ended, written the moment it does.
//!
//! A line is written whole or not at all, as far as the system allows: what a kill leaves of the last one is not counted
//! when the journal is read. Every process writes a journal of its own.

use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

use super::{Row, Shard};

/// The journal that a process is writing.
#[derive(Debug)]
pub struct Journal {
    file: File,
    path: PathBuf,
    /// Bytes of the lines that are whole.
    whole: u64,
}

impl Journal {
    /// Begins a journal in `folder`; no other process writes to it.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn begin(folder: &Path, shard: Shard) -> io::Result<Self> {
        std::fs::create_dir_all(folder)?;
        for attempt in 0.. {
            let path = folder.join(format!("{}of{}-{attempt}.jsonl", shard.index, shard.count));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok(Self { file, path, whole: 0 }),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::ErrorKind::AlreadyExists.into())
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends a row.
    ///
    /// # Errors
    /// If it cannot be written, on a full disk for example; what was written of its line is then taken back.
    pub fn append(&mut self, row: &Row) -> io::Result<()> {
        let mut line = serde_json::to_vec(row)?;
        line.push(b'\n');
        match self.file.write_all(&line) {
            Ok(()) => {
                self.whole += line.len() as u64;
                Ok(())
            }
            Err(error) => {
                // if that fails too, the reader passes over the broken line
                let _ = self.file.set_len(self.whole);
                Err(error)
            }
        }
    }
}

/// Reads a journal, row by row.
#[derive(Debug)]
pub struct JournalReader {
    lines: BufReader<File>,
    /// Byte at which the next line begins.
    at: u64,
}

impl JournalReader {
    /// Opens a journal.
    ///
    /// # Errors
    /// If it cannot be opened.
    pub fn open(path: &Path) -> io::Result<Self> {
        Ok(Self { lines: BufReader::new(File::open(path)?), at: 0 })
    }

    /// The next row, with the byte at which its line begins; `None` at the end, or at a line that was cut off.
    ///
    /// # Errors
    /// If the file cannot be read, or if a line that is not the last is no row.
    pub fn next_row(&mut self) -> io::Result<Option<(u64, Row)>> {
        let mut line = Vec::new();
        let at = self.at;
        self.at += self.lines.read_until(b'\n', &mut line)? as u64;
        if line.pop() != Some(b'\n') {
            return Ok(None);
        }
        match serde_json::from_slice(&line) {
            Ok(row) => Ok(Some((at, row))),
            Err(error) => {
                let problem =
                    format!("found no row at byte {at} ({error}); mend that line, or remove it to make its run again");
                Err(io::Error::new(io::ErrorKind::InvalidData, problem))
            }
        }
    }
}
