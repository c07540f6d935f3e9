//! `wield compare`: the same scenario and seeds with different tools or other values.

use std::path::{Path, PathBuf};

use super::comparing::{Comparing, RecordedSeed, refuse};
use super::{Exit, assets_for, load_told, say_problems};
use crate::assets::Assets;
use crate::campaign::{CampaignFolder, Factor, InvalidPoints, Manifest, plan};
use crate::comparison::{Variation, points, variant_names};
use crate::scenario::{LARGEST_SEED, ResolvedScenario};

pub const AFTER_HELP: &str = "\
Every variant runs the same seeds, under the scenario's [variation]; the others are compared with the first, seed by seed.
Several --vary give every combination of their values. A bare name in the place of a table that names an asset changes that
name (tool=l); in the place of a kind with options it stands for that kind with its defaults, if it has any. A key may go on in
the file that its value names: tool.asset:family.l.arm_m=0.03,0.04.

Files, in DIR (by default runs/compare-<scenario> in the current folder):
  report.html              what came out, with pictures: opens in any browser, without a network
  comparison.json          the same for programs; the same runs give the same bytes
  recording.rrd            one seed of every variant side by side, for the Rerun viewer
  results.parquet          a row for each run, with every measure
  manifest.jsonl, journal/ what is to be run, and what was: the same command goes on where it was stopped

Examples:
  wield compare scenarios/push_compare.toml --tool stick --tool l --tool paddle_flat
  wield compare scenarios/push_transfer_l.toml --vary tool.asset:family.l.arm_m=0.03,0.04,0.05 --trials 50
  wield compare scenarios/push_compare.toml --vary execution.mode=closed_loop,open_loop --measure duration_s
  wield compare scenarios/cut_grape.toml --tool paring --tool serrated --trials 10 --json | jq .success

Exit codes: 0 compared, whatever came out; 2 bad input (nothing written, but for the\nfirst run of each variant if --measure names none that these have); 3 a run crashed, or results could not be written.";

/// Options of `wield compare`.
#[derive(Debug, clap::Args)]
pub struct CompareArguments {
    /// Scenario file
    file: PathBuf,
    /// A tool to compare: one file of the assets; for cuts a knife, for pours the vessel in the hand
    #[arg(long = "tool", value_name = "NAME")]
    tools: Vec<String>,
    /// A key of the scenario, and the values to compare
    #[arg(long, value_name = "KEY=V1,V2,…")]
    vary: Vec<Variation>,
    /// Number of trials of each variant, with seeds that follow each other
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    trials: u32,
    /// Seed of the first trial [default: the scenario's]
    #[arg(long, value_name = "N", visible_alias = "seed", value_parser = clap::value_parser!(u64).range(..=LARGEST_SEED))]
    first_seed: Option<u64>,
    /// Folder for results [default: runs/compare-<scenario>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads; results do not depend on it [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,
    /// Compare this measure, too, though it is not judged
    #[arg(long = "measure", value_name = "NAME")]
    measures: Vec<String>,
    /// Do not record
    #[arg(long)]
    no_record: bool,
    /// Seed of the runs that are recorded [default: the first that every variant carried out]
    #[arg(long, value_name = "N", conflicts_with = "no_record", value_parser = clap::value_parser!(u64).range(..=LARGEST_SEED))]
    record_seed: Option<u64>,
    /// Print the result as JSON instead of tables
    #[arg(long)]
    json: bool,
    /// Print nothing but errors
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,
}

/// Plans all runs, makes those that are not done yet, compares, reports.
pub fn execute(arguments: &CompareArguments, assets: Option<&Path>) -> Exit {
    let Some(scenario) = load_told(&arguments.file, assets) else { return Exit::BadInput };
    let assets = assets_for(assets, Some(&arguments.file));
    let ended = comparing(arguments, &scenario, &assets).and_then(|comparing| comparing.run());
    ended.unwrap_or_else(|exit| exit)
}

/// Checks all that could be wrong, and plans the runs.
fn comparing<'a>(
    arguments: &CompareArguments,
    scenario: &ResolvedScenario,
    assets: &'a Assets,
) -> Result<Comparing<'a>, Exit> {
    let variations = variations(arguments, scenario).map_err(refuse)?;
    let seeds = seeds(arguments, scenario).map_err(refuse)?;
    let points = points(&variations);
    if points.len() < 2 {
        return Err(refuse("found one variant; expected at least two: give --tool twice, or --vary KEY=V1,V2".into()));
    }
    let factors = variations.iter().map(|variation| Factor { key: variation.key.clone() }).collect();
    let with_seeds = |point: Vec<toml::Value>| seeds.iter().map(move |seed| (point.clone(), *seed));
    let runs: Vec<_> = points.into_iter().flat_map(with_seeds).collect();
    let planned = plan(scenario, &arguments.file, assets, factors, &runs, InvalidPoints::Refuse, &|_| {});
    let manifest = planned.map_err(|refused| {
        say_problems(&refused.problems);
        Exit::BadInput
    })?;
    let names = variant_names(&variations);
    refuse_equal(&manifest, &names).map_err(refuse)?;
    let default = || Path::new("runs").join(format!("compare-{}", scenario.name));
    Ok(Comparing {
        title: scenario.header().title.clone(),
        scenario: scenario.name.clone(),
        assets,
        manifest,
        names,
        folder: CampaignFolder::at(arguments.out.clone().unwrap_or_else(default)),
        measures: arguments.measures.clone(),
        threads: arguments.threads,
        record: match (arguments.no_record, arguments.record_seed) {
            (true, _) => RecordedSeed::None,
            (false, None) => RecordedSeed::First,
            (false, Some(seed)) => RecordedSeed::This(seed),
        },
        json: arguments.json,
        quiet: arguments.quiet,
    })
}

/// All that is varied: the tools first.
fn variations(arguments: &CompareArguments, scenario: &ResolvedScenario) -> Result<Vec<Variation>, String> {
    let mut variations = Vec::new();
    if !arguments.tools.is_empty() {
        let key = scenario
            .tool_key()
            .ok_or_else(|| format!("--tool: a task of kind `{}` holds no tool; use --vary", scenario.kind()))?;
        let tools = arguments.tools.iter().map(|name| toml::Value::from(name.as_str())).collect();
        variations.push(Variation::new(key, tools).map_err(|reason| format!("--tool: {reason}"))?);
    }
    variations.extend(arguments.vary.iter().cloned());
    let twice = variations
        .iter()
        .enumerate()
        .find(|(index, variation)| variations.iter().take(*index).any(|other| other.key == variation.key));
    match twice {
        Some((_, variation)) => {
            Err(format!("`{}` is varied twice; give all its values at once: KEY=V1,V2,…", variation.key))
        }
        None => Ok(variations),
    }
}

fn seeds(arguments: &CompareArguments, scenario: &ResolvedScenario) -> Result<Vec<u64>, String> {
    let (first, trials) = (arguments.first_seed.unwrap_or(scenario.header().seed), u64::from(arguments.trials));
    if first > LARGEST_SEED - (trials - 1) {
        return Err(format!("--trials {trials}: the last seed would be above {LARGEST_SEED}; lower --first-seed"));
    }
    Ok((first..first + trials).collect())
}

/// Refuses variants that are the same scenario in other words.
fn refuse_equal(manifest: &Manifest, names: &[String]) -> Result<(), String> {
    let per_variant = (manifest.runs.len() / names.len().max(1)).max(1);
    let firsts: Vec<_> = manifest.runs.iter().step_by(per_variant).zip(names).collect();
    for (index, (run, name)) in firsts.iter().enumerate() {
        if let Some((_, other)) = firsts.iter().take(index).find(|(other, _)| other.run_id == run.run_id) {
            return Err(format!("the variants `{other}` and `{name}` are the same scenario; expected different ones"));
        }
    }
    Ok(())
}
