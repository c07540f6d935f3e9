//! The CSV format of demonstrations: what is read, what is refused and where, and that writing is the inverse of reading.

use proptest::prelude::*;

use super::*;

const HEADER: &str = "time_s,tool_x_m,tool_y_m,tool_angle_rad,object_x_m,object_y_m,object_angle_rad\n";

fn source(text: &str) -> Source {
    Source::new("a.csv", text)
}

fn refused(text: &str) -> String {
    read(&source(text)).unwrap_err().to_string()
}

#[test]
fn tool_and_object_may_have_rows_of_their_own() {
    let text = format!("# by hand\n{HEADER}0,1,2,0,,,\n0.01,1,2,0,5,6,0\n0.5,1.5,2,0,,,\n\n0.6,,,,5,7,0\n");
    let read = read(&source(&text)).unwrap();
    assert_eq!((read.name.as_str(), read.tool.len(), read.object.len()), ("a.csv", 3, 2));
    assert_eq!(read.object.end()[1], 7.0);
}

#[test]
fn columns_may_stand_in_any_order_beside_others() {
    let header = "force_n, object_x_m, object_y_m, object_angle_rad, tool_x_m, tool_y_m, tool_angle_rad, time_s";
    let read = read(&source(&format!("{header}\r\n9, 1, 2, 3, 4, 5, 6, 0\r\n9, 1, 2, 3, 4, 5, 6, 1\r\n"))).unwrap();
    assert_eq!(
        (read.object.start().as_slice(), read.tool.start().as_slice()),
        (&[1.0, 2.0, 3.0][..], &[4.0, 5.0, 6.0][..])
    );
}

#[test]
fn a_wrong_column_is_pointed_at() {
    let found = refused(&format!("# by hand\n{}0,1,2,0,5,6,0\n", HEADER.replace("tool_y_m", "tool_y_mm")));
    let expected = "a.csv:2:17: missing column `tool_y_m`: found `tool_y_mm`; expected the columns `time_s`, ";
    assert!(found.starts_with(expected) && found.ends_with("did you mean `tool_y_m`?"), "{found}");
    assert!(refused("x,y\n0,1\n").starts_with("a.csv:1:1: missing column `time_s`: found `x`, `y`"));
}

#[test]
fn a_bad_value_is_pointed_at() {
    let row = |field: &str| format!("{HEADER}# two rows\n\n0,1,2,0,5,6,0\r\n0.1,1, {field},0,5,6,0\r\n");
    for (field, found) in [("two", "`two`"), ("NaN", "`NaN`"), ("1e999", "`1e999`"), ("", "an empty field")] {
        let expected =
            format!("a.csv:5:8: bad value in the column `tool_y_m`: found {found}; expected a finite number");
        assert_eq!(refused(&row(field)), expected);
    }
}

#[test]
fn times_that_do_not_increase_are_pointed_at() {
    let found = refused(&format!("{HEADER}0.1,1,2,0,,,\n0.1,,,,5,6,0\n0.1,1,2,0,,,\n"));
    let expected =
        "a.csv:4:1: the times of the tool do not increase: found 0.1 s after 0.1 s; expected a later time in each row";
    assert!(found.starts_with(expected), "{found}");
}

#[test]
fn times_in_milliseconds_are_noticed() {
    let found = refused(&format!("{HEADER}0,1,2,0,5,6,0\n3700,1,2,0,5,6,0\n"));
    let expected = "a.csv:3:1: the recording is too long: found 3700 s; expected a time within 3600 s of the first";
    assert!(found.starts_with(expected), "{found}");
}

#[test]
fn a_row_of_another_length_is_refused() {
    let found = refused(&format!("{HEADER}0,1,2,0,5,6,0\n0.1,1,2\n"));
    assert_eq!(found, "a.csv:3:1: a row of another length than the header: found 3 fields; expected 7 fields");
}

#[test]
fn a_file_that_tells_too_little_is_refused() {
    assert!(refused("# nothing\n").starts_with("a.csv: the file holds no table: expected a header: time_s,"));
    let found = refused(&format!("{HEADER}0,1,2,0,5,6,0\n0.1,1,2,0,,,\n"));
    assert_eq!(found, "a.csv: too few rows tell where the object was: found 1; expected at least 2");
    let apart = format!("{HEADER}0,1,2,0,,,\n1,1,2,0,,,\n2,,,,5,6,0\n3,,,,5,6,0\n");
    assert!(refused(&apart).contains("recorded at the same time"), "{}", refused(&apart));
}

#[test]
fn remarks_stay_comments() {
    let source = source(&format!("{HEADER}0,1,2,0,5,6,0\n1,1,2,0,5,6,0\n"));
    let text = write(&[("tool", "a\nb".into()), ("seed", "7".into())], &read(&source).unwrap());
    assert!(text.starts_with("# tool: a b\n# seed: 7\ntime_s,"), "{text}");
}

/// Random motion with times at least two microseconds apart, so that none fall together when they are written.
fn motion() -> impl Strategy<Value = Trajectory> {
    let row = (2e-6..0.02, prop::array::uniform3(-3.2..3.2));
    prop::collection::vec(row, 3..40).prop_map(|rows| {
        let mut time_s = -0.05;
        let rows: Vec<(f64, Pose)> = rows
            .into_iter()
            .map(|(step_s, pose)| {
                time_s += step_s;
                (time_s, pose)
            })
            .collect();
        let last = rows.last().map(|(time_s, pose)| (time_s.max(0.0) + 0.5, *pose));
        trajectory(&rows.into_iter().chain(last).collect::<Vec<_>>()).unwrap()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read_back_to_the_last_bit(tool in motion(), object in motion()) {
        let demonstration = Demonstration::new("a.csv", tool, object).unwrap();
        let text = write(&[], &demonstration);
        let again = read(&source(&text)).unwrap();
        prop_assert_eq!(&write(&[], &again), &text);
        let printed = |value: f64| -> f64 { decimal(value).parse().unwrap() };
        for (written, read) in [(&demonstration.tool, &again.tool), (&demonstration.object, &again.object)] {
            let times: Vec<f64> = written.times_s().iter().copied().map(printed).collect();
            prop_assert_eq!(times.as_slice(), read.times_s());
            prop_assert_eq!(written.samples().map(printed), read.samples().clone());
        }
    }

    #[test]
    fn random_damage_never_panics(text in "[0-9,.e#a \"\r\n-]{0,120}", cut in 0_usize..90) {
        let whole = format!("{HEADER}0,1,2,0,5,6,0\n{text}\n1,1,2,0,5,6,0\n");
        let damaged: String = whole.chars().skip(cut).collect();
        for text in [whole, damaged] {
            if let Err(problem) = read(&source(&text)) {
                prop_assert!(!problem.render(false).is_empty());
            }
        }
    }
}
