//! Which shard of a campaign a process makes: stated, or told by the engine that started it.

use std::str::FromStr;

use crate::campaign::Shard;

/// Number of shards, for engines that tell a task its number only.
const SHARDS: &str = "WIELD_SHARDS";

/// What `--shard` says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShardChoice {
    /// This shard.
    Stated(Shard),
    /// The one that the variables of the engine tell.
    Auto,
}

impl FromStr for ShardChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "auto" { Ok(Self::Auto) } else { text.parse().map(Self::Stated) }
    }
}

/// An engine that tells a task its number in a variable.
struct Engine {
    name: &'static str,
    /// The variable.
    task: &'static str,
    /// The number of the first task.
    first: u64,
}

/// The innermost engine first: GNU parallel and HyperQueue are run inside jobs of the others.
const ENGINES: [Engine; 4] = [
    Engine { name: "GNU parallel", task: "PARALLEL_SEQ", first: 1 },
    Engine { name: "HyperQueue", task: "HQ_TASK_ID", first: 0 },
    Engine { name: "a Kubernetes indexed job", task: "JOB_COMPLETION_INDEX", first: 0 },
    Engine { name: "a Slurm array", task: "SLURM_ARRAY_TASK_ID", first: 0 },
];

impl ShardChoice {
    /// The shard; `variable` looks up a variable of the environment.
    ///
    /// # Errors
    /// In words.
    pub fn resolve(self, variable: &dyn Fn(&str) -> Option<String>) -> Result<Shard, String> {
        let Self::Auto = self else {
            return match self {
                Self::Stated(shard) => Ok(shard),
                Self::Auto => Ok(Shard::WHOLE),
            };
        };
        let set = |name: &str| variable(name).filter(|value| !value.is_empty());
        let Some(engine) = ENGINES.iter().find(|engine| set(engine.task).is_some()) else {
            let known: Vec<&str> = ENGINES.iter().map(|engine| engine.task).collect();
            return Err(format!(
                "--shard auto: found none of {}; expected one, set by the engine that starts this program; \
                 without an engine write --shard i/n",
                known.join(", ")
            ));
        };
        let number = |name: &str| match set(name) {
            None => Ok(None),
            Some(text) => match text.trim().parse::<u64>() {
                Ok(number) => Ok(Some(number)),
                Err(_) => Err(format!("--shard auto: found {name}={text:?}; expected a whole number")),
            },
        };
        let task = number(engine.task)?.unwrap_or(engine.first);
        let (first, step, count) = match number(SHARDS)? {
            Some(count) => (engine.first, 1, count),
            None => array(&number)?.filter(|_| engine.task == "SLURM_ARRAY_TASK_ID").ok_or_else(|| {
                format!("--shard auto: {} tells no number of tasks; expected it in {SHARDS}", engine.name)
            })?,
        };
        let offset = task.checked_sub(first);
        let index = offset.filter(|offset| offset % step == 0).map(|offset| offset / step);
        index.filter(|&index| index < count).map(|index| Shard { index, count }).ok_or_else(|| {
            let last = first + step * count.saturating_sub(1);
            let every = if step == 1 { String::new() } else { format!(" in steps of {step}") };
            format!(
                "--shard auto: found {}={task} with {count} tasks; expected a number from {first} to {last}{every}; \
                 number the tasks so, or set {SHARDS} to the number of shards",
                engine.task
            )
        })
    }
}

/// First task, step and number of tasks of a Slurm array, as far as Slurm tells them.
fn array(number: &dyn Fn(&str) -> Result<Option<u64>, String>) -> Result<Option<(u64, u64, u64)>, String> {
    let Some(count) = number("SLURM_ARRAY_TASK_COUNT")? else { return Ok(None) };
    let first = number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(0);
    let step = number("SLURM_ARRAY_TASK_STEP")?.unwrap_or(1).max(1);
    Ok(Some((first, step, count)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shard that variables, written "A=1 B=2", lead to.
    fn auto(variables: &str) -> Result<(u64, u64), String> {
        let look = |name: &str| {
            let pairs = variables.split_whitespace().filter_map(|pair| pair.split_once('='));
            pairs.filter(|(key, _)| *key == name).map(|(_, value)| value.to_owned()).next()
        };
        ShardChoice::Auto.resolve(&look).map(|shard| (shard.index, shard.count))
    }

    #[test]
    fn each_engine_numbers_its_tasks_in_its_own_way() {
        let expect = [
            ("SLURM_ARRAY_TASK_ID=0 SLURM_ARRAY_TASK_COUNT=4 SLURM_ARRAY_TASK_MIN=0", (0, 4)),
            ("SLURM_ARRAY_TASK_ID=4 SLURM_ARRAY_TASK_COUNT=4 SLURM_ARRAY_TASK_MIN=1", (3, 4)),
            (
                "SLURM_ARRAY_TASK_ID=30 SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_MIN=10 SLURM_ARRAY_TASK_STEP=10",
                (2, 3),
            ),
            // two tasks of an array of eight, handed in once more
            ("SLURM_ARRAY_TASK_ID=7 SLURM_ARRAY_TASK_COUNT=2 SLURM_ARRAY_TASK_MIN=3 WIELD_SHARDS=8", (7, 8)),
            ("HQ_TASK_ID=0 WIELD_SHARDS=5", (0, 5)),
            ("JOB_COMPLETION_INDEX=4 WIELD_SHARDS=5", (4, 5)),
            ("PARALLEL_SEQ=5 WIELD_SHARDS=5", (4, 5)),
            ("PARALLEL_SEQ=1 WIELD_SHARDS=5 SLURM_ARRAY_TASK_ID=3 SLURM_ARRAY_TASK_COUNT=4", (0, 5)),
            ("HQ_TASK_ID= JOB_COMPLETION_INDEX=1 WIELD_SHARDS=2", (1, 2)),
        ];
        for (variables, shard) in expect {
            assert_eq!(auto(variables), Ok(shard), "{variables}");
        }
    }

    #[test]
    fn what_tells_no_shard_is_refused_in_words() {
        let expect = [
            ("", "found none of PARALLEL_SEQ, HQ_TASK_ID"),
            ("WIELD_SHARDS=5", "found none of"),
            ("HQ_TASK_ID=1", "HyperQueue tells no number of tasks; expected it in WIELD_SHARDS"),
            ("SLURM_ARRAY_TASK_ID=1", "a Slurm array tells no number of tasks"),
            ("HQ_TASK_ID=5 WIELD_SHARDS=5", "found HQ_TASK_ID=5 with 5 tasks; expected a number from 0 to 4"),
            ("PARALLEL_SEQ=0 WIELD_SHARDS=5", "expected a number from 1 to 5"),
            ("HQ_TASK_ID=x WIELD_SHARDS=5", "found HQ_TASK_ID=\"x\"; expected a whole number"),
            ("HQ_TASK_ID=0 WIELD_SHARDS=0", "with 0 tasks"),
            // an array of a list of numbers is no range
            ("SLURM_ARRAY_TASK_ID=7 SLURM_ARRAY_TASK_COUNT=2 SLURM_ARRAY_TASK_MIN=3", "expected a number from 3 to 4"),
        ];
        for (variables, part) in expect {
            let said = auto(variables).unwrap_err();
            assert!(said.contains(part), "{variables}: {said}");
        }
    }

    #[test]
    fn a_stated_shard_needs_no_engine() {
        let nothing = |_: &str| None;
        assert_eq!("1/3".parse::<ShardChoice>().unwrap().resolve(&nothing), Ok(Shard { index: 1, count: 3 }));
        assert_eq!("auto".parse(), Ok(ShardChoice::Auto));
        assert!("3/3".parse::<ShardChoice>().is_err());
    }
}
