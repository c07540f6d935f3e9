//! Writing files: under a temporary name in the same folder, then renamed, so that no half-written file is ever seen.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Writes `bytes` to `path`, replacing what stood there.
///
/// # Errors
/// If the folder cannot be written to; the old file, if any, is then untouched.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_with(path, |file| file.write_all(bytes))
}

/// Writes to `path` what `write` hands over piece by piece, replacing what stood there.
///
/// # Errors
/// If the folder cannot be written to, or that of `write`; the old file, if any, is then untouched.
pub fn write_with(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    refuse_what_is_no_file(path)?;
    let mut file = temporary_beside(path)?;
    write(file.as_file_mut())?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Writes `bytes` to `path`, where nothing may stand yet.
///
/// # Errors
/// If something stands there, with [`io::ErrorKind::AlreadyExists`], or if the folder cannot be written to.
pub fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = temporary_beside(path)?;
    file.write_all(bytes)?;
    file.persist_noclobber(path).map_err(|error| error.error)?;
    Ok(())
}

/// Makes sure, before a long run, that files can be written into `folder`; creates it if it is missing.
///
/// Returns the folders that were created, the innermost first.
///
/// # Errors
/// If the folder cannot be made or written to.
pub fn prepare_folder(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let real = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
    let created = folder.ancestors().take_while(real).map(Path::to_owned).collect();
    std::fs::create_dir_all(folder)?;
    probe(&folder.join("probe"))?;
    Ok(created)
}

/// Removes folders that are empty, the innermost first; the others stay.
pub fn remove_empty(folders: &[PathBuf]) {
    for folder in folders {
        // a folder that is not empty cannot be removed, and is not to be
        let _ = std::fs::remove_dir(folder);
    }
}

/// Makes sure that the file `path` could be written, without touching it.
///
/// # Errors
/// If its folder is missing or cannot be written to, or if it is a folder itself, a device or a pipe.
pub fn probe(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
    }
    refuse_what_is_no_file(path)?;
    temporary_beside(path).map(drop)
}

/// A device that is renamed over is gone for the whole machine.
fn refuse_what_is_no_file(path: &Path) -> io::Result<()> {
    match std::fs::metadata(path) {
        Ok(found) if !found.is_file() => Err(io::Error::new(io::ErrorKind::InvalidInput, "it is no ordinary file")),
        _ => Ok(()),
    }
}

/// Removes the file `path` if it is there.
///
/// # Errors
/// If it is there and cannot be removed.
pub fn remove_if_present(path: &Path) -> io::Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

fn temporary_beside(path: &Path) -> io::Result<tempfile::NamedTempFile> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".wield-");
    // a temporary file is private by default, but results are to be shared as the user's umask says
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_socket_is_not_replaced_by_a_file() {
        use std::os::unix::fs::FileTypeExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("socket");
        let _listener = std::os::unix::net::UnixListener::bind(&path).unwrap();
        assert!(probe(&path).is_err());
        assert!(write_whole(&path, b"x").is_err());
        assert!(std::fs::metadata(&path).unwrap().file_type().is_socket());
    }

    #[test]
    fn a_file_is_replaced_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        write_whole(&path, b"one").unwrap();
        write_whole(&path, b"two").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_new_file_takes_no_others_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        write_new(&path, b"one").unwrap();
        assert_eq!(write_new(&path, b"two").unwrap_err().kind(), io::ErrorKind::AlreadyExists);
        assert_eq!(std::fs::read(&path).unwrap(), b"one");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_where_a_folder_should_be_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        std::fs::write(&path, "").unwrap();
        assert!(prepare_folder(&path.join("b")).is_err());
        assert!(probe(folder.path()).is_err());
    }

    #[test]
    fn folders_made_in_vain_can_be_taken_back() {
        let root = tempfile::tempdir().unwrap();
        let created = prepare_folder(&root.path().join("a/b")).unwrap();
        assert_eq!(created, [root.path().join("a/b"), root.path().join("a")]);
        remove_empty(&created);
        assert_eq!(std::fs::read_dir(root.path()).unwrap().count(), 0);
        assert_eq!(prepare_folder(root.path()).unwrap(), Vec::<PathBuf>::new());
    }

    #[test]
    fn removing_what_is_not_there_is_no_error() {
        let folder = tempfile::tempdir().unwrap();
        assert!(remove_if_present(&folder.path().join("none")).is_ok());
    }
}
