//! A Slurm cluster of one machine, started without systemd, that listens on loopback only and ends with the test.

use std::fs;
use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// Longest time that anything here is waited for.
const PATIENCE: Duration = Duration::from_secs(120);

/// A running cluster.
pub struct Cluster {
    folder: TempDir,
}

impl Cluster {
    /// Starts one; `None` if Slurm is not installed.
    pub fn start() -> Option<Self> {
        let installed = |program: &str| Command::new(program).arg("-V").output().is_ok();
        if !["slurmctld", "slurmd", "munged", "sbatch"].into_iter().all(installed) {
            return None;
        }
        let folder = tempfile::tempdir().unwrap();
        // munge refuses folders that others could write to, and Slurm's daemons ones that they cannot read
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
        let cluster = Self { folder };
        cluster.write_files();
        let at = |name: &str| cluster.at(name).display().to_string();
        run(Command::new("munged").args([
            "--force".to_owned(),
            format!("--key-file={}", at("munge.key")),
            format!("--socket={}", at("munge.socket")),
            format!("--pid-file={}", at("munged.pid")),
            format!("--log-file={}", at("munged.log")),
            format!("--seed-file={}", at("munge.seed")),
        ]));
        run(cluster.command("slurmctld").args(["-f", &at("slurm.conf")]));
        run(cluster.command("slurmd").args(["-f", &at("slurm.conf"), "-N", &host()]));
        let idle = || String::from_utf8_lossy(&run(&mut cluster.command("sinfo")).stdout).contains("idle");
        until("the node is idle", idle);
        Some(cluster)
    }

    /// A command that talks to this cluster.
    pub fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.at("slurm.conf"));
        command
    }

    /// Waits until no job is left.
    pub fn wait(&self) {
        let queue = || run(self.command("squeue").arg("--noheader")).stdout.is_empty();
        until("the queue is empty", queue);
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write_files(&self) {
        let key: Vec<u8> = (0..1024_u32).map(|index| (index * 7 + std::process::id()).to_le_bytes()[0]).collect();
        fs::write(self.at("munge.key"), key).unwrap();
        fs::set_permissions(self.at("munge.key"), fs::Permissions::from_mode(0o400)).unwrap();
        let user = String::from_utf8(run(Command::new("id").arg("-un")).stdout).unwrap();
        let (folder, host, user) = (self.folder.path().display(), host(), user.trim());
        let [controller, node] = [free_port(), free_port()];
        let text = format!(
            "ClusterName=wield\nSlurmctldHost={host}(127.0.0.1)\nSlurmctldPort={controller}\nSlurmdPort={node}\n\
             AuthType=auth/munge\nAuthInfo=socket={folder}/munge.socket\n\
             CommunicationParameters=NoInAddrAny,NoCtldInAddrAny\nSlurmUser={user}\nSlurmdUser={user}\n\
             StateSaveLocation={folder}/state\nSlurmdSpoolDir={folder}/spool\n\
             SlurmctldPidFile={folder}/slurmctld.pid\nSlurmdPidFile={folder}/slurmd.pid\n\
             SlurmctldLogFile={folder}/slurmctld.log\nSlurmdLogFile={folder}/slurmd.log\n\
             ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nMpiDefault=none\n\
             SelectType=select/cons_tres\nSelectTypeParameters=CR_Core\nReturnToService=2\n\
             NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN\n\
             PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP\n"
        );
        fs::write(self.at("slurm.conf"), text).unwrap();
        for name in ["state", "spool"] {
            fs::create_dir(self.at(name)).unwrap();
        }
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        let me = Command::new("id")
            .arg("-un")
            .output()
            .map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
        if let Ok(me) = me {
            let _ = self.command("scancel").args(["--full", "--user", &me]).output();
        }
        let _ = self.command("scontrol").arg("shutdown").output();
        if let Ok(pid) = fs::read_to_string(self.at("munged.pid")) {
            let _ = Command::new("kill").arg(pid.trim()).output();
        }
        let gone = || !self.at("slurmd.pid").exists() && !self.at("slurmctld.pid").exists();
        let started = Instant::now();
        while !gone() && started.elapsed() < Duration::from_secs(10) {
            std::thread::sleep(Duration::from_millis(100));
        }
    }
}

/// Runs a command that must succeed.
pub fn run(command: &mut Command) -> Output {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    output
}

/// Waits until something is so.
pub fn until(what: &str, mut so: impl FnMut() -> bool) {
    let started = Instant::now();
    while !so() {
        assert!(started.elapsed() < PATIENCE, "waited in vain until {what}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// Number of lines in the journals of a campaign whose names begin with `prefix`.
pub fn journal_lines(campaign: &Path, prefix: &str) -> usize {
    let entries = fs::read_dir(campaign.join("journal")).into_iter().flatten().flatten();
    let mine = entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(prefix));
    mine.map(|entry| fs::read_to_string(entry.path()).unwrap_or_default().lines().count()).sum()
}

fn host() -> String {
    let output = run(Command::new("hostname").arg("-s"));
    String::from_utf8(output.stdout).unwrap().trim().to_owned()
}

fn free_port() -> u16 {
    TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}
