//! Diagnostics: what is wrong in a file, where, and how to mend it; as one line or with the source under a caret.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use annotate_snippets::{AnnotationKind, Element, Group, Level, Origin, Renderer, Snippet};

/// One problem in an input file.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// The file, as the user named it.
    pub file: PathBuf,
    /// Where in the file; `None` if the file as a whole is at fault.
    pub place: Option<Place>,
    /// What is wrong, naming the key and its table.
    pub title: String,
    /// What was found; may be empty if the title says it.
    pub found: String,
    /// What would have been accepted; may be empty if the title says it.
    pub expected: String,
    /// How to mend it, a sentence each.
    pub help: Vec<String>,
    /// Other parts of the same file that matter: byte range and remark.
    pub related: Vec<(Range<usize>, String)>,
}

/// A place in a text file.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Byte range in `text`.
    pub span: Range<usize>,
    /// The file's text; `None` if it is not text that can be shown.
    pub text: Option<Arc<str>>,
}

impl Place {
    /// The place of a byte range of a text; a range beyond the text is moved to its end.
    #[must_use]
    pub fn of(text: &Arc<str>, span: Range<usize>) -> Self {
        let start = char_boundary(text, span.start);
        let end = char_boundary(text, span.end).max(start);
        let (line, column) = line_and_column(text, start);
        Self { line, column, span: start..end, text: Some(Arc::clone(text)) }
    }
}

impl Diagnostic {
    /// A problem of a file as a whole.
    #[must_use]
    pub fn of_file(file: &Path, title: impl Into<String>) -> Self {
        Self {
            file: file.to_owned(),
            place: None,
            title: title.into(),
            found: String::new(),
            expected: String::new(),
            help: Vec::new(),
            related: Vec::new(),
        }
    }

    /// A problem at a place in a file.
    #[must_use]
    pub fn at(file: &Path, place: Place, title: impl Into<String>) -> Self {
        Self { place: Some(place), ..Self::of_file(file, title) }
    }

    /// Says what was found.
    #[must_use]
    pub fn found(mut self, found: impl Into<String>) -> Self {
        self.found = found.into();
        self
    }

    /// Says what would have been accepted.
    #[must_use]
    pub fn expected(mut self, expected: impl Into<String>) -> Self {
        self.expected = expected.into();
        self
    }

    /// Adds sentences on how to mend it.
    #[must_use]
    pub fn help(mut self, help: impl IntoIterator<Item = String>) -> Self {
        self.help.extend(help);
        self
    }

    /// Points at another part of the same file.
    #[must_use]
    pub fn related(mut self, span: Range<usize>, remark: impl Into<String>) -> Self {
        self.related.push((span, remark.into()));
        self
    }

    /// Draws the problem as rustc does: title, source line with a caret, help; with colors if `color`.
    #[must_use]
    pub fn render(&self, color: bool) -> String {
        let path = self.file.display().to_string();
        let mut group = Level::ERROR.primary_title(self.title.as_str()).element(self.picture(&path));
        if self.place.as_ref().is_none_or(|place| place.text.is_none()) && !self.verdict().is_empty() {
            group = group.element(Level::NOTE.message(self.verdict()));
        }
        let group: Group<'_> = group.elements(self.help.iter().map(|help| Level::HELP.message(help.as_str())));
        let renderer = if color { Renderer::styled() } else { Renderer::plain() };
        renderer.render(&[group])
    }

    fn picture<'a>(&'a self, path: &'a str) -> Element<'a> {
        match &self.place {
            Some(Place { span, text: Some(text), .. }) => {
                let primary = AnnotationKind::Primary.span(span.clone()).label(self.verdict());
                let related = self.related.iter().map(|(span, remark)| {
                    let place = Place::of(text, span.clone());
                    AnnotationKind::Context.span(place.span).label(remark.as_str())
                });
                Snippet::source(&**text).path(path).annotation(primary).annotations(related).into()
            }
            Some(Place { line, column, .. }) => Origin::path(path).line(*line).char_column(*column).into(),
            None => Origin::path(path).into(),
        }
    }

    /// "found …; expected …", leaving out what is empty.
    fn verdict(&self) -> String {
        let found = (!self.found.is_empty()).then(|| format!("found {}", self.found));
        let expected = (!self.expected.is_empty()).then(|| format!("expected {}", self.expected));
        found.into_iter().chain(expected).collect::<Vec<_>>().join("; ")
    }
}

/// One line: `file:line:column: title: found …; expected …; help`.
impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file.display())?;
        if let Some(place) = &self.place {
            write!(f, "{}:{}:", place.line, place.column)?;
        }
        write!(f, " {}", self.title)?;
        let verdict = self.verdict();
        let details = (!verdict.is_empty()).then_some(&verdict).into_iter().chain(&self.help);
        for (index, detail) in details.enumerate() {
            write!(f, "{} {detail}", if index == 0 { ":" } else { ";" })?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostic {}

/// Whether text for people on `stream` should be colored: on a terminal only, and never against `NO_COLOR`.
#[must_use]
pub fn color_wanted(stream: &impl std::io::IsTerminal) -> bool {
    let refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|value| value == "dumb");
    stream.is_terminal() && !refused && !dumb
}

/// Nearest character boundary of `text` at or below byte `index`.
fn char_boundary(text: &str, index: usize) -> usize {
    let mut index = index.min(text.len());
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}

/// Line and column in characters, both from 1, of byte `index`.
fn line_and_column(text: &str, index: usize) -> (usize, usize) {
    let before = text.get(..index).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (
        before.matches('\n').count() + 1,
        before.chars().count() - before.get(..line_start).map_or(0, |head| head.chars().count()) + 1,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Diagnostic {
        let text: Arc<str> = "[object]\nmass_kg = -1\n".into();
        Diagnostic::at(Path::new("a.toml"), Place::of(&text, 19..21), "bad value for `mass_kg` in [object]")
            .found("-1")
            .expected("a number greater than 0")
            .help(["weigh it again".into()])
    }

    #[test]
    fn one_line_names_place_key_found_expected_and_help() {
        let expected = "a.toml:2:11: bad value for `mass_kg` in [object]: found -1; expected a number greater than 0; weigh it again";
        assert_eq!(sample().to_string(), expected);
    }

    #[test]
    fn the_picture_has_the_line_a_caret_and_the_help() {
        let expected = "\
error: bad value for `mass_kg` in [object]
 --> a.toml:2:11
  |
2 | mass_kg = -1
  |           ^^ found -1; expected a number greater than 0
  |
  = help: weigh it again";
        assert_eq!(sample().render(false), expected);
        assert!(sample().render(true).contains("\u{1b}["));
    }

    #[test]
    fn places_beyond_the_text_or_inside_a_character_do_not_panic() {
        let text: Arc<str> = "é = 1".into();
        assert_eq!(Place::of(&text, 1..2).span, 0..2);
        let place = Place::of(&text, 90..95);
        assert_eq!((place.line, place.column, place.span.clone()), (1, 6, 6..6));
        assert!(Diagnostic::at(Path::new("a"), place, "t").render(false).contains("a:1:6"));
    }

    #[test]
    fn a_whole_file_has_no_line() {
        let whole = Diagnostic::of_file(Path::new("b.toml"), "cannot read the file").found("no such file");
        assert_eq!(whole.to_string(), "b.toml: cannot read the file: found no such file");
        assert!(whole.render(false).contains("no such file"));
    }
}
