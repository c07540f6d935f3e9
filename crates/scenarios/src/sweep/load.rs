//! Reads a sweep file and plans its runs, with the place of whatever is wrong.

use std::path::{Path, PathBuf};

use toml::Value;

use super::factor::Factor;
use super::file::{Design, SweepFile};
use crate::assets::Assets;
use crate::campaign::{self, InvalidPoint, InvalidPoints, Manifest};
use crate::diagnostic::Diagnostic;
use crate::scenario::{
    Change, Context, Draft, LARGEST_SEED, Node, ResolvedScenario, Source, field_problem, load_text, name_of_file, path,
    read_draft,
};
use crate::suggest::listed;

/// Path and text of a valid file, which shows how keys are written.
pub(crate) const EXAMPLE: (&str, &str) =
    ("scenarios/sweeps/push_friction.toml", include_str!("../../../../scenarios/sweeps/push_friction.toml"));

/// Problems with one point that are shown.
const SHOWN_PROBLEMS: usize = 3;

/// First and last points that are looked at to tell a bad point from a bad key.
const ENDS: usize = 4;

/// How a sweep goes on without points that make no valid scenario.
const RECORD: &str =
    "`invalid_points = \"record\"` in [sweep] runs the other points, and keeps such ones as rows of status invalid";

/// A checked sweep file.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Name in results and of their folder.
    pub name: String,
    /// How points are made.
    pub design: Design,
    /// What is varied.
    pub factors: Vec<Factor>,
    /// Seeds at each point.
    pub trials: u64,
    /// The first of them.
    pub first_seed: u64,
    /// What becomes of points that make no valid scenario.
    pub invalid_points: InvalidPoints,
    /// The scenario without any change.
    pub scenario: ResolvedScenario,
    /// The scenario's file.
    pub scenario_file: PathBuf,
    source: Source,
    tree: Node,
}

/// Whether a file is a sweep: it has a table of that name and no task.
#[must_use]
pub fn is_sweep(file: &Path) -> bool {
    let tree = Source::read(file).ok().and_then(|source| Node::parse(&source).ok());
    tree.is_some_and(|tree| tree.child("sweep").is_some() && tree.child("task").is_none())
}

/// What a sweep file does, for lists: design and factors; `None` if it cannot be read that far.
#[must_use]
pub fn sweep_title(file: &Path) -> Option<String> {
    let source = Source::read(file).ok()?;
    let read = read_draft::<SweepFile>(&source, &source).value?;
    let keys: Vec<String> = read.factors.iter().map(|factor| factor.key.clone()).collect();
    let trials = read.sweep.trials;
    let design = read.design.name().replace('_', " ");
    Some(format!("{} with {} ({design}), {trials} seeds each", read.sweep.scenario, listed(&keys)))
}

/// Reads and checks a sweep file and the scenario that it names; `find_assets` finds the assets of a scenario.
///
/// # Errors
/// Everything that is wrong: at least one [`Diagnostic`].
pub fn load_sweep(file: &Path, find_assets: &dyn Fn(&Path) -> Assets) -> Result<Sweep, Vec<Diagnostic>> {
    let source = Source::read(file).map_err(|problem| vec![without_scenario(*problem)])?;
    if Node::parse(&source).is_ok_and(|tree| tree.child("task").is_some() && tree.child("sweep").is_none()) {
        let problem =
            Diagnostic::of_file(file, "this is a scenario, not a sweep").expected("a file with a table [sweep]");
        let help = format!("several seeds of one scenario are run by `wield run {} --trials 20`", file.display());
        return Err(vec![problem.help([help])]);
    }
    let example = Source::new(EXAMPLE.0, EXAMPLE.1);
    let Draft { value, tree, problems } = read_draft::<SweepFile>(&source, &example);
    // what is checked below may be missing only because it could not be read
    let (Some(value), Some(tree), true) = (value, tree, problems.is_empty()) else { return Err(problems) };
    let context = Context { source: &source, tree: &tree, example: &example };
    let factors = value.check().map_err(|refused| {
        let mut problems: Vec<Diagnostic> = refused.into_iter().map(|error| field_problem(context, error)).collect();
        problems.sort_by_key(|problem| problem.place.as_ref().map(|place| place.span.start));
        problems
    })?;
    let scenario_file = file.parent().unwrap_or(Path::new("")).join(&value.sweep.scenario);
    let scenario = base(context, &scenario_file, &find_assets(&scenario_file))?;
    let first_seed = value.sweep.first_seed.unwrap_or(scenario.header().seed);
    if first_seed > LARGEST_SEED - (value.sweep.trials - 1) {
        let problem = context.problem_at_value(&path("sweep.trials"), "the last seed is too large");
        return Err(vec![
            problem.found(first_seed.to_string()).expected(format!("a first_seed that leaves it at {LARGEST_SEED}")),
        ]);
    }
    let name = value.sweep.name.clone().unwrap_or_else(|| name_of_file(file));
    let (trials, design) = (value.sweep.trials, value.design);
    let invalid_points = value.sweep.invalid_points.unwrap_or(design.invalid_points());
    Ok(Sweep { name, design, factors, trials, first_seed, invalid_points, scenario, scenario_file, source, tree })
}

/// A file that cannot be read was expected to be a sweep.
fn without_scenario(problem: Diagnostic) -> Diagnostic {
    match problem.expected.as_str() {
        "a scenario file" => problem.expected("a sweep file, or the folder of a campaign"),
        _ => problem,
    }
}

/// The scenario that a sweep names, before anything is changed.
fn base(context: Context<'_>, file: &Path, assets: &Assets) -> Result<ResolvedScenario, Vec<Diagnostic>> {
    let key = path("sweep.scenario");
    let named = context.problem_at_value(&key, "");
    let source = Source::read(file).map_err(|problem| {
        let problem = Diagnostic { file: named.file.clone(), place: named.place.clone(), ..*problem };
        vec![Diagnostic { title: format!("{} cannot be used: {}", file.display(), problem.title), ..problem }]
    })?;
    let line = named.place.as_ref().map_or(0, |place| place.line);
    let remark = format!("{}:{line} names this file", context.source.file.display());
    load_text(file, &source.text, &[], assets)
        .map_err(|problems| problems.into_iter().map(|problem| problem.help([remark.clone()])).collect())
}

impl Sweep {
    /// The points: for each a value of every factor.
    #[must_use]
    pub fn points(&self) -> Vec<Vec<Value>> {
        self.design.values(&self.factors)
    }

    /// Plans every run: for each point all seeds. `progress` is told how many runs have been looked at.
    ///
    /// # Errors
    /// What is wrong with the first point that makes no valid scenario, at the factor that is at fault if it is a single
    /// one: if such points are refused, or if there is no other point.
    pub fn plan(&self, assets: &Assets, progress: &dyn Fn(usize, usize)) -> Result<Manifest, Vec<Diagnostic>> {
        let seeds = self.first_seed..self.first_seed + self.trials;
        let points = self.points();
        let runs: Vec<(Vec<Value>, u64)> =
            points.iter().flat_map(|point| seeds.clone().map(|seed| (point.clone(), seed))).collect();
        let count = |done: usize| progress(done, runs.len());
        let factors = self.factors.iter().map(|factor| campaign::Factor { key: factor.key.clone() }).collect();
        let planned =
            campaign::plan(&self.scenario, &self.scenario_file, assets, factors, &runs, self.invalid_points, &count);
        planned.map_err(|refused| self.explained(refused, &points, assets))
    }

    /// What is wrong with a point: blamed on a factor if one alone is at fault, with its values and how to go on without it.
    fn explained(&self, refused: InvalidPoint, points: &[Vec<Value>], assets: &Assets) -> Vec<Diagnostic> {
        let place = refused.index / usize::try_from(self.trials).unwrap_or(1).max(1);
        let Some(point) = points.get(place).filter(|point| !point.is_empty()) else { return refused.problems };
        let values: Vec<String> =
            self.factors.iter().zip(point).map(|(factor, value)| format!("{} = {value}", factor.key)).collect();
        let which = format!("this is point {} of {}: {}", place + 1, points.len(), values.join(", "));
        let remedy = match self.invalid_points {
            InvalidPoints::Record => Some("no point of the sweep makes a valid scenario"),
            InvalidPoints::Refuse if self.has_valid_ends(points, assets) => Some(RECORD),
            InvalidPoints::Refuse => None,
        };
        let problems = self.blamed(point, assets).map_or(refused.problems, |problem| vec![problem]);
        let helps = || [which.clone()].into_iter().chain(remedy.map(str::to_owned));
        problems.into_iter().map(|problem| problem.help(helps())).collect()
    }

    /// Whether some of the first or last points make valid scenarios: where a key is misspelled, none does.
    fn has_valid_ends(&self, points: &[Vec<Value>], assets: &Assets) -> bool {
        let is_valid = |point: &Vec<Value>| {
            let pairs = self.factors.iter().zip(point);
            let changes: Vec<Change> = pairs.map(|(factor, value)| Change::new(&factor.key, value.clone())).collect();
            load_text(&self.scenario_file, &self.scenario.source, &changes, assets).is_ok()
        };
        points.iter().take(ENDS).chain(points.iter().rev().take(ENDS)).any(is_valid)
    }

    /// The factor whose value alone makes a scenario that cannot be run.
    fn blamed(&self, point: &[Value], assets: &Assets) -> Option<Diagnostic> {
        let problems_with = |key: &str, value: &Value| {
            let changes = [Change::new(key, value.clone())];
            load_text(&self.scenario_file, &self.scenario.source, &changes, assets).err()
        };
        let pairs = self.factors.iter().zip(point).enumerate();
        let (index, key, value, problems) = pairs
            .filter_map(|(index, (factor, value))| {
                Some((index, &factor.key, value, problems_with(&factor.key, value)?))
            })
            .next()?;
        let context = Context { source: &self.source, tree: &self.tree, example: &self.source };
        let place = self.place_of(index, value, |other| problems_with(key, other).is_none());
        let problem = context.problem_at_value(&place, format!("the scenario cannot be run with {key} = {value}"));
        Some(problem.help(problems.iter().take(SHOWN_PROBLEMS).map(ToString::to_string)))
    }

    /// Where a factor states a value; its key, if it states none, or if no other value of its list would do either.
    fn place_of(&self, index: usize, value: &Value, is_good: impl Fn(&Value) -> bool) -> Vec<String> {
        let key = path(&format!("factor.{index}.key"));
        let Some(super::factor::Values::List(values)) = self.factors.get(index).map(|factor| &factor.values) else {
            return key;
        };
        match values.iter().position(|other| other == value) {
            Some(entry) if values.iter().any(|other| other != value && is_good(other)) => {
                path(&format!("factor.{index}.values.{entry}"))
            }
            _ => key,
        }
    }
}

#[cfg(test)]
#[path = "load_tests.rs"]
mod tests;
