//! Reading a file into text, with a message for each way in which that fails.

use std::fs::File;
use std::io::{self, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::given::{Given, Origin};
use crate::assets::stems;
use crate::diagnostic::{Diagnostic, Place};
use crate::suggest::{listed, nearest};

/// Largest file that is read, bytes: far more than any scenario, robot or demonstration needs.
const LARGEST_BYTES: u64 = 32 << 20;

/// The text of a file, and the name under which the user knows it.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    /// The file, as the user named it.
    pub file: PathBuf,
    /// Its text.
    pub text: Arc<str>,
    /// The changes that made this text out of that of the file, if there were any.
    given: Option<Arc<Given>>,
}

impl Source {
    /// The text of a file as it is.
    pub fn new(file: impl Into<PathBuf>, text: impl Into<Arc<str>>) -> Self {
        Self { file: file.into(), text: text.into(), given: None }
    }

    /// A text that changes made out of that of a file.
    pub fn changed(text: String, given: Given) -> Self {
        Self { file: given.before().file.clone(), text: text.into(), given: Some(Arc::new(given)) }
    }

    /// The words for the change of a key, if there was one.
    pub fn words_for(&self, key: &str) -> Option<&str> {
        self.given.as_ref()?.words_for(key)
    }

    /// Reads a UTF-8 file.
    pub fn read(file: &Path) -> Result<Self, Box<Diagnostic>> {
        let bytes = read_bytes(file).map_err(|error| Box::new(unreadable(file, &error)))?;
        match String::from_utf8(bytes) {
            Ok(text) => Ok(Self::new(file, text)),
            Err(error) => Err(Box::new(not_utf8(file, error.as_bytes(), error.utf8_error().valid_up_to()))),
        }
    }

    /// A problem at a byte range of this text: at its place in the file, or with the change that put it there.
    pub fn problem(&self, span: Range<usize>, title: impl Into<String>) -> Diagnostic {
        let Some(given) = &self.given else { return Diagnostic::at(&self.file, Place::of(&self.text, span), title) };
        match given.origin(span.clone()) {
            Some(Origin::Change(words)) => Diagnostic::of_file(Path::new(&words), title),
            Some(Origin::Before(span)) => given.before().problem(span, title),
            None => Diagnostic::at(&self.file, Place::of(&self.text, span), title),
        }
    }

    /// Points at another part of this text that matters to a problem.
    pub fn related(&self, problem: Diagnostic, span: Range<usize>, remark: &str) -> Diagnostic {
        let other = self.problem(span, "");
        match (&problem.place, other.place) {
            (Some(_), Some(place)) if problem.file == other.file => problem.related(place.span, remark),
            (_, place) => {
                let line = place.map_or_else(String::new, |place| format!(":{}", place.line));
                problem.help([format!("{}{line}: {remark}", other.file.display())])
            }
        }
    }
}

fn read_bytes(file: &Path) -> io::Result<Vec<u8>> {
    let opened = File::open(file)?;
    if opened.metadata()?.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    let mut bytes = Vec::new();
    opened.take(LARGEST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST_BYTES {
        return Err(io::Error::new(
            io::ErrorKind::FileTooLarge,
            format!("it is larger than {} MiB", LARGEST_BYTES >> 20),
        ));
    }
    Ok(bytes)
}

fn unreadable(file: &Path, error: &io::Error) -> Diagnostic {
    match error.kind() {
        io::ErrorKind::NotFound => {
            Diagnostic::of_file(file, "there is no such file").expected("a scenario file").help(near_files(file))
        }
        io::ErrorKind::IsADirectory => Diagnostic::of_file(file, "this is a folder")
            .expected("a scenario file")
            .help([format!("name one of its files: {}", listed(&toml_files(file)))]),
        _ => Diagnostic::of_file(file, "the file cannot be read").found(error.to_string()),
    }
}

/// Help for a missing file: the nearest name in its folder, or all names there.
fn near_files(file: &Path) -> Option<String> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let known = toml_files(folder);
    let wanted = file.file_name()?.to_string_lossy();
    let whole = |name: &str| folder.join(name).display().to_string();
    match nearest(&wanted, &known) {
        Some(name) => Some(format!("did you mean `{}`?", whole(name))),
        None if known.is_empty() => None,
        None => Some(format!("scenario files in that folder: {}", listed(&known))),
    }
}

fn toml_files(folder: &Path) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    stems(folder, "toml").into_iter().map(|stem| format!("{stem}.toml")).collect()
}

fn not_utf8(file: &Path, bytes: &[u8], valid_up_to: usize) -> Diagnostic {
    let valid = bytes.get(..valid_up_to).unwrap_or_default();
    let found = bytes.get(valid_up_to).map_or_else(String::new, |byte| format!("byte 0x{byte:02x}"));
    let text: Arc<str> = String::from_utf8_lossy(valid).into();
    let place = Place { text: None, ..Place::of(&text, valid_up_to..valid_up_to) };
    Diagnostic::at(file, place, "the file is not UTF-8 text")
        .found(found)
        .expected("UTF-8")
        .help(["save it as UTF-8 in your editor".to_owned()])
}
