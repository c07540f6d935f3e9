//! Recorded demonstrations in space: the CSV format of the poses of what is held, read and written here alone.
//!
//! Columns, in any order: `time_s`, the place `x_m`, `y_m`, `z_m` of the body's frame and the quaternion `qw`, `qx`, `qy`, `qz` of
//! its axes in the world; others are ignored. Lines that begin with `#` are comments. Of a knife the frame lies in the middle
//! of its edge at the level of the heel, x toward the tip and y in the direction of the cut; of a cup in the middle of its
//! underside, z along its axis and x toward the lip. Numbers are written to six decimals: micrometers, microseconds, and
//! two microradians.

use std::ops::Range;

use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion};
use skills::demonstration::LARGEST_GAP_S;
use skills::primitive::pose::{PoseError, PoseTrajectory};

use crate::diagnostic::Diagnostic;
use crate::report::number;
use crate::scenario::Source;
use crate::suggest::{did_you_mean, listed, nearest};
use crate::tasks::StageError;

/// The columns, in the order in which they are written.
const COLUMNS: [&str; 8] = ["time_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"];
/// A quaternion whose norm is farther from 1 is no rotation that was rounded.
const NORM_ERROR: f64 = 1e-3;
/// Fewer poses than this are places, not a motion.
const LEAST_ROWS: usize = 10;
/// Longest recording that is read, s: times in milliseconds are noticed by it.
const LONGEST_S: f64 = 3600.0;

/// Largest speed of what a hand holds, m/s: that of a throw. Places in millimeters are noticed by it.
const LARGEST_SPEED_M_PER_S: f64 = 20.0;

type Problem = Box<Diagnostic>;

/// Checks that the point of a recorded body that works comes within `most_m` of what was worked on.
///
/// # Errors
/// In words, with the distance.
pub(crate) fn check_near(
    poses: &PoseTrajectory,
    point_in_body: &Point3<f64>,
    place_world: &Point3<f64>,
    what: &str,
    most_m: f64,
) -> Result<(), StageError> {
    let distances = poses.poses().iter().map(|pose| (pose * point_in_body - place_world).norm());
    let nearest_m = distances.fold(f64::INFINITY, f64::min);
    if nearest_m <= most_m {
        return Ok(());
    }
    Err(StageError::Input(format!(
        "the recording is {} m from {what} where it comes nearest; expected at most {} m; are its unit meters and its frame \
         the world, and is what [demonstrations.recorded] says of {what} true?",
        number(nearest_m),
        number(most_m)
    )))
}

/// Whether a file holds poses in space, by its header.
pub(crate) fn is_poses(source: &Source) -> bool {
    let header = source.text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    header.is_some_and(|header| header.split(',').any(|column| column.trim() == "qw"))
}

/// Reads poses of a body in the world, from 0 s on; the error is the first problem, with its line.
pub(crate) fn read(source: &Source) -> Result<PoseTrajectory, Problem> {
    let reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .has_headers(false)
        .flexible(true)
        .from_reader(source.text.as_bytes());
    let mut table: Option<Header> = None;
    let mut rows = Rows { source, spans: Vec::new(), times_s: Vec::new(), poses: Vec::new(), begin_s: None };
    for record in reader.into_records() {
        let record = record.map_err(|error| Diagnostic::of_file(&source.file, "no CSV").found(error.to_string()))?;
        match table {
            Some(header) => rows.take(&Row { source, record: &record, header })?,
            None => table = Some(header(source, &record)?),
        }
    }
    if table.is_none() {
        let problem = Diagnostic::of_file(&source.file, "the file holds no table");
        return Err(Box::new(problem.expected(format!("a header: {}", COLUMNS.join(",")))));
    }
    rows.trajectory()
}

/// The rows that were read.
struct Rows<'a> {
    source: &'a Source,
    spans: Vec<Range<usize>>,
    times_s: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    begin_s: Option<f64>,
}

impl Rows<'_> {
    fn take(&mut self, row: &Row<'_>) -> Result<(), Problem> {
        let values = row.numbers()?;
        let time_s = values[0] - *self.begin_s.get_or_insert(values[0]);
        if let Some(before_s) = self.times_s.last().filter(|before_s| time_s <= **before_s) {
            let begin_s = self.begin_s.unwrap_or_default();
            let found = format!("{} s after {} s", values[0], before_s + begin_s);
            let problem = row.problem("the times do not increase".into()).found(found);
            return Err(Box::new(problem.expected("a later time in each row")));
        }
        if time_s > LONGEST_S {
            let problem = row.problem("the recording is too long".into()).found(format!("{} s", values[0]));
            let problem = problem.expected(format!("a time within {LONGEST_S} s of the first"));
            return Err(Box::new(problem.help(["times are in seconds".to_owned()])));
        }
        let pose = row.pose(values)?;
        if let (Some(before_s), Some(before)) = (self.times_s.last(), self.poses.last()) {
            let (taken_s, way_m) = (time_s - before_s, (pose.translation.vector - before.translation.vector).norm());
            if taken_s > LARGEST_GAP_S {
                let problem = row.problem("a gap in the recording".into());
                let begin_s = self.begin_s.unwrap_or_default();
                let from_s = number(before_s + begin_s);
                let problem = problem.found(format!("{} s without a row, after {from_s} s", number(taken_s)));
                let problem = problem.expected(format!("at most {LARGEST_GAP_S} s between two rows"));
                return Err(Box::new(
                    problem.help(["record without a pause: what lies in a gap would be invented".into()]),
                ));
            }
            if way_m > LARGEST_SPEED_M_PER_S * taken_s {
                let problem = row.problem("the body moves too fast between two rows".into());
                let problem = problem.found(format!("{} m in {} s", number(way_m), number(taken_s)));
                let problem = problem.expected(format!("at most {LARGEST_SPEED_M_PER_S} m/s"));
                let help = "are places in meters and times in seconds? drop rows in which the tracker slipped";
                return Err(Box::new(problem.help([help.to_owned()])));
            }
        }
        self.poses.push(pose);
        self.times_s.push(time_s);
        self.spans.push(span(self.source, row.record));
        Ok(())
    }

    fn trajectory(self) -> Result<PoseTrajectory, Problem> {
        let end = self.source.text.trim_end().len();
        let place = |row: usize| self.spans.get(row).cloned().unwrap_or(end..end);
        if self.poses.len() < LEAST_ROWS {
            let last = self.poses.len().saturating_sub(1);
            let problem = self.source.problem(place(last), "too few rows for a motion");
            let (found, expected) = (format!("{}", self.poses.len()), format!("at least {LEAST_ROWS}"));
            return Err(Box::new(problem.found(found).expected(expected)));
        }
        PoseTrajectory::new(self.times_s, self.poses).map_err(|error| {
            let PoseError::FastTurn { row, turn_rad, largest_rad } = error else {
                return Box::new(Diagnostic::of_file(&self.source.file, "no motion").found(error.to_string()));
            };
            let row_span = self.spans.get(row).cloned().unwrap_or(end..end);
            let problem = self.source.problem(row_span, "the body turns too far between two rows");
            let problem = problem.found(format!("{turn_rad:.3} rad")).expected(format!("at most {largest_rad:.3} rad"));
            Box::new(problem.help(["record at a higher rate; a gap in the recording turns the body unseen".to_owned()]))
        })
    }
}

/// Writes poses, with what is to be known about them as comments: name and text.
pub(crate) fn write(about: &[(&str, String)], poses: &PoseTrajectory) -> String {
    let comment = |(name, text): &(&str, String)| format!("# {name}: {}\n", text.replace(char::is_control, " "));
    let mut text: String = about.iter().map(comment).collect();
    text += &format!("{}\n", COLUMNS.join(","));
    for (time_s, pose) in poses.times_s().iter().zip(poses.poses()) {
        let (place, turn) = (pose.translation.vector, pose.rotation);
        text +=
            &format!("{},{},{},{}", rounded(*time_s, 6), rounded(place.x, 6), rounded(place.y, 6), rounded(place.z, 6));
        text +=
            &format!(",{},{},{},{}\n", rounded(turn.w, 6), rounded(turn.i, 6), rounded(turn.j, 6), rounded(turn.k, 6));
    }
    text
}

/// A number rounded to decimals, without zeros at its end and without a minus before a zero.
fn rounded(number: f64, decimals: usize) -> String {
    let text = format!("{number:.decimals$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if matches!(text, "-0" | "") { "0".into() } else { text.to_owned() }
}

/// Where each of [`COLUMNS`] stands, and the number of all columns.
#[derive(Clone, Copy)]
struct Header {
    places: [usize; 8],
    width: usize,
}

fn header(source: &Source, record: &csv::StringRecord) -> Result<Header, Problem> {
    let names: Vec<&str> = record.iter().collect();
    let mut places = [0; 8];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        let Some(found) = names.iter().position(|name| *name == column) else {
            let problem = source.problem(span(source, record), format!("missing column `{column}`"));
            let problem = problem.found(listed(&names)).expected(format!("the columns {}", listed(&COLUMNS)));
            let strange: Vec<&str> = names.iter().copied().filter(|name| !COLUMNS.contains(name)).collect();
            let meant = nearest(column, &strange).and_then(|meant| did_you_mean(meant, &[column]));
            return Err(Box::new(problem.help(meant)));
        };
        *place = found;
    }
    Ok(Header { places, width: names.len() })
}

/// Bytes of the line that a record stands in; its position is told before the comments and blank lines above it.
fn span(source: &Source, record: &csv::StringRecord) -> Range<usize> {
    let mut start = record.position().map_or(0, csv::Position::byte) as usize;
    for line in source.text.get(start..).unwrap_or_default().split_inclusive('\n') {
        let text = line.trim();
        if !(text.is_empty() || text.starts_with('#')) {
            let blanks = line.len() - line.trim_start().len();
            return start + blanks..start + blanks + text.len();
        }
        start += line.len();
    }
    start..start
}

/// A row of the table.
struct Row<'a> {
    source: &'a Source,
    record: &'a csv::StringRecord,
    header: Header,
}

impl Row<'_> {
    fn problem(&self, title: String) -> Diagnostic {
        self.source.problem(span(self.source, self.record), title)
    }

    fn numbers(&self) -> Result<[f64; 8], Problem> {
        if self.record.len() != self.header.width {
            let problem = self.problem("a row of another length than the header".into());
            let problem = problem.found(format!("{} fields", self.record.len()));
            return Err(Box::new(problem.expected(format!("{} fields", self.header.width))));
        }
        let mut values = [0.0; 8];
        for ((value, place), column) in values.iter_mut().zip(self.header.places).zip(COLUMNS) {
            let found = self.record.get(place).unwrap_or("");
            let parsed = found.parse().ok().filter(|number: &f64| number.is_finite());
            *value = parsed.ok_or_else(|| {
                let found =
                    if found.is_empty() { "an empty field".into() } else { format!("`{}`", found.escape_debug()) };
                let problem = self.problem(format!("bad value in the column `{column}`"));
                Box::new(problem.found(found).expected("a finite number"))
            })?;
        }
        Ok(values)
    }

    fn pose(&self, [_, x, y, z, qw, qx, qy, qz]: [f64; 8]) -> Result<Isometry3<f64>, Problem> {
        let turn = Quaternion::new(qw, qx, qy, qz);
        if (turn.norm() - 1.0).abs() > NORM_ERROR {
            let problem = self.problem("a quaternion that is no rotation".into());
            let problem = problem.found(format!("a norm of {:.6}", turn.norm())).expected("a norm of 1");
            return Err(Box::new(problem.help(["normalize qw, qx, qy, qz".into()])));
        }
        Ok(Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_quaternion(turn)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> Source {
        Source::new("cut.csv", text)
    }

    const HEADER: &str = "# c\ntime_s,x_m,y_m,z_m,qw,qx,qy,qz\n";

    fn refused(text: &str) -> String {
        read(&source(text)).unwrap_err().to_string()
    }

    /// Rows of a body that stands still, with the row `at` replaced.
    fn rows(count: usize, at: usize, instead: &str) -> String {
        let row = |row: usize| if row == at { format!("{instead}\n") } else { format!("0.{row:02},0,0,0,1,0,0,0\n") };
        format!("{HEADER}{}", (0..count).map(row).collect::<String>())
    }

    #[test]
    fn what_was_written_is_read_again() {
        let pose = |k: usize| {
            let turn = UnitQuaternion::from_euler_angles(-1.5, 0.01 * k as f64, 0.02);
            Isometry3::from_parts(Translation3::new(0.5, -0.01 * k as f64, 0.2), turn)
        };
        let times_s = (0..12).map(|k| f64::from(k) * 0.01).collect();
        let poses = PoseTrajectory::new(times_s, (0..12).map(pose).collect()).unwrap();
        let text = write(&[("food", "banana\nripe".into())], &poses);
        assert!(text.starts_with("# food: banana ripe\ntime_s,x_m,"), "{text}");
        assert!(is_poses(&source(&text)));
        let read = read(&source(&text)).unwrap();
        assert_eq!(read.times_s(), poses.times_s());
        for (found, expected) in read.poses().iter().zip(poses.poses()) {
            assert!((found.translation.vector - expected.translation.vector).norm() < 1e-6);
            assert!(found.rotation.angle_to(&expected.rotation) < 3e-6);
        }
        // written, read and written again: not a digit moves
        assert_eq!(write(&[("food", "banana ripe".into())], &read), text);
    }

    #[test]
    fn a_recording_that_begins_late_begins_at_zero() {
        let late = rows(12, 99, "").replace("\n0.", "\n7.");
        assert_eq!(read(&source(&late)).unwrap().times_s()[0], 0.0);
    }

    #[test]
    fn a_recording_far_from_what_was_worked_on_is_refused_with_the_distance() {
        let poses = read(&source(&rows(12, 99, ""))).unwrap();
        let checked =
            |x: f64| check_near(&poses, &Point3::new(0.1, 0.0, 0.0), &Point3::new(x, 0.0, 0.0), "the food", 0.5);
        assert_eq!(checked(0.59), Ok(()));
        let Err(StageError::Input(told)) = checked(100.1) else { panic!("no refusal") };
        assert!(
            told.contains("is 100 m from the food") && told.contains("unit meters and its frame the world"),
            "{told}"
        );
    }

    #[test]
    fn flaws_are_told_with_their_line() {
        assert!(refused("").contains("the file holds no table"));
        let cases = [
            ("# c\n\ntime_s,x_m,y_m,z_m,qx,qy,qz\n".to_owned(), "cut.csv:3:1: missing column `qw`"),
            (rows(12, 3, "# c\n0.02,0,0,0,1,0,0,0"), "cut.csv:7:1: the times do not increase"),
            (rows(12, 3, "0.03,0,0,0,1,0,0,zero"), "cut.csv:6:1: bad value in the column `qz`: found `zero`"),
            (rows(12, 3, "0.03,0,NaN,0,1,0,0,0"), "cut.csv:6:1: bad value in the column `y_m`: found `NaN`"),
            (rows(12, 3, "0.03,0,,0,1,0,0,0"), "cut.csv:6:1: bad value in the column `y_m`: found an empty field"),
            (rows(12, 3, "0.03,0,0,0,2,0,0,0"), "cut.csv:6:1: a quaternion that is no rotation: found a norm of 2"),
            (rows(12, 3, "0.03,0,0,0,0,0,0,0"), "cut.csv:6:1: a quaternion that is no rotation: found a norm of 0"),
            (rows(12, 3, "0.02,0,0,0,1,0,0,0"), "cut.csv:6:1: the times do not increase: found 0.02 s after 0.02 s"),
            (rows(12, 3, "3700,0,0,0,1,0,0,0"), "cut.csv:6:1: the recording is too long: found 3700 s"),
            (
                rows(12, 11, "1.4,0,0,0,1,0,0,0"),
                "cut.csv:14:1: a gap in the recording: found 1.3 s without a row, after 0.1 s; expected at most 1 s",
            ),
            // 5 mm in 10 ms, told in millimeters
            (
                rows(12, 3, "0.03,5,0,0,1,0,0,0"),
                "cut.csv:6:1: the body moves too fast between two rows: found 5 m in 0.01 s; expected at most 20 m/s",
            ),
            (rows(12, 3, "0.03,0,0,0,1"), "cut.csv:6:1: a row of another length than the header: found 5 fields"),
            (
                rows(12, 3, "0.03,0,0,0,0,1,0,0"),
                "cut.csv:6:1: the body turns too far between two rows: found 3.142 rad",
            ),
            (rows(3, 99, ""), "cut.csv:5:1: too few rows for a motion: found 3; expected at least 10"),
            (HEADER.to_owned(), "too few rows for a motion: found 0"),
        ];
        for (text, expected) in cases {
            let found = refused(&text);
            assert!(found.contains(expected), "{expected:?} is missing in {found:?}");
        }
    }
}
