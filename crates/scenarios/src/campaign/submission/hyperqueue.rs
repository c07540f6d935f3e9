//! HyperQueue: an array of tasks, a shard each, on workers that sit wherever it put them.

use super::{Engine, Submission, quoted};

pub(super) const ENGINE: Engine =
    Engine { name: "hyperqueue", summary: "task array of HyperQueue, by hq submit", script, start: &["bash"] };

fn script(submission: &Submission) -> String {
    let options: String = submission.options.iter().map(|option| format!("{option} ")).collect();
    format!(
        "#!/usr/bin/env bash\n{}hq submit --name {} --array 0-{} --cpus {} --crash-limit 5 --stdout {} --stderr {} {options}-- \\\n  bash -c {}\n",
        submission.opening(),
        quoted(&submission.name),
        submission.shards - 1,
        submission.threads,
        quoted(&submission.log("%{TASK_ID}.out")),
        quoted(&submission.log("%{TASK_ID}.err")),
        quoted(&format!("exec {}", submission.shard_command("${HQ_TASK_ID}"))),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shell_of_a_task_fills_in_its_number() {
        let script = script(&super::super::example());
        assert!(script.contains("--array 0-7 --cpus 2 "), "{script}");
        assert!(script.contains("--shard \"${HQ_TASK_ID}/8\""), "{script}");
    }
}
