//! A campaign on a real Slurm, on one machine: two shards, one of them killed, resumed, merged, equal to the local run.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

#[path = "slurm/cluster.rs"]
mod cluster;
mod program;

use std::fs;
use std::path::Path;
use std::process::Command;

use cluster::{Cluster, journal_lines, run, until};
use program::{PROJECT, project, wield};

const SWEEP: &str = "\
[sweep]
scenario = \"push.toml\"
trials = 4

[design.grid]

[[factor]]
key = \"object.table_friction\"
values = [0.2, 0.25, 0.3]
";

#[test]
fn a_killed_shard_on_slurm_is_resumed_and_the_merged_table_equals_that_of_a_local_run() {
    let Some(cluster) = Cluster::start() else {
        println!("skipped: Slurm is not installed (Debian: apt-get install slurm-wlm munge)");
        return;
    };
    let folder = project();
    let scenario = fs::read_to_string(Path::new(PROJECT).join("scenarios/push_stick.toml")).unwrap();
    fs::write(folder.path().join("push.toml"), scenario).unwrap();
    fs::write(folder.path().join("friction.toml"), SWEEP).unwrap();
    let local = wield(folder.path(), None, &["sweep", "friction.toml", "--out", "local", "--quiet"]);
    assert_eq!(local.status.code(), Some(0), "{}", String::from_utf8_lossy(&local.stderr));
    assert_eq!(wield(folder.path(), None, &["plan", "friction.toml", "--out", "far"]).status.code(), Some(0));

    let submit = || {
        let mut command = cluster.command(env!("CARGO_BIN_EXE_wield"));
        run(command
            .args(["submit", "slurm", "far", "--shards", "2"])
            .current_dir(folder.path())
            .env_remove("WIELD_ASSETS"))
    };
    submit();
    let far = folder.path().join("far");
    until("the first shard has made a run", || journal_lines(&far, "0of2") > 0);
    let killed = kill_shard(&far.canonicalize().unwrap(), "0/2");
    cluster.wait();
    let status = wield(folder.path(), None, &["status", "far"]);
    if killed {
        assert_eq!(status.status.code(), Some(1), "{}", String::from_utf8_lossy(&status.stdout));
        assert!(journal_lines(&far, "0of2") < 6);
        submit();
        cluster.wait();
    }
    let merged = wield(folder.path(), None, &["merge", "far"]);
    assert_eq!(merged.status.code(), Some(0), "{}", String::from_utf8_lossy(&merged.stdout));
    let table = |name: &str| fs::read(folder.path().join(name).join("results.parquet")).unwrap();
    assert_eq!(table("far"), table("local"));
    assert!(killed, "the shard ended before it could be killed: lengthen the sweep");
}

/// Ends the process that makes a shard as a power cut would; tells whether there was one.
fn kill_shard(campaign: &Path, shard: &str) -> bool {
    let campaign = campaign.display().to_string();
    let processes = fs::read_dir("/proc").unwrap().flatten();
    let is_it = |pid: &String| {
        let line = fs::read(format!("/proc/{pid}/cmdline")).unwrap_or_default();
        let words: Vec<String> =
            line.split(|&byte| byte == 0).map(|word| String::from_utf8_lossy(word).into()).collect();
        words.contains(&campaign) && words.iter().any(|word| word == shard) && words[0].ends_with("wield")
    };
    let found = processes.map(|entry| entry.file_name().to_string_lossy().into_owned()).find(is_it);
    found.is_some_and(|pid| Command::new("kill").args(["-9", &pid]).status().unwrap().success())
}
