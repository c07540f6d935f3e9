//! `wield view`: opens recordings in an installed viewer, offline.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::{Exit, say, say_aside, say_error};

pub const AFTER_HELP: &str = "\
A folder stands for all recordings (*.rrd) in it and below it, the newest first. The viewer is the program `rerun` of the
version that made them; newer ones open them too: pip install rerun-sdk==0.36.3

Examples:
  wield view runs/push_stick               every recording of that scenario
  wield view runs/compare-push_compare/recording.rrd
  wield view runs --list                   only their names

Exit codes: 0 opened, 2 no such file or no recording in it, 3 the viewer is not installed or failed.";

/// The viewer's program.
const PROGRAM: &str = "rerun";

/// Ending of recordings.
const ENDING: &str = "rrd";

/// More recordings than this in one viewer are no longer looked at.
const MOST: usize = 32;

/// Folders below which no recording is looked for.
const DEEPEST: usize = 8;

/// Options of `wield view`.
#[derive(Debug, clap::Args)]
pub struct ViewArguments {
    /// Recordings, or folders of recordings
    #[arg(value_name = "PATH", required = true)]
    paths: Vec<PathBuf>,
    /// Print their names instead of opening them
    #[arg(long)]
    list: bool,
}

/// Finds the recordings and opens them.
pub fn execute(arguments: &ViewArguments) -> Exit {
    let mut files = Vec::new();
    for path in &arguments.paths {
        let found = recordings(path);
        if found.is_empty() {
            let reason = if path.exists() { "found no recording" } else { "found no such file or folder" };
            say_error(&format!("{}: {reason}; expected a file *.rrd or a folder with some", path.display()));
            return Exit::BadInput;
        }
        files.extend(found);
    }
    if arguments.list {
        return say(&files.iter().map(|file| format!("{}\n", file.display())).collect::<String>());
    }
    if files.len() > MOST {
        say_aside(&format!(
            "note: the newest {MOST} of {} recordings are opened; name the others to see them",
            files.len()
        ));
        files.truncate(MOST);
    }
    open(PROGRAM, &files)
}

/// The recordings at a path, the newest first.
fn recordings(path: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    collect(path, DEEPEST, &mut found);
    let age = |file: &PathBuf| std::fs::metadata(file).and_then(|found| found.modified()).ok();
    // by name among those of one moment
    found.sort();
    found.sort_by_key(|file| std::cmp::Reverse(age(file)));
    found
}

fn collect(path: &Path, deeper: usize, found: &mut Vec<PathBuf>) {
    if path.is_file() {
        if path.extension().is_some_and(|ending| ending == ENDING) {
            found.push(path.to_owned());
        }
        return;
    }
    if deeper == 0 {
        return;
    }
    for entry in std::fs::read_dir(path).into_iter().flatten().flatten() {
        collect(&entry.path(), deeper - 1, found);
    }
}

/// Opens files in the viewer and leaves it to the user: it outlives this program.
fn open(program: &str, files: &[PathBuf]) -> Exit {
    let mut command = Command::new(program);
    // a viewer listens on every interface unless it is told otherwise
    command.args(["--bind", "127.0.0.1"]).args(files);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt as _;
        command.process_group(0);
    }
    match command.spawn() {
        Ok(_) => say(&format!("opened {} in {program}\n", counted(files.len()))),
        Err(error) => {
            say_error(&format!(
                "start the viewer `{program}`: {error}; install it with: pip install rerun-sdk==0.36.3"
            ));
            Exit::Crashed
        }
    }
}

fn counted(count: usize) -> String {
    if count == 1 { "1 recording".into() } else { format!("{count} recordings") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recordings_are_found_below_a_folder_and_nothing_else_is() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("a/seed-1")).unwrap();
        for name in ["a/seed-1/recording.rrd", "b.rrd", "a/outcome.json"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let mut found = recordings(folder.path());
        found.sort();
        assert_eq!(found, ["a/seed-1/recording.rrd", "b.rrd"].map(|name| folder.path().join(name)));
        assert_eq!(recordings(&folder.path().join("b.rrd")).len(), 1);
        assert!(recordings(&folder.path().join("a/outcome.json")).is_empty());
    }

    #[test]
    fn a_viewer_that_is_not_installed_is_told() {
        assert_eq!(open("no-such-viewer-is-installed", &["a.rrd".into()]), Exit::Crashed);
    }
}
