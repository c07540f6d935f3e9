//! Types and values in words: "a number" instead of `f64`.

use serde::de::{Expected, Unexpected};

/// What was found, as people say it.
pub(crate) fn found_in_words(found: Unexpected<'_>) -> String {
    match found {
        Unexpected::Bool(truth) => truth.to_string(),
        Unexpected::Unsigned(number) => number.to_string(),
        Unexpected::Signed(number) => number.to_string(),
        Unexpected::Float(number) => number.to_string(),
        Unexpected::Str(text) => format!("the text {text:?}"),
        Unexpected::Seq => "a list".into(),
        Unexpected::Map => "a table".into(),
        other => other.to_string(),
    }
}

/// What serde expected, as people say it.
pub(crate) fn expected_in_words(expected: &dyn Expected) -> String {
    let expected = expected.to_string();
    let count = |prefix: &str| expected.strip_prefix(prefix).map(str::to_owned);
    match expected.as_str() {
        "f64" | "f32" => "a number".into(),
        "u64" | "u32" | "u16" | "u8" | "usize" => "a whole number of at least 0".into(),
        "i64" | "i32" | "i16" | "i8" | "isize" => "a whole number".into(),
        "a string" => "a text in quotes".into(),
        "a boolean" => "true or false".into(),
        "a sequence" => "a list".into(),
        _ if expected.starts_with("struct ") => "a table".into(),
        _ => count("an array of length ").map_or(expected, |length| format!("a list of {length} values")),
    }
}
