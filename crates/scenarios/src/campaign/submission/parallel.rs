//! GNU parallel: shards on the cores of this machine, or over ssh on others with `--sshlogin`.

use super::{Engine, Submission, quoted};

pub(super) const ENGINE: Engine =
    Engine { name: "parallel", summary: "GNU parallel on this machine, or by ssh on others", script, start: &["bash"] };

fn script(submission: &Submission) -> String {
    let options: String = submission.options.iter().map(|option| format!("{option} ")).collect();
    format!(
        "#!/usr/bin/env bash\n{}seq 0 {} | parallel --joblog {} --resume-failed {options}{}\n",
        submission.opening(),
        submission.shards - 1,
        quoted(&submission.log("parallel.log")),
        quoted(&submission.shard_command("{}")),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shard_is_a_line_of_its_input() {
        let script = script(&super::super::example());
        assert!(script.contains("seq 0 7 | parallel "), "{script}");
        assert!(script.contains("--shard \"{}/8\""), "{script}");
    }
}
