//! The file of a recording: written under a temporary name beside its own, renamed when it is complete.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use rerun::sink::FileSink;

use super::RecordingError;

/// Mark of the footer with which a complete file ends.
const FOOTER_MARK: &[u8] = b"FOOT";

/// The footer's mark stands within this many bytes of the end.
const FOOTER_BYTES: i64 = 64;

/// A recording that is being written.
#[derive(Debug)]
pub(super) struct PartialFile {
    wanted: PathBuf,
    partial: PathBuf,
}

impl PartialFile {
    /// Creates the temporary file: `run.rrd` is written as `run.partial.rrd`, which a viewer opens too.
    pub(super) fn create(wanted: &Path) -> Result<(Self, FileSink), RecordingError> {
        let refuse = |reason: String| RecordingError::File { path: wanted.to_owned(), reason };
        if wanted.is_dir() {
            return Err(refuse("it is a folder".into()));
        }
        let partial = partial_name(wanted).ok_or_else(|| refuse("it names no file".into()))?;
        // the library's message repeats the path: ask the system itself first
        File::create(&partial).map_err(|error| refuse(error.to_string()))?;
        let sink = FileSink::new(&partial).map_err(|error| refuse(error.to_string()))?;
        Ok((Self { wanted: wanted.to_owned(), partial }, sink))
    }

    /// Gives the complete file its name; what is not complete keeps the temporary one. Returns path and size.
    pub(super) fn finish(self, flushed: Result<(), String>) -> (PathBuf, Option<u64>, Option<String>) {
        let complete = flushed.and_then(|()| check_footer(&self.partial));
        let named =
            complete.and_then(|()| std::fs::rename(&self.partial, &self.wanted).map_err(|error| error.to_string()));
        let (path, warning) = match named {
            Ok(()) => (self.wanted, None),
            Err(reason) => {
                let kept = self.partial.display();
                let warning = format!("recording: not complete: {reason}; what was written is kept ({kept})");
                (self.partial, Some(warning))
            }
        };
        let bytes = std::fs::metadata(&path).ok().map(|data| data.len());
        (path, bytes, warning)
    }
}

fn partial_name(wanted: &Path) -> Option<PathBuf> {
    let mut name = wanted.file_stem()?.to_os_string();
    name.push(".partial");
    if let Some(ending) = wanted.extension() {
        name.push(".");
        name.push(ending);
    }
    Some(wanted.with_file_name(name))
}

/// The writer's last error is not told: a full disk shows as a missing footer.
fn check_footer(path: &Path) -> Result<(), String> {
    let mut tail = Vec::new();
    let read = File::open(path).and_then(|mut file| {
        let length = file.metadata()?.len();
        let back = FOOTER_BYTES.min(i64::try_from(length).unwrap_or(FOOTER_BYTES));
        file.seek(SeekFrom::End(-back))?;
        file.read_to_end(&mut tail)
    });
    read.map_err(|error| error.to_string())?;
    if tail.windows(FOOTER_MARK.len()).any(|window| window == FOOTER_MARK) {
        Ok(())
    } else {
        Err("the file lacks its footer; is the disk full?".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_temporary_name_keeps_folder_and_ending() {
        assert_eq!(partial_name(Path::new("out/run.rrd")), Some(PathBuf::from("out/run.partial.rrd")));
        assert_eq!(partial_name(Path::new("run")), Some(PathBuf::from("run.partial")));
        assert_eq!(partial_name(Path::new("/")), None);
    }

    #[test]
    fn a_file_without_footer_keeps_its_temporary_name() {
        let folder = tempfile::tempdir().unwrap();
        let wanted = folder.path().join("run.rrd");
        let file = PartialFile { wanted: wanted.clone(), partial: folder.path().join("run.partial.rrd") };
        std::fs::write(&file.partial, b"RRF2 cut short").unwrap();
        let (path, bytes, warning) = file.finish(Ok(()));
        assert_eq!((path, bytes), (folder.path().join("run.partial.rrd"), Some(14)));
        assert!(warning.unwrap().contains("footer"));
        assert!(!wanted.exists());
    }

    #[test]
    fn a_failed_flush_keeps_the_temporary_name() {
        let folder = tempfile::tempdir().unwrap();
        let wanted = folder.path().join("run.rrd");
        let file = PartialFile { wanted: wanted.clone(), partial: folder.path().join("run.partial.rrd") };
        std::fs::write(&file.partial, b"RRF2 ... FOOT").unwrap();
        let (_, _, warning) = file.finish(Err("no space left on device".into()));
        assert!(warning.unwrap().contains("no space left"));
        assert!(!wanted.exists());
    }
}
