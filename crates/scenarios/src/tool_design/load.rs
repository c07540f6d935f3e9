//! Reads a design file and the asset that it starts from, with the place of whatever is wrong.

use std::path::{Path, PathBuf};

use super::cost::Aggregate;
use super::file::DesignFile;
use crate::assets::Assets;
use crate::diagnostic::Diagnostic;
use crate::scenario::{
    Change, Context, Draft, Node, ResolvedScenario, Source, Value, asset_source, field_problem, load_text, path,
    read_draft,
};

/// Path and text of a valid file, which shows how keys are written.
pub(crate) const EXAMPLE: (&str, &str) =
    ("scenarios/designs/l_short_flips.toml", include_str!("../../../../scenarios/designs/l_short_flips.toml"));

/// A checked design file.
#[derive(Clone, Debug)]
pub struct DesignTask {
    /// Name of the new asset.
    pub name: String,
    /// Key of the scenario that names the asset which is designed.
    pub asset: String,
    /// The asset that it starts from: its file and text.
    pub start: (PathBuf, String),
    /// What may be changed.
    pub parameters: Vec<Parameter>,
    /// The measure.
    pub measure: String,
    /// Whether it is to be small.
    pub minimize: bool,
    /// What the measures of a candidate's seeds are summed up to.
    pub aggregate: Aggregate,
    /// Seeds of each candidate: the first, and how many.
    pub seeds: (u64, u64),
    /// Candidates that are tried.
    pub evaluations: usize,
    /// Seed of the search.
    pub search_seed: u64,
    /// Fresh seeds on which the best is compared with the start.
    pub check_trials: u64,
    /// The scenario as it is.
    pub scenario: ResolvedScenario,
    /// The scenario's file.
    pub scenario_file: PathBuf,
}

/// A number that may be changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its key in the asset's file.
    pub key: String,
    /// Its smallest value.
    pub min: f64,
    /// Its largest value.
    pub max: f64,
    /// Its value in the asset that the search starts from.
    pub start: f64,
}

impl DesignTask {
    /// The changes of the scenario that give the asset these values.
    #[must_use]
    pub fn changes(&self, values: &[f64]) -> Vec<Change> {
        let pairs = self.parameters.iter().zip(values);
        pairs.map(|(parameter, &value)| Change::new(format!("{}:{}", self.asset, parameter.key), value)).collect()
    }
}

/// Whether a file is a design: it has a table of that name and parameters.
#[must_use]
pub fn is_design(file: &Path) -> bool {
    let tree = Source::read(file).ok().and_then(|source| Node::parse(&source).ok());
    tree.is_some_and(|tree| tree.child("design").is_some() && tree.child("parameter").is_some())
}

/// What a design file is about, for lists; `None` if it cannot be read.
#[must_use]
pub fn design_title(file: &Path) -> Option<String> {
    let tree = Node::parse(&Source::read(file).ok()?).ok()?;
    let text = |key: &str| match &tree.at(&path(&format!("design.{key}")))?.value {
        Value::Text(text) => Some(text.clone()),
        _ => None,
    };
    let aim = text("minimize").map(|measure| format!("least {measure}"));
    let aim = aim.or_else(|| Some(format!("most {}", text("maximize")?)))?;
    Some(format!("{}: {aim} in {}", text("name")?, text("scenario")?))
}

/// Reads and checks a design file, its scenario, and the asset that it starts from.
///
/// # Errors
/// Everything that is wrong: at least one [`Diagnostic`].
pub fn load_design(file: &Path, find_assets: &dyn Fn(&Path) -> Assets) -> Result<DesignTask, Vec<Diagnostic>> {
    let source = Source::read(file).map_err(|problem| vec![*problem])?;
    let example = Source::new(EXAMPLE.0, EXAMPLE.1);
    let Draft { value, tree, mut problems } = read_draft::<DesignFile>(&source, &example);
    let (Some(value), Some(tree)) = (value, tree) else { return Err(problems) };
    let context = Context { source: &source, tree: &tree, example: &example };
    problems.extend(value.refused().into_iter().map(|error| field_problem(context, error)));
    if !problems.is_empty() {
        return Err(problems);
    }
    let scenario_file = file.parent().unwrap_or(Path::new("")).join(&value.design.scenario);
    let assets = find_assets(&scenario_file);
    let scenario_source = Source::read(&scenario_file).map_err(|problem| vec![*problem])?;
    let scenario = load_text(&scenario_file, &scenario_source.text, &[], &assets)?;
    let start = asset_source(&scenario, &value.design.asset, &assets).ok_or_else(|| {
        let key = path("design.asset");
        let problem = context.problem_at_value(&key, "the scenario names no such asset");
        let known = scenario.assets.iter().map(|asset| asset.key.as_str()).collect::<Vec<_>>().join("`, `");
        vec![problem.found(format!("{:?}", value.design.asset)).expected(format!("one of `{known}`"))]
    })?;
    let start_tree = Node::parse(&start).map_err(|problem| vec![*problem])?;
    let mut parameters = Vec::new();
    for (index, parameter) in value.parameters.iter().enumerate() {
        match number_at(&start_tree, &parameter.key) {
            Some(start) if (parameter.min..=parameter.max).contains(&start) => {
                parameters.push(Parameter { key: parameter.key.clone(), min: parameter.min, max: parameter.max, start })
            }
            found => problems.push(bad_start(context, index, found, &start.file)),
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let head = value.design;
    let minimize = head.minimize.is_some();
    Ok(DesignTask {
        name: head.name,
        asset: head.asset,
        start: (start.file.clone(), start.text.to_string()),
        parameters,
        measure: head.minimize.or(head.maximize).unwrap_or_default(),
        minimize,
        aggregate: head.judged_by,
        seeds: (head.first_seed.unwrap_or(scenario.header().seed), head.trials),
        evaluations: head.evaluations,
        search_seed: head.seed,
        check_trials: head.check_trials,
        scenario,
        scenario_file,
    })
}

fn number_at(tree: &Node, key: &str) -> Option<f64> {
    match tree.at(&path(key))?.value {
        Value::Float(number) => Some(number),
        Value::Integer(number) => Some(number as f64),
        _ => None,
    }
}

fn bad_start(context: Context<'_>, index: usize, found: Option<f64>, file: &Path) -> Diagnostic {
    match found {
        None => context
            .problem_at_value(&path(&format!("parameter.{index}.key")), "there is no such number to start from")
            .expected(format!("the path of a number in {}", file.display())),
        Some(start) => context
            .problem_at_value(&path(&format!("parameter.{index}.min")), "the start lies outside the range")
            .found(start.to_string())
            .expected("a range that holds it: widen min or max"),
    }
}
