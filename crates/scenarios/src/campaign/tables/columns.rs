//! The columns of a table: what every run has, then the factors, then the measures.

use super::index::RowIndex;
use crate::campaign::{Manifest, Row};
use crate::outcome::Limit;
use crate::trials::Status;

/// A column.
pub(super) struct Column {
    /// Its name, unique in the table.
    pub name: String,
    /// What it tells.
    pub label: String,
    /// Unit; empty if it has none.
    pub unit: String,
    /// The limit, if it is one measure's and the same in all runs.
    pub limit: Option<Limit>,
    /// Type of its values.
    pub kind: Kind,
    /// Where its values are taken from.
    take: Take,
}

/// Type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Integer,
    Number,
    Truth,
    Text,
}

/// One value; no value is `None` around it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Cell {
    Integer(i64),
    Number(f64),
    Truth(bool),
    Text(String),
}

enum Take {
    Fixed(fn(&Row) -> Option<Cell>),
    Constant(String),
    /// Values by index.
    Factor(Vec<Option<Cell>>),
    Measure,
}

impl Column {
    /// The column's value in a row.
    pub fn cell(&self, row: &Row) -> Option<Cell> {
        match &self.take {
            Take::Fixed(take) => take(row),
            Take::Constant(text) => Some(Cell::Text(text.clone())),
            Take::Factor(values) => usize::try_from(row.index).ok().and_then(|index| values.get(index)?.clone()),
            Take::Measure => row.value(&self.name).map(Cell::Number),
        }
    }
}

/// The columns of a campaign's table. `simulated_s` is missing where nothing was simulated.
pub(super) fn columns(manifest: &Manifest, rows: &RowIndex<'_>) -> Vec<Column> {
    let fixed =
        |name: &str, label: &str, kind, take: fn(&Row) -> Option<Cell>| plain(name, label, kind, Take::Fixed(take));
    let constant =
        |name: &str, label: &str, text: &str| plain(name, label, Kind::Text, Take::Constant(text.to_owned()));
    let mut columns = vec![
        fixed("index", "place in the manifest", Kind::Integer, |row| Some(whole(row.index))),
        fixed("run_id", "identity of the run", Kind::Text, |row| Some(Cell::Text(row.run_id.to_string()))),
        constant("scenario", "name of the scenario", &manifest.base.scenario),
        constant("task", "kind of the task", &manifest.base.task),
        fixed("seed", "seed of the run", Kind::Integer, |row| Some(whole(row.seed))),
        fixed("status", "how the run ended", Kind::Text, |row| Some(Cell::Text(row.status.as_str().to_owned()))),
        fixed("success", "whether every limit was kept", Kind::Truth, |row| {
            Some(Cell::Truth(row.status == Status::Success))
        }),
        fixed("failures", "what went wrong", Kind::Text, |row| {
            (!row.failures.is_empty()).then(|| Cell::Text(row.failures.join("; ")))
        }),
        fixed("version", "version of the program", Kind::Text, |row| Some(Cell::Text(row.version.clone()))),
        fixed("trajectory_digest", "digest of the state trajectory", Kind::Text, |row| {
            row.trajectory_digest.clone().map(Cell::Text)
        }),
        Column {
            unit: "s".into(),
            ..fixed("simulated_s", "simulated time", Kind::Number, |row| {
                (row.simulated_s > 0.0).then_some(Cell::Number(row.simulated_s))
            })
        },
    ];
    columns.extend((0..manifest.base.factors.len()).filter_map(|factor| factor_column(manifest, factor)));
    columns.extend(rows.measures().into_iter().map(|measured| Column {
        name: measured.measure.name.clone(),
        label: measured.measure.label.clone(),
        unit: measured.measure.unit.clone(),
        limit: measured.limit,
        kind: Kind::Number,
        take: Take::Measure,
    }));
    columns
}

fn plain(name: &str, label: &str, kind: Kind, take: Take) -> Column {
    Column { name: name.into(), label: label.into(), unit: String::new(), limit: None, kind, take }
}

/// Indices and seeds are below 2⁶³.
fn whole(number: u64) -> Cell {
    Cell::Integer(i64::try_from(number).unwrap_or(i64::MAX))
}

fn factor_column(manifest: &Manifest, factor: usize) -> Option<Column> {
    let key = &manifest.base.factors.get(factor)?.key;
    let values = || manifest.runs.iter().filter_map(|run| run.values.get(factor));
    let kind = kind_of(values());
    let cells = manifest.runs.iter().map(|run| run.values.get(factor).map(|value| cell_of(value, kind))).collect();
    let unit = unit_of(key).to_owned();
    Some(Column { unit, ..plain(key, "factor of the design", kind, Take::Factor(cells)) })
}

fn kind_of<'a>(mut values: impl Iterator<Item = &'a toml::Value> + Clone) -> Kind {
    let all = |is: fn(&toml::Value) -> bool| values.clone().all(is);
    if all(toml::Value::is_integer) {
        Kind::Integer
    } else if all(|value| value.is_integer() || value.is_float()) {
        Kind::Number
    } else if values.all(toml::Value::is_bool) {
        Kind::Truth
    } else {
        Kind::Text
    }
}

fn cell_of(value: &toml::Value, kind: Kind) -> Cell {
    match (kind, value) {
        (Kind::Integer, toml::Value::Integer(number)) => Cell::Integer(*number),
        (Kind::Number, toml::Value::Integer(number)) => Cell::Number(*number as f64),
        (Kind::Number, toml::Value::Float(number)) => Cell::Number(*number),
        (Kind::Truth, toml::Value::Boolean(truth)) => Cell::Truth(*truth),
        (_, toml::Value::String(text)) => Cell::Text(text.clone()),
        (_, other) => Cell::Text(other.to_string()),
    }
}

/// The unit that the ending of a key tells.
fn unit_of(key: &str) -> &'static str {
    const UNITS: [(&str, &str); 12] = [
        ("_nm_s_per_rad", "N m s/rad"),
        ("_nm_per_rad", "N m/rad"),
        ("_m_per_s", "m/s"),
        ("_rad_per_s", "rad/s"),
        ("_per_s", "1/s"),
        ("_kg", "kg"),
        ("_rad", "rad"),
        ("_hz", "Hz"),
        ("_nm", "N m"),
        ("_n", "N"),
        ("_s", "s"),
        ("_m", "m"),
    ];
    UNITS.iter().find(|(ending, _)| key.ends_with(ending)).map_or("", |(_, unit)| unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_ending_tells_the_unit() {
        let expect = [("a.speed_m_per_s", "m/s"), ("gain_per_s", "1/s"), ("mass_kg", "kg"), ("x_m", "m"), ("tool", "")];
        for (key, unit) in expect {
            assert_eq!(unit_of(key), unit, "{key}");
        }
    }

    #[test]
    fn mixed_numbers_are_numbers_and_anything_else_mixed_is_text() {
        let kind = |text: &str| kind_of(text.parse::<toml::Table>().unwrap()["v"].as_array().unwrap().iter());
        assert_eq!(kind("v = [1, 2]"), Kind::Integer);
        assert_eq!(kind("v = [1, 2.5]"), Kind::Number);
        assert_eq!(kind("v = [true]"), Kind::Truth);
        assert_eq!(kind("v = [true, 1]"), Kind::Text);
    }
}
