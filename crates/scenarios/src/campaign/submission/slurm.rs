//! Slurm: an array of tasks, a shard each.

use super::{Engine, Submission};

pub(super) const ENGINE: Engine =
    Engine { name: "slurm", summary: "job array of Slurm, by sbatch", script, start: &["sbatch"] };

/// Time limit of a task as a multiple of what it is expected to take: other machines may be slower.
const MARGIN: f64 = 4.0;

fn script(submission: &Submission) -> String {
    let mut lines = vec![
        "#!/usr/bin/env bash".to_owned(),
        format!("#SBATCH --job-name={}", submission.name),
        format!("#SBATCH --array=0-{}", submission.shards - 1),
        format!("#SBATCH --cpus-per-task={}", submission.threads),
        format!("#SBATCH --output=\"{}\"", submission.log("%A_%a.log")),
        "#SBATCH --requeue".to_owned(),
    ];
    if let Some(expected_s) = submission.expected_s {
        lines.push(format!("#SBATCH --time={}", (expected_s * MARGIN / 60.0).ceil().max(5.0)));
    }
    lines.extend(submission.options.iter().map(|option| format!("#SBATCH {option}")));
    format!(
        "{}\n{}exec {}\n",
        lines.join("\n"),
        submission.opening(),
        submission.shard_command("${SLURM_ARRAY_TASK_ID}")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_script_is_an_array_of_shards() {
        let expected = "\
#!/usr/bin/env bash
#SBATCH --job-name=friction
#SBATCH --array=0-7
#SBATCH --cpus-per-task=2
#SBATCH --output=\"/home/ada/my project/runs/friction/log/%A_%a.log\"
#SBATCH --requeue
#SBATCH --time=34
#SBATCH --partition=short
set -euo pipefail
cd '/home/ada/my project'
exec /opt/wield/wield sweep '/home/ada/my project/runs/friction' --shard \"${SLURM_ARRAY_TASK_ID}/8\" --threads 2 --quiet
";
        assert_eq!(script(&super::super::example()), expected);
    }
}
