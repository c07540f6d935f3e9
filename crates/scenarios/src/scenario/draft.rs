//! Reads a struct from a document and goes on after a flaw, so that one look shows all that is wrong.

use serde::de::DeserializeOwned;

use super::decode::{Flaw, FlawKind, decode};
use super::document::{Node, Path};
use super::explain::{Context, bad_value};
use super::source::Source;
use crate::diagnostic::Diagnostic;

/// More problems than this in one file are not listed.
const MOST_PROBLEMS: usize = 25;

/// What could be read of a document.
pub(crate) struct Draft<T> {
    /// The struct, if what is left after taking out the flaws makes one.
    pub value: Option<T>,
    /// The document as it was written, flaws included; `None` after a syntax error.
    pub tree: Option<Node>,
    /// The flaws.
    pub problems: Vec<Diagnostic>,
}

/// Reads a struct; `example` is a valid document of the same type, for help on missing keys.
pub(crate) fn read<T: DeserializeOwned>(source: &Source, example: &Source) -> Draft<T> {
    if let Some(problem) = empty(source) {
        return Draft { value: None, tree: None, problems: vec![problem] };
    }
    match Node::parse(source) {
        Err(problem) => Draft { value: None, tree: None, problems: vec![*problem] },
        Ok(tree) => {
            let context = Context { source, tree: &tree, example };
            let (value, mut problems) = read_tree(context, tree.clone());
            problems.sort_by_key(|problem| problem.place.as_ref().map(|place| place.span.start));
            Draft { value, problems, tree: Some(tree) }
        }
    }
}

/// The problem with a file in which nothing stands.
pub(crate) fn empty(source: &Source) -> Option<Diagnostic> {
    source.text.trim_start_matches('\u{feff}').trim().is_empty().then(|| {
        Diagnostic::of_file(&source.file, "the file is empty")
            .expected("TOML")
            .help(["start from a copy of a shipped file: `wield list` names them".to_owned()])
    })
}

fn read_tree<T: DeserializeOwned>(context: Context<'_>, mut rest: Node) -> (Option<T>, Vec<Diagnostic>) {
    let mut problems = Vec::new();
    let mut taken_out: Vec<Path> = Vec::new();
    for (path, number) in context.tree.not_finite() {
        let problem = context.problem_at_value(&path, bad_value(&path));
        problems.push(problem.found(number.to_string().to_lowercase()).expected("a finite number"));
        taken_out.extend(rest.remove(&path));
    }
    while problems.len() < MOST_PROBLEMS {
        let flaw = match decode::<T>(&rest) {
            Ok(value) => return (Some(value), problems),
            Err(flaw) => flaw,
        };
        let explained = context.explain(&flaw);
        if !follows_from(&taken_out, &flaw) {
            problems.push(explained.diagnostic);
        }
        taken_out.extend(explained.excused);
        match rest.remove(&explained.culprit) {
            Some(path) => taken_out.push(path),
            None => return (None, problems),
        }
    }
    (None, problems)
}

/// Whether a flaw is there only because something was taken out.
fn follows_from(taken_out: &[Path], flaw: &Flaw) -> bool {
    let path = flaw.path();
    match &flaw.kind {
        FlawKind::MissingKey { key } => {
            taken_out.iter().any(|taken| taken.split_last().is_some_and(|(last, table)| last == key && table == path))
        }
        FlawKind::VariantCount { found, .. } => {
            found.is_empty() && taken_out.iter().any(|taken| taken.starts_with(&path))
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    #[expect(dead_code, reason = "read by its derived traits only")]
    struct Thing {
        name: String,
        shape: Shape,
        #[serde(default)]
        parts: Vec<Part>,
    }

    #[derive(Debug, Deserialize)]
    #[serde(rename_all = "snake_case", deny_unknown_fields)]
    #[expect(dead_code, reason = "read by its derived traits only")]
    enum Shape {
        Disc { radius_m: f64 },
        Flat,
    }

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    #[expect(dead_code, reason = "read by its derived traits only")]
    struct Part {
        place_m: [f64; 2],
        count: u32,
    }

    fn lines(text: &str) -> Vec<String> {
        let example = Source::new("e", "name = \"x\"\nparts = [{ place_m = [1, 2], count = 3 }]");
        let draft = read::<Thing>(&Source::new("a", text), &example);
        draft.problems.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn all_independent_flaws_are_listed_once() {
        let text = "nam = \"x\"\nshape.disc = { radius_mm = 12 }\n[[parts]]\nplace_m = [1, \"2\"]\ncount = -1\n";
        let expected = [
            "a:1:1: unknown key `nam` in the file: expected one of `name`, `shape`, `parts`; did you mean `name`?",
            "a:2:16: unknown key `radius_mm` in [shape.disc]: expected `radius_m`; \
             lengths are in meters here: write radius_m = 0.012",
            "a:4:15: bad value for entry 2 of `place_m` in entry 1 of [[parts]]: found the text \"2\"; \
             expected a number; write the number without quotes: 2",
            "a:5:9: bad value for `count` in entry 1 of [[parts]]: found -1; expected a whole number of at least 0",
        ];
        assert_eq!(lines(text), expected);
    }

    #[test]
    fn kinds_lists_and_types_are_explained() {
        let expect = [
            (
                "name = 1\nshape = \"flat\"",
                "a:1:8: bad value for `name`: found 1; expected a text in quotes; write it in quotes: \"1\"",
            ),
            (
                "name = \"\"\nshape = \"flatt\"",
                "a:2:9: unknown kind `flatt` of `shape`: expected one of `disc`, `flat`; did you mean `flat`?",
            ),
            (
                "name = \"\"\nshape = {}",
                "a:2:9: `shape` needs exactly one kind: found none; expected one of `disc`, `flat`; \
                 write for example [shape.disc]",
            ),
            (
                "name = \"\"\nshape = \"disc\"",
                "a:2:9: missing key `radius_m` in [shape.disc]: expected `radius_m`; write for example: radius_m = 0.01",
            ),
            (
                "name = \"\"\nshape = \"flat\"\nparts = [{ place_m = [1, 2, 3], count = 1 }]",
                "a:3:22: bad value for `place_m` in entry 1 of [[parts]]: found a list of 3 values; \
                 expected a list of 2 values",
            ),
            (
                "name = \"\"\nshape = \"flat\"\nparts = [{ place_m = [1, 2] }]",
                "a:3:10: missing key `count` in entry 1 of [[parts]]: expected `count`; write for example: count = 3",
            ),
            (
                "name = \"\"\nshape.disc.radius_m = nan",
                "a:2:23: bad value for `radius_m` in [shape.disc]: found nan; expected a finite number",
            ),
        ];
        for (text, expected) in expect {
            assert_eq!(lines(text), [expected]);
        }
    }

    #[test]
    fn an_empty_file_says_so() {
        assert!(lines(" \n")[0].starts_with("a: the file is empty"));
    }
}
