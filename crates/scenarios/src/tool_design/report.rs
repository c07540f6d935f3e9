//! What a design came to: the candidates that were tried, and the best one as an asset.

use serde::Serialize;
use toml_edit::{DocumentMut, value};

use super::DesignTask;

/// Version of the layout of `design.json`.
pub const DESIGN_SCHEMA: &str = "wield.design/1";

/// Result of a design, as written to `design.json`. Holds no clock time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignReport {
    /// Version of this layout: [`DESIGN_SCHEMA`].
    pub schema: String,
    /// Name of the new asset.
    pub name: String,
    /// Name of the scenario.
    pub scenario: String,
    /// The measure.
    pub measure: String,
    /// Whether it is to be small.
    pub minimize: bool,
    /// Keys of the parameters in the asset's file.
    pub parameters: Vec<String>,
    /// The candidates, as they were tried; the first is the start.
    pub candidates: Vec<Candidate>,
    /// Place of the best of them, from 0.
    pub best: usize,
}

/// A candidate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Candidate {
    /// Values of the parameters.
    pub values: Vec<f64>,
    /// Runs that kept all limits.
    pub successes: usize,
    /// Runs that were made.
    pub trials: usize,
    /// What the measure sums up to; `null` if no run has it.
    pub measure: Option<f64>,
    /// Why it is no tool, if it is none.
    pub refused: Option<String>,
}

/// The text of the designed asset: that of the start with other numbers, another name and a remark on where it comes
/// from.
///
/// # Errors
/// In words, if the start's text cannot be edited.
pub fn designed_asset(task: &DesignTask, values: &[f64]) -> Result<String, String> {
    let (file, text) = &task.start;
    let mut document: DocumentMut = text.parse().map_err(|error| format!("read {}: {error}", file.display()))?;
    for (parameter, &number) in task.parameters.iter().zip(values) {
        let steps: Vec<&str> = parameter.key.split('.').collect();
        let place = steps.iter().try_fold(document.as_item_mut(), |item, step| {
            item.as_table_like_mut().and_then(|table| table.get_mut(step))
        });
        let place = place.ok_or_else(|| format!("{}: no key {}", file.display(), parameter.key))?;
        let decor = place.as_value().map(|value| value.decor().clone());
        *place = value(number);
        if let (Some(decor), Some(value)) = (decor, place.as_value_mut()) {
            *value.decor_mut() = decor;
        }
    }
    if document.contains_key("name") {
        document["name"] = value(task.name.as_str());
    }
    let start = file.file_stem().unwrap_or_default().to_string_lossy();
    let aim = if task.minimize { "small" } else { "large" };
    let head = format!(
        "# Designed by `wield design` from `{start}` so that {} of the scenario {} is {aim}; {} seeds, {} candidates.\n",
        task.measure, task.scenario.name, task.seeds.1, task.evaluations
    );
    Ok(head + &document.to_string())
}
