//! What is varied, and how the variants that come of it are called.

use std::str::FromStr;

use crate::scenario::{check_key, parse_value};

/// A key of the scenario with the values that it takes in turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation {
    /// The key, as in [`crate::scenario::Change::key`].
    pub key: String,
    /// Its values.
    pub values: Vec<toml::Value>,
}

impl FromStr for Variation {
    type Err = String;

    /// Reads `KEY=V1,V2,…`; commas within brackets, braces and quotes divide nothing.
    ///
    /// # Errors
    /// In words.
    fn from_str(text: &str) -> Result<Self, String> {
        let (key, list) = text.split_once('=').ok_or_else(|| format!("found {text:?}; expected KEY=VALUE,VALUE,…"))?;
        let key = key.trim();
        check_key(key)?;
        if list.trim().is_empty() {
            return Err(format!("found no value of `{key}`; expected KEY=VALUE,VALUE,…"));
        }
        let values = split(list).into_iter().map(|value| parse_value(value.trim()));
        Self::new(key, values.collect::<Result<_, _>>()?)
    }
}

impl Variation {
    /// A variation of `key`.
    ///
    /// # Errors
    /// In words, if a value is there twice.
    pub fn new(key: &str, values: Vec<toml::Value>) -> Result<Self, String> {
        let twice =
            values.iter().enumerate().find(|(index, value)| values.iter().take(*index).any(|other| other == *value));
        match twice {
            Some((_, value)) => Err(format!("found {} twice for `{key}`; expected different values", said(value))),
            None => Ok(Self { key: key.to_owned(), values }),
        }
    }
}

/// The pieces between commas that stand in no bracket, brace or quote.
fn split(list: &str) -> Vec<&str> {
    let (mut depth, mut quote, mut start) = (0_i32, None, 0);
    let mut pieces = Vec::new();
    for (at, letter) in list.char_indices() {
        match (quote, letter) {
            (Some(open), _) if open == letter => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(letter),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, ',') if depth == 0 => {
                pieces.extend(list.get(start..at));
                start = at + 1;
            }
            _ => {}
        }
    }
    pieces.extend(list.get(start..));
    pieces
}

/// Every combination of the values, those of the last variation changing fastest.
#[must_use]
pub fn points(variations: &[Variation]) -> Vec<Vec<toml::Value>> {
    variations.iter().fold(vec![Vec::new()], |points, variation| {
        let with = |point: &Vec<toml::Value>| -> Vec<Vec<toml::Value>> {
            variation.values.iter().map(|value| point.iter().cloned().chain([value.clone()]).collect()).collect()
        };
        points.iter().flat_map(with).collect()
    })
}

/// What the variants are called: their values, texts as they are and others with the last part of their key; with whole
/// keys if two would be called the same.
#[must_use]
pub fn variant_names(variations: &[Variation]) -> Vec<String> {
    let called = |name: &dyn Fn(&str, &toml::Value) -> String| -> Vec<String> {
        let one = |point: Vec<toml::Value>| {
            let parts = variations.iter().zip(&point).map(|(variation, value)| name(&variation.key, value));
            parts.collect::<Vec<_>>().join(", ")
        };
        points(variations).into_iter().map(one).collect()
    };
    let short = called(&|key, value| match value {
        toml::Value::String(text) => text.clone(),
        _ => format!("{} = {}", last_part(key), said(value)),
    });
    let mut sorted = short.clone();
    sorted.sort();
    if sorted.windows(2).all(|pair| pair.first() != pair.last()) {
        return short;
    }
    called(&|key, value| format!("{key} = {}", said(value)))
}

fn last_part(key: &str) -> &str {
    key.rsplit(['.', ':']).next().unwrap_or(key)
}

/// A value as people write it.
fn said(value: &toml::Value) -> String {
    match value {
        toml::Value::String(text) => text.clone(),
        // numbers as they were written: TOML would write 5e-3 as 0.005, and 1 as 1
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vary(text: &str) -> Variation {
        text.parse().unwrap()
    }

    #[test]
    fn values_are_divided_by_commas_outside_brackets_and_quotes() {
        assert_eq!(vary("a.b=1,2.5,x").values.len(), 3);
        assert_eq!(vary("place_m=[0.1, 0.2],[0.3, 0.4]").values.len(), 2);
        assert_eq!(vary("k={ a = [1, 2], b = 3 },plain").values.len(), 2);
        assert_eq!(vary("k=\"a, b\",'c, d'").values, ["a, b", "c, d"].map(toml::Value::from));
    }

    #[test]
    fn what_varies_nothing_is_refused_in_words() {
        for (text, part) in [
            ("tool", "expected KEY=VALUE"),
            ("tool=", "no value of `tool`"),
            ("=a,b", "dotted path"),
            ("k=1,,2", "expected a TOML value"),
            ("k=1,2,1", "found 1 twice for `k`"),
            ("k=[1,2", "expected a TOML value"),
        ] {
            let said = text.parse::<Variation>().unwrap_err();
            assert!(said.contains(part), "{text}: {said}");
        }
    }

    #[test]
    fn variants_are_all_combinations_in_order() {
        let both = [vary("tool.asset=stick,l"), vary("object.mass_kg=0.1,0.2")];
        assert_eq!(
            variant_names(&both),
            ["stick, mass_kg = 0.1", "stick, mass_kg = 0.2", "l, mass_kg = 0.1", "l, mass_kg = 0.2"]
        );
        assert_eq!(points(&both)[2], [toml::Value::from("l"), toml::Value::from(0.1)]);
    }

    #[test]
    fn names_that_would_be_equal_tell_their_keys() {
        let both = [vary("a=x,\"x, y\""), vary("b=\"y, z\",z")];
        assert_eq!(variant_names(&both)[0], "a = x, b = y, z");
    }
}
