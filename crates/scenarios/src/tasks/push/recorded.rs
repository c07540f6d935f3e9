//! Recorded demonstrations of a push: a CSV file with the units in its header.
//!
//! Columns: `time_s`, `tool_x_m`, `tool_y_m`, `tool_angle_rad`, `object_x_m`, `object_y_m`, `object_angle_rad`. Tool and
//! object may be recorded on clocks of their own: a row may leave the three fields of either of them empty. Lines that
//! begin with `#` are comments.

use nalgebra::DMatrix;
use skills::Trajectory;
use skills::demonstration::Demonstration;

/// The columns, in the order in which they are written.
pub const COLUMNS: [&str; 7] =
    ["time_s", "tool_x_m", "tool_y_m", "tool_angle_rad", "object_x_m", "object_y_m", "object_angle_rad"];

type Rows = Vec<(f64, [f64; 3])>;

/// Reads a demonstration from the text of the file `name`.
///
/// The error is one sentence with file, line, column, what was found and what was expected.
pub fn read(name: &str, text: &str) -> Result<Demonstration, String> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| format!("{name}: {error}"))?.clone();
    let place = |column: &str| {
        header.iter().position(|found| found == column).ok_or_else(|| {
            let found = header.iter().collect::<Vec<_>>().join(", ");
            format!(
                "{name}:1: found the columns {found}; expected a column {column}; columns are {}",
                COLUMNS.join(", ")
            )
        })
    };
    let places = COLUMNS.iter().map(|column| place(column)).collect::<Result<Vec<_>, _>>()?;
    let (mut tool, mut object) = (Rows::new(), Rows::new());
    for record in reader.records() {
        let record = record.map_err(|error| format!("{name}: {error}"))?;
        let line = record.position().map_or(0, csv::Position::line);
        let field = |index: usize| places.get(index).and_then(|place| record.get(*place)).unwrap_or("");
        let number = |index: usize| -> Result<f64, String> {
            let found = field(index);
            let column = COLUMNS.get(index).copied().unwrap_or("?");
            found.parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(|| {
                format!("{name}:{line}: {column}: found '{found}'; expected a finite number; mend or drop the row")
            })
        };
        let time_s = number(0)?;
        for (first, rows) in [(1, &mut tool), (4, &mut object)] {
            if (first..first + 3).all(|index| field(index).is_empty()) {
                continue;
            }
            rows.push((time_s, [number(first)?, number(first + 1)?, number(first + 2)?]));
        }
    }
    let made = trajectory(&tool).and_then(|tool| Ok((tool, trajectory(&object)?)));
    let made = made.and_then(|(tool, object)| Demonstration::new(name, tool, object));
    made.map_err(|error| format!("{name}: {error}"))
}

fn trajectory(rows: &Rows) -> Result<Trajectory, skills::SkillError> {
    let times = rows.iter().map(|(time, _)| *time).collect();
    let value =
        |row: usize, column: usize| rows.get(row).and_then(|row| row.1.get(column)).copied().unwrap_or(f64::NAN);
    Trajectory::new(times, DMatrix::from_fn(rows.len(), 3, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "time_s,tool_x_m,tool_y_m,tool_angle_rad,object_x_m,object_y_m,object_angle_rad\n";

    #[test]
    fn tool_and_object_may_have_rows_of_their_own() {
        let text = format!("# by hand\n{HEADER}0,1,2,0,,,\n0.01,1,2,0,5,6,0\n0.5,1.5,2,0,,,\n0.6,,,,5,7,0\n");
        let read = read("a.csv", &text).unwrap();
        assert_eq!(read.tool.len(), 3);
        assert_eq!(read.object.len(), 2);
        assert_eq!(read.object.end()[1], 7.0);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let refused = |text: &str| read("a.csv", text).unwrap_err();
        assert!(refused("time_s,tool_x_mm\n").contains("expected a column tool_x_m"));
        assert!(
            refused(&format!("{HEADER}0,1,2,0,5,6,0\n0.1,1,two,0,5,6,0\n")).contains("a.csv:3: tool_y_m: found 'two'")
        );
        assert!(refused(&format!("{HEADER}0,1,2,0,5,6,0\n0.1,1,NaN,0,5,6,0\n")).contains("a.csv:3"));
        assert!(refused(&format!("{HEADER}0.1,1,2,0,5,6,0\n0.1,1,2,0,5,6,0\n")).contains("strictly increasing"));
    }
}
