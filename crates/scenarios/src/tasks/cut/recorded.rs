//! Recorded cuts: the CSV format of a knife's poses, read and written here alone.
//!
//! Columns, in any order: `time_s`, the place `x_m`, `y_m`, `z_m` of the middle of the edge and the quaternion `qw`, `qx`, `qy`,
//! `qz` of the knife's axes in the world; others are ignored. Lines that begin with `#` are comments. Lengths are written to
//! micrometers, quaternions to nine decimals.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use skills::primitive::pose::PoseTrajectory;

use crate::diagnostic::Diagnostic;
use crate::scenario::Source;
use crate::suggest::listed;

/// The columns, in the order in which they are written.
const COLUMNS: [&str; 8] = ["time_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"];
/// A quaternion whose norm is farther from 1 is no rotation that was rounded.
const NORM_ERROR: f64 = 1e-3;

type Problem = Box<Diagnostic>;

/// Whether a file holds poses of a knife, by its header.
pub(crate) fn is_poses(source: &Source) -> bool {
    let header = source.text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    header.is_some_and(|header| header.split(',').any(|column| column.trim() == "qw"))
}

/// Reads poses `world_from_knife` about the middle of the edge; the error is the first problem, with its line.
pub(crate) fn read(source: &Source) -> Result<PoseTrajectory, Problem> {
    let reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .has_headers(false)
        .flexible(true)
        .from_reader(source.text.as_bytes());
    let mut places: Option<[usize; 8]> = None;
    let (mut times_s, mut poses) = (Vec::new(), Vec::new());
    for record in reader.into_records() {
        let record = record.map_err(|error| Diagnostic::of_file(&source.file, "no CSV").found(error.to_string()))?;
        let Some(places) = places else {
            places = Some(header(source, &record)?);
            continue;
        };
        let row = Row { source, record: &record, places };
        let values = row.numbers()?;
        times_s.push(values[0] - times_s.first().copied().unwrap_or(0.0));
        poses.push(row.pose(values)?);
    }
    if let Some(first) = times_s.first_mut() {
        *first = 0.0;
    }
    if places.is_none() {
        let problem = Diagnostic::of_file(&source.file, "the file holds no table");
        return Err(Box::new(problem.expected(format!("a header: {}", COLUMNS.join(",")))));
    }
    PoseTrajectory::new(times_s, poses).map_err(|error| {
        Box::new(Diagnostic::of_file(&source.file, "no demonstration of a cut").found(error.to_string()))
    })
}

/// Writes poses, with what is to be known about them as comments: name and text.
pub(super) fn write(about: &[(&str, String)], poses: &PoseTrajectory) -> String {
    let comment = |(name, text): &(&str, String)| format!("# {name}: {}\n", text.replace(char::is_control, " "));
    let mut text: String = about.iter().map(comment).collect();
    text += &format!("{}\n", COLUMNS.join(","));
    for (time_s, pose) in poses.times_s().iter().zip(poses.poses()) {
        let (place, turn) = (pose.translation.vector, pose.rotation);
        text += &format!("{},{},{},{}", fixed(*time_s, 6), fixed(place.x, 6), fixed(place.y, 6), fixed(place.z, 6));
        text += &format!(",{},{},{},{}\n", fixed(turn.w, 9), fixed(turn.i, 9), fixed(turn.j, 9), fixed(turn.k, 9));
    }
    text
}

/// A number of decimals, and no minus before a zero.
fn fixed(number: f64, decimals: usize) -> String {
    let text = format!("{number:.decimals$}");
    let is_zero = text.chars().all(|letter| matches!(letter, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

/// Where each of [`COLUMNS`] stands in the header.
fn header(source: &Source, record: &csv::StringRecord) -> Result<[usize; 8], Problem> {
    let mut places = [0; 8];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        let Some(found) = record.iter().position(|name| name == column) else {
            let problem = source.problem(span(source, record), format!("missing column `{column}`"));
            let names: Vec<&str> = record.iter().collect();
            return Err(Box::new(problem.found(listed(&names)).expected(format!("the columns {}", listed(&COLUMNS)))));
        };
        *place = found;
    }
    Ok(places)
}

/// Bytes of the line that a record stands in.
fn span(source: &Source, record: &csv::StringRecord) -> std::ops::Range<usize> {
    let line = record.position().map_or(1, csv::Position::line).saturating_sub(1) as usize;
    let start: usize = source.text.split_inclusive('\n').take(line).map(str::len).sum();
    let length = source.text.get(start..).and_then(|rest| rest.lines().next()).map_or(0, str::len);
    start..start + length
}

/// A row of the table.
struct Row<'a> {
    source: &'a Source,
    record: &'a csv::StringRecord,
    places: [usize; 8],
}

impl Row<'_> {
    fn problem(&self, title: String) -> Diagnostic {
        self.source.problem(span(self.source, self.record), title)
    }

    fn numbers(&self) -> Result<[f64; 8], Problem> {
        let mut values = [0.0; 8];
        for ((value, place), column) in values.iter_mut().zip(self.places).zip(COLUMNS) {
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
        Source { file: "cut.csv".into(), text: text.into() }
    }

    #[test]
    fn what_was_written_is_read_again() {
        let pose = |k: f64| {
            let turn = UnitQuaternion::from_euler_angles(-1.5, 0.01 * k, 0.02);
            Isometry3::from_parts(Translation3::new(0.5, -0.01 * k, 0.2), turn)
        };
        let poses = PoseTrajectory::new(vec![0.0, 0.01, 0.02], vec![pose(0.0), pose(1.0), pose(2.0)]).unwrap();
        let text = write(&[("food", "banana\nripe".into())], &poses);
        assert!(text.starts_with("# food: banana ripe\ntime_s,x_m,"), "{text}");
        assert!(is_poses(&source(&text)));
        let read = read(&source(&text)).unwrap();
        assert_eq!(read.times_s(), poses.times_s());
        for (found, expected) in read.poses().iter().zip(poses.poses()) {
            assert!((found.translation.vector - expected.translation.vector).norm() < 1e-6);
            assert!(found.rotation.angle_to(&expected.rotation) < 1e-8);
        }
    }

    #[test]
    fn flaws_are_told_with_their_line() {
        let told = |text: &str| read(&source(text)).unwrap_err().to_string();
        assert!(told("").contains("the file holds no table"));
        let missing = told("time_s,x_m,y_m,z_m,qx,qy,qz\n");
        assert!(missing.contains("missing column `qw`"), "{missing}");
        let header = "# c\ntime_s,x_m,y_m,z_m,qw,qx,qy,qz\n";
        let bad = told(&format!("{header}0,0,0,0,1,0,0,zero\n"));
        assert!(bad.contains("cut.csv:3") && bad.contains("bad value in the column `qz`"), "{bad}");
        let norm = told(&format!("{header}0,0,0,0,2,0,0,0\n"));
        assert!(norm.contains("a norm of 2"), "{norm}");
    }
}
