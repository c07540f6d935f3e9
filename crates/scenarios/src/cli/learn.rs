//! `wield learn`: what a scenario's demonstrations teach, kept in a file.

use std::path::{Path, PathBuf};

use super::progress::RunProgress;
use super::{Exit, SetArguments, overwrite, panics, say, say_aside, say_error, unwritable};
use crate::files::{probe, write_whole};
use crate::pipeline::{RunError, learn};
use crate::scenario::{KeptSkills, LARGEST_SEED, ResolvedScenario, notes};

pub const AFTER_HELP: &str = "\
The file is text: where the skills come from, and every number that defines them, to the last bit. What is loaded moves
exactly as what was learned.

To use the skills, put the file into the folder `skills` of the assets and name it in a scenario:
  [demonstrations.learned]
  asset = \"push_stick\"

Examples:
  wield learn scenarios/push_stick.toml --out assets/skills/push_stick.toml
  wield learn scenarios/push_stick.toml --seed 7 --out seven.toml
  wield learn scenarios/cut_banana_three.toml --out assets/skills/cut_own.toml
  wield learn scenarios/push_stick.toml --set demonstrations.synthetic.count=10

Exit codes: 0 success, 1 nothing could be learned, 2 bad input (nothing written), 3 crashed or diverged.";

/// Options of `wield learn`.
#[derive(Debug, clap::Args)]
pub struct LearnArguments {
    /// Scenario file
    file: PathBuf,
    #[command(flatten)]
    set: SetArguments,
    /// Seed of the human and the recorders [default: the scenario's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=LARGEST_SEED))]
    seed: Option<u64>,
    /// File for the skills [default: <scenario>.skills.toml]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// Loads the scenario, makes sure that the file can be written, learns, writes, reports.
pub fn execute(arguments: &LearnArguments, assets: Option<&Path>) -> Exit {
    let Some(scenario) = arguments.set.load_told(&arguments.file, assets) else { return Exit::BadInput };
    let seed = arguments.seed.unwrap_or(scenario.header().seed);
    let out = arguments.out.clone().unwrap_or_else(|| format!("{}.skills.toml", scenario.name).into());
    let writable = probe(&out).map_err(|error| unwritable(&out, &error, "--out"));
    if let Err(reason) = writable.and_then(|()| overwrite::only(&out, overwrite::SKILLS, "--out")) {
        say_error(&reason);
        return Exit::BadInput;
    }
    if !arguments.quiet {
        notes(&scenario).iter().for_each(|note| say_aside(&format!("note: {note}")));
    }
    match learned(arguments, &scenario, seed) {
        Ok(Ok(skills)) => keep(arguments, &skills, &out),
        Ok(Err(reason)) => {
            say_error(&format!("{} with seed {seed}: {reason}", scenario.name));
            Exit::Missed
        }
        Err(error) if error.is_input => {
            say_error(&format!("{} with seed {seed}: {error} ({})", scenario.name, arguments.file.display()));
            Exit::BadInput
        }
        Err(error) => {
            say_error(&format!("{} with seed {seed}: {error}", scenario.name));
            Exit::Crashed
        }
    }
}

fn learned(
    arguments: &LearnArguments,
    scenario: &ResolvedScenario,
    seed: u64,
) -> Result<Result<KeptSkills, String>, RunError> {
    let progress = RunProgress::new(arguments.quiet);
    let result = panics::catch(|| learn(scenario, seed, &|stage, share| progress.show(stage, share)));
    progress.finish();
    result.unwrap_or_else(|reason| Err(RunError { stage: "learn", reason, is_input: false }))
}

/// Writes the skills and says what they are.
fn keep(arguments: &LearnArguments, skills: &KeptSkills, out: &Path) -> Exit {
    if let Err(error) = write_whole(out, skills.text.as_bytes()) {
        say_error(&format!("write {}: {error}", out.display()));
        return Exit::Crashed;
    }
    if arguments.quiet {
        return Exit::Success;
    }
    say(&format!("{}skills: {}\n", skills.told, out.display()))
}
