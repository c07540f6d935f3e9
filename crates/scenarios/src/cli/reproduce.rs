//! `wield reproduce`: every figure, table and claim of the paper that the project covers, computed anew.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::builder::PossibleValuesParser;

use super::observe::{self, Destination};
use super::{Exit, assets_for, load_told, panics, prepare_told, say, say_aside, say_error};
use crate::files::{remove_empty, write_whole};
use crate::pipeline;
use crate::reproduction::{ITEMS, Item, Part, README, Study, StudyError, TIMINGS, readme, timings};
use crate::scenario::ResolvedScenario;

pub const AFTER_HELP: &str = "\
The folder then holds README.md with every figure, table and verdict, the figures as SVG and the tables as Markdown for
themselves, and timings.md with what depends on the clock. All but timings.md is the same on every run. The run of Fig. 7 is
recorded as push_transfer_l.rrd.

Examples:
  wield reproduce                                  everything, into docs/reproduction/
  wield reproduce --only figure_5_transfer         one figure, into runs/reproduction/
  wield reproduce --only table_2 --only figure_9 --out tmp
  wield reproduce --trials 200                     the transfer experiment with more seeds

A verdict \"not reproduced\" is a result, not a failure of the program.

Exit codes: 0 success, 2 bad input (nothing written), 3 an item could not be computed, or a file not written.";

/// Scenario that the paper's first experiment is reproduced from.
const SCENARIO: &str = "push_transfer_l";
/// Folders of the results: of all items, and of some.
const WHOLE: &str = "docs/reproduction";
const SOME: &str = "runs/reproduction";

/// Options of `wield reproduce`.
#[derive(Debug, clap::Args)]
pub struct ReproduceArguments {
    /// Folder of the results [default: docs/reproduction; with --only runs/reproduction]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Seeds of the transfer experiment, each closed and open loop
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    trials: u32,
    /// Only this item; may be given several times
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(ITEMS.iter().map(|item| item.name)))]
    only: Vec<String>,
    /// Make no recording
    #[arg(long)]
    no_record: bool,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// Loads the scenario, makes sure that the folder can be written to, computes the items one by one, writes the report.
pub fn execute(arguments: &ReproduceArguments, assets: Option<&Path>) -> Exit {
    let folder = assets_for(assets, None);
    let project = folder.root().parent().unwrap_or(Path::new("."));
    let file = project.join("scenarios").join(format!("{SCENARIO}.toml"));
    let Some(scenario) = load_told(&file, assets) else { return Exit::BadInput };
    let usual = if arguments.only.is_empty() { WHOLE } else { SOME };
    let out = arguments.out.clone().unwrap_or_else(|| usual.into());
    let Some(created) = prepare_told(&out) else { return Exit::BadInput };
    match panics::catch(|| reproduce(arguments, &scenario, &out)) {
        Ok(Ok(())) if arguments.quiet => Exit::Success,
        Ok(Ok(())) => say(&format!("results: {}\n", out.join(README).display())),
        Ok(Err(reason)) | Err(reason) => {
            remove_empty(&created);
            say_error(&reason);
            Exit::Crashed
        }
    }
}

/// Computes the items that were asked for, and writes everything once all are there.
fn reproduce(arguments: &ReproduceArguments, scenario: &ResolvedScenario, out: &Path) -> Result<(), String> {
    let wanted: Vec<&Item> = ITEMS
        .iter()
        .filter(|item| arguments.only.is_empty() || arguments.only.iter().any(|name| name == item.name))
        .collect();
    let tell = |line: &str| {
        if !arguments.quiet {
            say_aside(line);
        }
    };
    let count = |done: usize, of: usize| {
        if done * 10 / of != (done - 1) * 10 / of {
            tell(&format!("  {done} of {of} runs"));
        }
    };
    let study = Study::new(scenario, arguments.trials, &count).map_err(|error| format!("reproduce: {error}"))?;
    let (mut parts, mut seconds) = (Vec::new(), Vec::new());
    for (index, item) in wanted.iter().enumerate() {
        tell(&format!("{} of {}: {}", index + 1, wanted.len(), item.title));
        let begun = Instant::now();
        let part = (item.run)(&study).map_err(|error: StudyError| format!("reproduce {}: {error}", item.name))?;
        seconds.push(begun.elapsed().as_secs_f64());
        parts.push((*item, part));
    }
    let recording = format!("{SCENARIO}.rrd");
    write_all(out, &parts).map_err(|error| format!("write {}: {error}", out.display()))?;
    let pages =
        [(README, readme(&parts, SCENARIO, arguments.trials, &recording)), (TIMINGS, timings(&parts, &seconds))];
    for (name, text) in pages {
        let file = out.join(name);
        write_whole(&file, text.as_bytes()).map_err(|error| format!("write {}: {error}", file.display()))?;
    }
    if arguments.no_record || !observe::AVAILABLE {
        return Ok(());
    }
    tell(&format!("recording {recording}"));
    record(scenario, &out.join(recording))
}

fn write_all(out: &Path, parts: &[(&Item, Part)]) -> io::Result<()> {
    for (_, part) in parts {
        for figure in &part.figures {
            write_whole(&out.join(figure.file), figure.svg.as_bytes())?;
        }
        for table in &part.tables {
            write_whole(&out.join(table.file), format!("{}\n\n{}", table.caption, table.markdown).as_bytes())?;
        }
    }
    Ok(())
}

/// Records the run with the scenario's seed.
fn record(scenario: &ResolvedScenario, file: &Path) -> Result<(), String> {
    let destination = Destination { file: Some(file.to_owned()), ..Destination::default() };
    let seed = scenario.header().seed;
    let watched =
        observe::watch(&destination, scenario, seed, |observer| pipeline::run(scenario, seed, observer, &|_, _| {}))?;
    watched.warnings.iter().for_each(|warning| say_aside(&format!("warning: {warning}")));
    watched.result.map(drop).map_err(|error| format!("record {}: {error}", file.display()))
}
