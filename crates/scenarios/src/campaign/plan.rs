//! Planning a campaign: each distinct point is read as a scenario before anything is run.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::identity::invalid_run_id;
use super::{Base, CAMPAIGN_SCHEMA, Factor, Manifest, PlannedRun, RunId, run_id};
use crate::assets::Assets;
use crate::diagnostic::Diagnostic;
use crate::scenario::{Change, ResolvedScenario, load_text};

/// Problems with one point that its rows tell.
const TOLD_PROBLEMS: usize = 3;

/// What becomes of a point whose values make no valid scenario.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InvalidPoints {
    /// Nothing is planned.
    Refuse,
    /// Its runs become rows with the status `invalid` and the reason; the other points are run. If no point makes a valid
    /// scenario, nothing is planned.
    Record,
}

/// Why a campaign cannot be planned: a point of it makes no valid scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct InvalidPoint {
    /// Index of its first run.
    pub index: usize,
    /// What is wrong; at least one.
    pub problems: Vec<Diagnostic>,
}

/// Plans a campaign: one run for each of `points`, which are values of the factors with a seed.
///
/// Each distinct point is loaded, so that what would be refused is found here, before anything is run. `progress` is
/// told how many points have been looked at.
///
/// # Errors
/// The first point that makes no valid scenario, if such points are refused or if no point makes one.
pub fn plan(
    scenario: &ResolvedScenario,
    file: &Path,
    assets: &Assets,
    factors: Vec<Factor>,
    points: &[(Vec<toml::Value>, u64)],
    invalid: InvalidPoints,
    progress: &dyn Fn(usize),
) -> Result<Manifest, InvalidPoint> {
    let base = Base {
        schema: CAMPAIGN_SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        scenario: scenario.name.clone(),
        task: scenario.kind().into(),
        file: file.to_owned(),
        assets: assets.root().to_owned(),
        text: scenario.source.clone(),
        factors,
        runs: points.len() as u64,
    };
    let mut manifest = Manifest { base, runs: Vec::with_capacity(points.len()) };
    let mut first_invalid = None;
    let mut last: Option<(&[toml::Value], Point)> = None;
    for (index, (values, seed)) in points.iter().enumerate() {
        let refused = |problems| InvalidPoint { index, problems };
        let point = match last.take() {
            Some((same, point)) if same == values.as_slice() => point,
            _ => match Point::read(&manifest.base, values, assets) {
                Ok(point) => point,
                Err(problems) if invalid == InvalidPoints::Refuse => return Err(refused(problems)),
                Err(problems) => {
                    let point = Point::invalid(&manifest.base, values, assets);
                    first_invalid.get_or_insert(refused(problems));
                    point
                }
            },
        };
        let run_id =
            point.run_id(&manifest.base, *seed).map_err(|reason| refused(vec![Diagnostic::of_file(file, reason)]))?;
        let invalid = point.reasons().to_vec();
        manifest.runs.push(PlannedRun { index: index as u64, run_id, seed: *seed, values: values.clone(), invalid });
        last = Some((values, point));
        progress(index + 1);
    }
    match first_invalid {
        Some(first) if manifest.runs.iter().all(|run| !run.invalid.is_empty()) => Err(first),
        _ => Ok(manifest),
    }
}

/// What the values of a point make.
enum Point {
    Valid(Box<ResolvedScenario>),
    Invalid { changes: Vec<Change>, reasons: Vec<String> },
}

impl Point {
    fn read(base: &Base, values: &[toml::Value], assets: &Assets) -> Result<Self, Vec<Diagnostic>> {
        let loaded = load_text(&base.file, &base.text, &changes(base, values), assets)?;
        Ok(Self::Valid(Box::new(loaded)))
    }

    /// The reasons name files without the folders in which they happened to be: whoever plans the same tells the same.
    fn invalid(base: &Base, values: &[toml::Value], assets: &Assets) -> Self {
        let changes = changes(base, values);
        let file = base.file.file_name().map_or(base.file.as_path(), Path::new);
        let problems = load_text(file, &base.text, &changes, assets).err().unwrap_or_default();
        let root = format!("{}{}", assets.root().display(), std::path::MAIN_SEPARATOR);
        let told = problems.iter().take(TOLD_PROBLEMS).map(|problem| problem.to_string().replace(&root, ""));
        let mut reasons: Vec<String> = told.collect();
        if reasons.is_empty() {
            reasons.push("the scenario cannot be read with these values".into());
        }
        Self::Invalid { changes, reasons }
    }

    fn reasons(&self) -> &[String] {
        match self {
            Self::Valid(_) => &[],
            Self::Invalid { reasons, .. } => reasons,
        }
    }

    fn run_id(&self, base: &Base, seed: u64) -> Result<RunId, String> {
        match self {
            Self::Valid(scenario) => run_id(scenario, seed),
            Self::Invalid { changes, .. } => Ok(invalid_run_id(&base.text, changes, seed)),
        }
    }
}

fn changes(base: &Base, values: &[toml::Value]) -> Vec<Change> {
    base.factors.iter().zip(values).map(|(factor, value)| Change::new(&factor.key, value.clone())).collect()
}
