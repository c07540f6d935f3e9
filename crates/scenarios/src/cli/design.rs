//! `wield design`: chooses parameters of a tool for a scenario, and compares the best tool with the one it started from.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use super::comparing::{Comparing, RecordedSeed};
use super::{Exit, assets_for, interrupt, keep_json, panics, say, say_aside, say_error, say_problems, unwritable};
use crate::assets::Assets;
use crate::campaign::{Attempt, CampaignFolder, Factor, InvalidPoints, Row, plan};
use crate::files::{prepare_folder, write_whole};
use crate::scenario::ResolvedScenario;
use crate::tool_design::{
    Candidate, DESIGN_SCHEMA, DesignReport, DesignTask, Trying, TryingError, designed_asset, load_design, search,
};
use crate::trials::Status;

pub const AFTER_HELP: &str = "\
A design file names a scenario, the key in it that names the tool, the measure, and the numbers in the tool's file that may be
changed, each with its range:
  [design]
  name = \"l_designed\"                  # of the new tool
  scenario = \"../push_transfer_l.toml\" # relative to the design file
  asset = \"tool.asset\"                 # knife.asset, source.asset, …: whatever names a file of the assets
  minimize = \"duration_s\"              # or maximize
  judged_by = \"mean\"                   # of the seeds; or \"worst\", or { quantile = 0.9 }
  trials = 4                           # seeds of each candidate; one with more failed runs is worse, whatever it measures
  evaluations = 40                     # candidates
  [[parameter]]
  key = \"family.l.arm_m\"
  min = 0.030
  max = 0.055

The search is CMA-ES. Every run is kept: interrupted, the same command goes on where it was. The best tool is compared with the
start on check_trials seeds that the search never saw.

Files, in DIR (by default runs/design-<name> in the current folder):
  <name>.toml       the best tool; copied into the assets by --install
  design.json       all candidates
  check/            the comparison: report.html, comparison.json, recording.rrd

Examples:
  wield design scenarios/designs/l_short_flips.toml
  wield design scenarios/designs/l_short_flips.toml --install

Exit codes: 0 a better tool was found, 1 none was, 2 bad input (nothing written), 3 results could not be written, 130 Ctrl-C.";

/// Options of `wield design`.
#[derive(Debug, clap::Args)]
pub struct DesignArguments {
    /// Design file
    file: PathBuf,
    /// Folder for results [default: runs/design-<name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads; results do not depend on it [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,
    /// Copy the best tool into the folder of assets
    #[arg(long)]
    install: bool,
    /// Do not record the comparison
    #[arg(long)]
    no_record: bool,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// Searches, writes the best tool, compares it with the start.
pub fn execute(arguments: &DesignArguments, assets: Option<&Path>) -> Exit {
    let task = match load_design(&arguments.file, &|scenario| assets_for(assets, Some(scenario))) {
        Ok(task) => task,
        Err(problems) => {
            say_problems(&problems);
            return Exit::BadInput;
        }
    };
    let assets = assets_for(assets, Some(&task.scenario_file));
    let out = arguments.out.clone().unwrap_or_else(|| Path::new("runs").join(format!("design-{}", task.name)));
    let job = Job { arguments, task, assets, out };
    job.run().unwrap_or_else(|exit| exit)
}

struct Job<'a> {
    arguments: &'a DesignArguments,
    task: DesignTask,
    assets: Assets,
    out: PathBuf,
}

impl Job<'_> {
    fn run(&self) -> Result<Exit, Exit> {
        let installed = self.install_path()?;
        prepare_folder(&self.out).map_err(|error| {
            say_error(&unwritable(&self.out, &error, "--out"));
            Exit::BadInput
        })?;
        let stop = interrupt::watch();
        let threads = self.arguments.threads.map_or(0, usize::from);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| {
            say_error(&format!("start threads: {error}; lower --threads"));
            Exit::Crashed
        })?;
        let report = pool.install(|| self.search(&stop)).map_err(|error| self.stopped_by(&error))?;
        let best = report.candidates.get(report.best).map(|best| best.values.clone()).unwrap_or_default();
        let text = designed_asset(&self.task, &best).map_err(|reason| {
            say_error(&reason);
            Exit::Crashed
        })?;
        let kept = keep_json(&self.out.join("design.json"), &report);
        self.write(&self.out.join(format!("{}.toml", self.task.name)), &text)?;
        self.say(&format!("{}\n", table(&self.task, &report)));
        if report.best == 0 {
            self.say("no candidate was better than the start\n");
            return Ok(kept.unless_missed(false));
        }
        if let Some(path) = installed {
            self.write(&path, &text)?;
            self.say(&format!("installed: {}\n", path.display()));
        }
        self.compare(&best)
    }

    /// Where the best tool is installed, if that is wanted.
    fn install_path(&self) -> Result<Option<PathBuf>, Exit> {
        if !self.arguments.install {
            return Ok(None);
        }
        let path = self.task.start.0.with_file_name(format!("{}.toml", self.task.name));
        if path.exists() {
            say_error(&format!("--install: {} is there already; give the design another name", path.display()));
            return Err(Exit::BadInput);
        }
        Ok(Some(path))
    }

    fn search(&self, stop: &AtomicBool) -> Result<DesignReport, TryingError> {
        let run = |scenario: &ResolvedScenario, seed: u64| -> Attempt {
            panics::catch(|| crate::pipeline::run(scenario, seed, &mut (), &|_, _| {}))
        };
        let mut trying = Trying::begin(&self.out.join("journal"), &self.task, &self.assets, &run, stop)?;
        let mut candidates: Vec<Candidate> = Vec::new();
        let mut costs: Vec<f64> = Vec::new();
        let mut evaluate = |values: &[f64]| -> Result<f64, TryingError> {
            let (candidate, cost) = match trying.rows(values)? {
                Ok(rows) => {
                    if candidates.is_empty() {
                        self.check_measure(&rows)?;
                    }
                    (self.candidate(values, &rows), trying.cost(&rows))
                }
                Err(refused) => {
                    let none = Candidate {
                        values: values.to_vec(),
                        successes: 0,
                        trials: 0,
                        measure: None,
                        refused: Some(refused),
                    };
                    (none, trying.cost(&[]) * 2.0)
                }
            };
            self.tell(candidates.len(), &candidate);
            candidates.push(candidate);
            costs.push(cost);
            Ok(cost)
        };
        search(&self.task.parameters, self.task.evaluations, self.task.search_seed, &mut evaluate)?;
        let best = (0..costs.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b])).unwrap_or(0);
        Ok(DesignReport {
            schema: DESIGN_SCHEMA.into(),
            name: self.task.name.clone(),
            scenario: self.task.scenario.name.clone(),
            measure: self.task.measure.clone(),
            minimize: self.task.minimize,
            parameters: self.task.parameters.iter().map(|parameter| parameter.key.clone()).collect(),
            candidates,
            best,
        })
    }

    /// A measure that no run of the start has is a slip of the pen.
    fn check_measure(&self, rows: &[Row]) -> Result<(), TryingError> {
        let known: Vec<&str> = rows.iter().flat_map(|row| &row.measures).map(|measure| measure.name.as_str()).collect();
        if known.is_empty() || known.contains(&self.task.measure.as_str()) {
            return Ok(());
        }
        let known = rows.iter().map(|row| &row.measures).max_by_key(|measures| measures.len());
        let known = known.into_iter().flatten().map(|measure| measure.name.as_str()).collect::<Vec<_>>().join(", ");
        Err(TryingError::NoMeasure { measure: self.task.measure.clone(), known })
    }

    fn candidate(&self, values: &[f64], rows: &[Row]) -> Candidate {
        let measured = rows.iter().filter_map(|row| row.value(&self.task.measure));
        let sign = if self.task.minimize { 1.0 } else { -1.0 };
        Candidate {
            values: values.to_vec(),
            successes: rows.iter().filter(|row| row.status == Status::Success).count(),
            trials: rows.len(),
            measure: self.task.aggregate.of(measured.map(|value| sign * value).collect()).map(|cost| sign * cost),
            refused: None,
        }
    }

    /// Tells of a candidate while the search goes on.
    fn tell(&self, place: usize, candidate: &Candidate) {
        if self.arguments.quiet {
            return;
        }
        let numbers: Vec<String> = candidate.values.iter().map(|value| format!("{value:.5}")).collect();
        let came_to = match (&candidate.refused, candidate.measure) {
            (Some(_), _) => "no tool".to_owned(),
            (None, None) => "nothing measured".to_owned(),
            (None, Some(value)) => format!("{} {value:.4}", self.task.measure),
        };
        let Candidate { successes, trials, .. } = candidate;
        let count = self.task.evaluations;
        say_aside(&format!(
            "{} of {count}: [{}] {came_to}; {successes} of {trials} succeeded",
            place + 1,
            numbers.join(", ")
        ));
    }

    /// Compares the best with the start on fresh seeds.
    fn compare(&self, best: &[f64]) -> Result<Exit, Exit> {
        let (first, trials) = self.task.seeds;
        let fresh = first + trials..first + trials + self.task.check_trials;
        let start: Vec<f64> = self.task.parameters.iter().map(|parameter| parameter.start).collect();
        let point =
            |values: &[f64]| -> Vec<toml::Value> { values.iter().map(|&value| toml::Value::Float(value)).collect() };
        let points: Vec<_> = [start.as_slice(), best]
            .iter()
            .flat_map(|values| fresh.clone().map(|seed| (point(values), seed)))
            .collect();
        let changes = self.task.changes(best);
        let factors = changes.into_iter().map(|change| Factor { key: change.key }).collect();
        let (scenario, file) = (&self.task.scenario, &self.task.scenario_file);
        let manifest = plan(scenario, file, &self.assets, factors, &points, InvalidPoints::Refuse, &|_| {}).map_err(
            |refused| {
                say_problems(&refused.problems);
                Exit::Crashed
            },
        )?;
        let start_name = self.task.start.0.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Comparing {
            title: format!("{} against {start_name}, from which it was designed", self.task.name),
            scenario: self.task.scenario.name.clone(),
            assets: &self.assets,
            manifest,
            names: vec![start_name, self.task.name.clone()],
            folder: CampaignFolder::at(self.out.join("check")),
            measures: vec![self.task.measure.clone()],
            threads: self.arguments.threads,
            record: if self.arguments.no_record { RecordedSeed::None } else { RecordedSeed::First },
            json: false,
            quiet: self.arguments.quiet,
        }
        .run()
    }

    fn write(&self, path: &Path, text: &str) -> Result<(), Exit> {
        write_whole(path, text.as_bytes()).map_err(|error| {
            say_error(&format!("write {}: {error}", path.display()));
            Exit::Crashed
        })
    }

    fn say(&self, text: &str) {
        if !self.arguments.quiet {
            say(text);
        }
    }

    fn stopped_by(&self, error: &TryingError) -> Exit {
        match error {
            TryingError::Stopped => {
                say_aside(&format!("stopped; go on with: wield design {}", self.arguments.file.display()));
                Exit::Interrupted
            }
            TryingError::NoMeasure { .. } => {
                say_error(&error.to_string());
                Exit::BadInput
            }
            TryingError::Io(_) | TryingError::Search(_) => {
                say_error(&error.to_string());
                Exit::Crashed
            }
        }
    }
}

/// Start and best side by side.
fn table(task: &DesignTask, report: &DesignReport) -> String {
    let (start, best) = (report.candidates.first(), report.candidates.get(report.best));
    let mut text = format!("{} candidates; {:<24} {:>12} {:>12}\n", report.candidates.len(), "", "start", task.name);
    for (index, parameter) in task.parameters.iter().enumerate() {
        let value = |candidate: Option<&Candidate>| {
            candidate
                .and_then(|candidate| candidate.values.get(index))
                .map_or_else(String::new, |value| format!("{value:.5}"))
        };
        text += &format!("{:<38} {:>12} {:>12}\n", parameter.key, value(start), value(best));
    }
    let measured = |candidate: Option<&Candidate>| {
        candidate
            .and_then(|candidate| candidate.measure)
            .map_or_else(|| "none".to_owned(), |value| format!("{value:.4}"))
    };
    text + &format!("{:<38} {:>12} {:>12}", task.measure, measured(start), measured(best))
}
