//! Recorded demonstrations of a push: the CSV format, read and written here alone.
//!
//! Columns, in any order: `time_s`, `tool_x_m`, `tool_y_m`, `tool_angle_rad`, `object_x_m`, `object_y_m`,
//! `object_angle_rad`; others are ignored. Tool and object may be recorded on clocks of their own: a row may leave the
//! three fields of either of them empty. Lines that begin with `#` are comments. Numbers are written to six decimals:
//! micrometers, microseconds, microradians.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::DMatrix;
use skills::Trajectory;
use skills::demonstration::Demonstration;

use crate::diagnostic::Diagnostic;
use crate::scenario::Source;
use crate::suggest::{did_you_mean, listed, nearest};

/// The columns, in the order in which they are written.
const COLUMNS: [&str; 7] =
    ["time_s", "tool_x_m", "tool_y_m", "tool_angle_rad", "object_x_m", "object_y_m", "object_angle_rad"];
/// What a row may tell about, with the first of its three columns.
const PARTS: [(&str, usize); 2] = [("tool", 1), ("object", 4)];
/// Written steps per second: what lies nearer in time becomes one row.
const STEPS_PER_S: f64 = 1e6;
/// Longest recording that is read, s: a task takes a minute, and learning needs memory for each second.
const LONGEST_S: f64 = 3600.0;

type Pose = [f64; 3];
type Problem = Box<Diagnostic>;

/// Reads a demonstration, named like its file.
///
/// The error is the first problem, at its line and column.
pub fn read(source: &Source) -> Result<Demonstration, Problem> {
    let mut reader = csv::ReaderBuilder::new();
    let mut reader = reader
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .has_headers(false)
        .flexible(true)
        .from_reader(source.text.as_bytes());
    let mut table = Table { source, places: Vec::new(), width: 0, begin_s: None, recorded: Default::default() };
    for record in reader.records() {
        let record = record.map_err(|error| Diagnostic::of_file(&source.file, "no CSV").found(error.to_string()))?;
        table.take(&Row { source, record: &record })?;
    }
    table.demonstration()
}

/// Writes a demonstration, with what is to be known about it as comments: name and text.
pub fn write(about: &[(&str, String)], demonstration: &Demonstration) -> String {
    let comment = |(name, text): &(&str, String)| format!("# {name}: {}\n", text.replace(char::is_control, " "));
    let mut text: String = about.iter().map(comment).collect();
    text += &format!("{}\n", COLUMNS.join(","));
    let mut rows: BTreeMap<i64, [Option<Pose>; 2]> = BTreeMap::new();
    for (part, trajectory) in [&demonstration.tool, &demonstration.object].into_iter().enumerate() {
        for (time_s, pose) in trajectory.times_s().iter().zip(trajectory.samples().row_iter()) {
            let row = rows.entry((time_s * STEPS_PER_S).round() as i64).or_default();
            let pose = [0, 1, 2].map(|column| pose.get(column).copied().unwrap_or(f64::NAN));
            row.iter_mut().skip(part).take(1).for_each(|place| *place = Some(pose));
        }
    }
    for (step, poses) in rows {
        let poses = poses.map(|pose| pose.map_or_else(|| ",,".to_owned(), |pose| pose.map(decimal).join(",")));
        text += &format!("{},{}\n", decimal(step as f64 / STEPS_PER_S), poses.join(","));
    }
    text
}

/// Six decimals, and no minus before a zero.
fn decimal(number: f64) -> String {
    let text = format!("{number:.6}");
    if text == "-0.000000" { "0.000000".into() } else { text }
}

/// A row of the file.
struct Row<'a> {
    source: &'a Source,
    record: &'a csv::StringRecord,
}

impl Row<'_> {
    fn field(&self, place: usize) -> &str {
        self.record.get(place).unwrap_or("")
    }

    /// A problem with the field at `place`, or with the whole row.
    fn problem(&self, place: Option<usize>, title: String) -> Diagnostic {
        let from = self.record.position().map_or(0, |position| position.byte() as usize);
        let spans = field_spans(&self.source.text, from);
        let start = spans.first().map_or(from, |first| first.start);
        let whole = start..spans.last().map_or(start, |last| last.end);
        let span = place.and_then(|place| spans.get(place)).cloned().unwrap_or(whole);
        self.source.problem(span, title)
    }
}

/// Byte ranges of the fields of the row at byte `from`, or after the comments and empty lines there, which the reader
/// counts to the row after them. Quotes are not looked at: no number needs them.
fn field_spans(text: &str, from: usize) -> Vec<Range<usize>> {
    let mut start = from;
    for line in text.get(from..).unwrap_or_default().split_inclusive('\n') {
        let row = line.trim_end_matches(['\r', '\n']);
        if !row.is_empty() && !row.starts_with('#') {
            let span = |field: &str| {
                let begin = start + field.len() - field.trim_start().len();
                start += field.len() + 1;
                begin..begin + field.trim().len()
            };
            return row.split(',').map(span).collect();
        }
        start += line.len();
    }
    Vec::new()
}

/// What was read so far.
struct Table<'a> {
    source: &'a Source,
    /// Where each of [`COLUMNS`] stands; empty before the header.
    places: Vec<usize>,
    /// Number of fields of the header.
    width: usize,
    /// Time of the first row, s.
    begin_s: Option<f64>,
    /// Times, s, and poses of each of [`PARTS`].
    recorded: [Vec<(f64, Pose)>; 2],
}

impl Table<'_> {
    fn take(&mut self, row: &Row<'_>) -> Result<(), Problem> {
        if self.places.is_empty() {
            self.places = header(row)?;
            self.width = row.record.len();
            return Ok(());
        }
        if row.record.len() != self.width {
            let problem = row.problem(None, "a row of another length than the header".into());
            let found = format!("{} fields", row.record.len());
            return Err(Box::new(problem.found(found).expected(format!("{} fields", self.width))));
        }
        let time_s = self.number(row, 0)?;
        if (time_s - *self.begin_s.get_or_insert(time_s)).abs() > LONGEST_S {
            let problem = row.problem(self.places.first().copied(), "the recording is too long".into());
            let problem =
                problem.found(format!("{time_s} s")).expected(format!("a time within {LONGEST_S} s of the first"));
            return Err(Box::new(problem.help(["are the times in other units than seconds?".into()])));
        }
        for (part, (name, first)) in PARTS.into_iter().enumerate() {
            let is_empty = |column: &usize| row.field(*column).is_empty();
            if self.places.iter().skip(first).take(3).all(is_empty) {
                continue;
            }
            let pose = [self.number(row, first)?, self.number(row, first + 1)?, self.number(row, first + 2)?];
            let Some(rows) = self.recorded.get_mut(part) else { continue };
            if let Some((before_s, _)) = rows.last().filter(|(before_s, _)| time_s <= *before_s) {
                let problem =
                    row.problem(self.places.first().copied(), format!("the times of the {name} do not increase"));
                let problem = problem.found(format!("{time_s} s after {before_s} s"));
                return Err(Box::new(
                    problem.expected("a later time in each row").help(["drop or reorder the row".into()]),
                ));
            }
            rows.push((time_s, pose));
        }
        Ok(())
    }

    /// The number in one of [`COLUMNS`].
    fn number(&self, row: &Row<'_>, column: usize) -> Result<f64, Problem> {
        let place = self.places.get(column).copied();
        let found = place.map_or("", |place| row.field(place));
        found.parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(|| {
            let column = COLUMNS.get(column).copied().unwrap_or_default();
            let found = if found.is_empty() { "an empty field".into() } else { format!("`{}`", found.escape_debug()) };
            Box::new(
                row.problem(place, format!("bad value in the column `{column}`"))
                    .found(found)
                    .expected("a finite number"),
            )
        })
    }

    fn demonstration(self) -> Result<Demonstration, Problem> {
        let problem = |title: String| Diagnostic::of_file(&self.source.file, title);
        if self.places.is_empty() {
            return Err(Box::new(
                problem("the file holds no table".into()).expected(format!("a header: {}", COLUMNS.join(","))),
            ));
        }
        for ((name, _), rows) in PARTS.iter().zip(&self.recorded) {
            if rows.len() < 2 {
                let problem = problem(format!("too few rows tell where the {name} was")).found(rows.len().to_string());
                return Err(Box::new(problem.expected("at least 2")));
            }
        }
        let name = self.source.file.file_name().unwrap_or_default().to_string_lossy();
        let [tool, object] = self.recorded.map(|rows| trajectory(&rows));
        let made = tool.and_then(|tool| Demonstration::new(name, tool, object?));
        made.map_err(|error| {
            // what was attempted is said by the title
            let found = error.to_string();
            let found = found.strip_prefix("read demonstration: ").unwrap_or(&found).to_owned();
            Box::new(Diagnostic::of_file(&self.source.file, "no demonstration").found(found))
        })
    }
}

/// Where each of [`COLUMNS`] stands in the header.
fn header(row: &Row<'_>) -> Result<Vec<usize>, Problem> {
    let find = |column: &&str| {
        row.record.iter().position(|found| found == *column).ok_or_else(|| {
            let names: Vec<&str> = row.record.iter().collect();
            let strange: Vec<&str> = names.iter().copied().filter(|name| !COLUMNS.contains(name)).collect();
            let meant = nearest(column, &strange);
            let place = meant.and_then(|meant| names.iter().position(|name| *name == meant));
            let help = meant.and_then(|meant| did_you_mean(meant, &[column]));
            let problem = row.problem(place, format!("missing column `{column}`"));
            let found = meant.map_or_else(|| listed(&names), |meant| format!("`{}`", meant.escape_debug()));
            Box::new(problem.found(found).expected(format!("the columns {}", listed(&COLUMNS))).help(help))
        })
    };
    COLUMNS.iter().map(find).collect()
}

fn trajectory(rows: &[(f64, Pose)]) -> Result<Trajectory, skills::SkillError> {
    let times = rows.iter().map(|(time, _)| *time).collect();
    let value =
        |row: usize, column: usize| rows.get(row).and_then(|row| row.1.get(column)).copied().unwrap_or(f64::NAN);
    Trajectory::new(times, DMatrix::from_fn(rows.len(), 3, value))
}

#[cfg(test)]
#[path = "recorded_tests.rs"]
mod tests;
