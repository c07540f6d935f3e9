//! Scripts that hand a campaign to an engine which exists: each writes the shards as tasks of one array.
//!
//! An engine is one file and one entry of [`ENGINES`]. Whatever it does with the tasks, killing or repeating them, a run
//! is made once: every task skips the runs that are done. Completion is judged by the journals.

mod hyperqueue;
mod parallel;
mod slurm;

use std::path::PathBuf;

/// An engine that runs arrays of tasks.
#[derive(Debug)]
pub struct Engine {
    /// Name on the command line.
    pub name: &'static str,
    /// What it is.
    pub summary: &'static str,
    /// The script for a submission.
    pub script: fn(&Submission) -> String,
    /// The program and the options that start the script.
    pub start: &'static [&'static str],
}

/// All engines.
pub const ENGINES: &[Engine] = &[slurm::ENGINE, hyperqueue::ENGINE, parallel::ENGINE];

/// What is handed to an engine.
#[derive(Clone, Debug)]
pub struct Submission {
    /// Name of the job.
    pub name: String,
    /// The program, absolute.
    pub program: PathBuf,
    /// The folder in which the tasks work, absolute: names in the manifest are relative to it.
    pub work_in: PathBuf,
    /// The campaign's folder, absolute.
    pub folder: PathBuf,
    /// Number of shards, at least 1.
    pub shards: u64,
    /// Threads of each task.
    pub threads: u16,
    /// Clock time that a task is expected to take, s, if it is known.
    pub expected_s: Option<f64>,
    /// Further lines for the engine, such as `--partition=short`.
    pub options: Vec<String>,
}

impl Submission {
    /// The command that makes one shard; `index` is what the shell puts the task's number in the place of.
    fn shard_command(&self, index: &str) -> String {
        format!(
            "{} sweep {} --shard \"{index}/{}\" --threads {} --quiet",
            quoted(&self.program.to_string_lossy()),
            quoted(&self.folder.to_string_lossy()),
            self.shards,
            self.threads,
        )
    }

    /// How the script begins, after its first line: where it works, and that it stops at an error.
    fn opening(&self) -> String {
        format!("set -euo pipefail\ncd {}\n", quoted(&self.work_in.to_string_lossy()))
    }

    /// Where tasks write what they say.
    fn log(&self, name: &str) -> String {
        self.folder.join("log").join(name).to_string_lossy().into_owned()
    }
}

/// A word of a shell script that stands for `text`, whatever is in it.
fn quoted(text: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "_-./=:,+@%".contains(letter);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

/// How many shards `runs` are divided into, so that each takes about `minutes`; at most `most`.
///
/// Without a measured time per run, a shard holds 50 runs.
#[must_use]
pub fn shard_count(runs: usize, wall_per_run_s: Option<f64>, minutes: f64, threads: u16, most: u64) -> u64 {
    let per_shard = wall_per_run_s.map_or(50.0, |wall_s| 60.0 * minutes * f64::from(threads) / wall_s.max(1e-3));
    let wanted = (runs as f64 / per_shard.max(1.0)).ceil();
    (wanted as u64).clamp(1, most.min(runs.max(1) as u64))
}

#[cfg(test)]
pub(crate) fn example() -> Submission {
    Submission {
        name: "friction".into(),
        program: "/opt/wield/wield".into(),
        work_in: "/home/ada/my project".into(),
        folder: "/home/ada/my project/runs/friction".into(),
        shards: 8,
        threads: 2,
        expected_s: Some(500.0),
        options: vec!["--partition=short".into()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_take_the_wanted_time_and_are_not_too_many() {
        // 1000 runs of 6 s are 100 minutes: ten shards of ten
        assert_eq!(shard_count(1000, Some(6.0), 10.0, 1, 1000), 10);
        assert_eq!(shard_count(1000, Some(6.0), 10.0, 2, 1000), 5);
        assert_eq!(shard_count(1000, None, 10.0, 1, 1000), 20);
        assert_eq!(shard_count(3, Some(1e6), 10.0, 1, 1000), 3);
        assert_eq!(shard_count(1_000_000, Some(600.0), 10.0, 1, 1000), 1000);
        assert_eq!(shard_count(0, None, 10.0, 1, 1000), 1);
    }

    #[test]
    fn words_of_a_script_are_quoted_where_they_must_be() {
        assert_eq!(quoted("/a/b-c_1.toml"), "/a/b-c_1.toml");
        assert_eq!(quoted("it's $HOME"), r"'it'\''s $HOME'");
        assert_eq!(quoted(""), "''");
    }

    #[cfg(unix)]
    #[test]
    fn every_script_is_read_by_the_shell() {
        for engine in ENGINES {
            let folder = tempfile::tempdir().unwrap();
            let file = folder.path().join("script.sh");
            std::fs::write(&file, (engine.script)(&example())).unwrap();
            let read = std::process::Command::new("bash").arg("-n").arg(&file).output().unwrap();
            assert!(read.status.success(), "{}: {}", engine.name, String::from_utf8_lossy(&read.stderr));
        }
    }
}
