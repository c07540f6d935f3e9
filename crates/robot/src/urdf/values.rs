//! The text of attribute values: numbers, lists of numbers, substitutions.

use crate::urdf::schema::Value;

/// Longest piece of a file that a message repeats (characters).
const LONGEST_EXCERPT: usize = 60;
/// A substitution that carries its own default, so that it has a meaning without the program that expands it.
const OPTIONAL_VARIABLE: &str = "$(optenv ";

/// Returns the value in the form that the parser takes; `None` if it is not of its kind.
pub(crate) fn mend(text: &str, kind: Value) -> Option<String> {
    match kind {
        Value::Text => Some(text.to_owned()),
        Value::Number => text.trim().parse::<f64>().is_ok().then(|| text.to_owned()),
        Value::Vector(count) => numbers(text).filter(|found| found.len() == count).map(|found| spaced(text, &found)),
        Value::Scale => match numbers(text)?.as_slice() {
            [all] => Some(format!("{all} {all} {all}")),
            found @ [_, _, _] => Some(spaced(text, found)),
            [x, y, z, _] => Some(format!("{x} {y} {z}")),
            _ => None,
        },
        Value::Color => color(text),
    }
}

/// Four parts from 0 to 1; opaque if only three are given, and as bright as can be if a part is above 1.
fn color(text: &str) -> Option<String> {
    let words = numbers(text)?;
    let parts: Vec<f64> =
        words.iter().filter_map(|word| word.parse().ok()).filter(|part: &f64| part.is_finite()).collect();
    let opacity = match (words.len(), parts.len()) {
        (3, 3) => Some(1.0),
        (4, 4) => None,
        _ => return None,
    };
    if opacity.is_none() && parts.iter().all(|part| (0.0..=1.0).contains(part)) {
        return Some(spaced(text, &words));
    }
    let clamped = parts.into_iter().chain(opacity).map(|part| part.clamp(0.0, 1.0).to_string());
    Some(clamped.collect::<Vec<_>>().join(" "))
}

/// What a value of that kind looks like, for messages.
pub(crate) fn expected(kind: Value) -> &'static str {
    match kind {
        Value::Text => "a text",
        Value::Number => "one number with a decimal point",
        Value::Color => "4 numbers from 0 to 1 separated by spaces",
        Value::Vector(4) => "4 numbers separated by spaces",
        Value::Vector(_) | Value::Scale => "3 numbers separated by spaces",
    }
}

/// The numbers of a list, separated by blanks or commas; `None` if anything else is there.
fn numbers(text: &str) -> Option<Vec<&str>> {
    let words = text.split(|character: char| character.is_whitespace() || character == ',');
    words.filter(|word| !word.is_empty()).map(|word| word.parse::<f64>().is_ok().then_some(word)).collect()
}

/// The list without commas; unchanged if it has none.
fn spaced(text: &str, numbers: &[&str]) -> String {
    if text.contains(',') { numbers.join(" ") } else { text.to_owned() }
}

/// Replaces each `$(optenv NAME default)` by its default. The environment is not read: a file is to mean one arm.
pub(crate) fn expand_defaults(text: &str) -> String {
    let mut expanded = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once(OPTIONAL_VARIABLE) {
        let Some((inside, remaining)) = after.split_once(')') else { break };
        expanded.push_str(before);
        let default = inside.trim_start().split_once(char::is_whitespace).map_or("", |(_, default)| default);
        expanded.push_str(default.trim());
        rest = remaining;
    }
    expanded.push_str(rest);
    expanded
}

/// The beginning of a piece of the file.
pub(crate) fn excerpt(text: &str) -> String {
    match text.char_indices().nth(LONGEST_EXCERPT) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn good_values_stay_as_they_are() {
        for (text, kind) in [
            (" 1  2\t3 ", Value::Vector(3)),
            ("1e-3", Value::Number),
            ("-.5 5. +1", Value::Vector(3)),
            ("1 1 -1", Value::Scale),
            ("0 0 0 1", Value::Color),
        ] {
            assert_eq!(mend(text, kind).as_deref(), Some(text));
        }
    }

    #[test]
    fn forgivable_values_are_mended() {
        assert_eq!(mend("1, 2,3", Value::Vector(3)).as_deref(), Some("1 2 3"));
        assert_eq!(mend("0.001", Value::Scale).as_deref(), Some("0.001 0.001 0.001"));
        assert_eq!(mend("1 2 3 4", Value::Scale).as_deref(), Some("1 2 3"));
        assert_eq!(mend("1 0 0", Value::Color).as_deref(), Some("1 0 0 1"));
        assert_eq!(mend("255 0 -1 1", Value::Color).as_deref(), Some("1 0 0 1"));
    }

    #[test]
    fn words_among_numbers_are_not_passed_over() {
        for text in ["0 0 x 1", "0 0", "0 0 0 0", "", "0,1 0,2 0,3", "0 0 1;"] {
            assert_eq!(mend(text, Value::Vector(3)), None, "{text}");
        }
        for text in ["1 0 nan 1", "inf 0 0 1", "1 0", "1 0 0 1 1"] {
            assert_eq!(mend(text, Value::Color), None, "{text}");
        }
        for text in ["", "0,5", "1 2", "0x10", "1.0f"] {
            assert_eq!(mend(text, Value::Number), None, "{text}");
        }
    }

    #[test]
    fn optional_variables_take_their_default() {
        assert_eq!(expand_defaults("$(optenv HUSKY_XYZ 0 0 0.5)"), "0 0 0.5");
        assert_eq!(expand_defaults("a$(optenv X)b$(optenv Y 1 )c"), "ab1c");
        assert_eq!(expand_defaults("$(optenv X 1"), "$(optenv X 1");
        assert_eq!(expand_defaults("$(env X)"), "$(env X)");
    }

    #[test]
    fn excerpts_end_between_characters() {
        assert_eq!(excerpt(&"é".repeat(100)).chars().count(), LONGEST_EXCERPT + 1);
        assert_eq!(excerpt("short"), "short");
    }
}
