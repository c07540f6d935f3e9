//! `wield schema`: JSON Schemas of the files that people write, for editors.

use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;

use super::{Exit, prepare_told, say, say_error, unwritable};
use crate::files::write_whole;
use crate::schema::{FILES, FileKind};

pub const AFTER_HELP: &str = "\
An editor (Even Better TOML, taplo) completes and checks a file whose first line names it:
  #:schema ../docs/schema/scenario.schema.json

The schemas are made from the structs that read the files. They know keys, types, kinds and defaults; what `wield
check` finds besides, such as a negative mass or a name without a file, they do not.

Examples:
  wield schema > scenario.schema.json
  wield schema tool
  wield schema --out docs/schema

Exit codes: 0 success, 2 bad input, 3 a file could not be written.";

/// Options of `wield schema`.
#[derive(Debug, clap::Args)]
pub struct SchemaArguments {
    /// Kind of file [default: scenario; with --out, all of them]
    #[arg(value_name = "KIND", value_parser = PossibleValuesParser::new(FILES.iter().map(|kind| kind.name)))]
    kind: Option<String>,
    /// Write <KIND>.schema.json into this folder instead of printing it
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Prints one schema, or writes one or all of them.
pub fn execute(arguments: &SchemaArguments) -> Exit {
    let named = |kind: &&FileKind| arguments.kind.as_ref().is_none_or(|name| name == kind.name);
    match &arguments.out {
        None => FILES.iter().find(named).map_or(Exit::BadInput, |kind| say(&kind.schema_text())),
        Some(folder) if prepare_told(folder).is_none() => Exit::BadInput,
        Some(folder) => {
            let written = FILES.iter().filter(named).map(|kind| write(kind, folder));
            written.fold(Exit::Success, |worst, exit| if exit == Exit::Success { worst } else { exit })
        }
    }
}

fn write(kind: &FileKind, folder: &Path) -> Exit {
    let file = folder.join(kind.schema_file());
    match write_whole(&file, kind.schema_text().as_bytes()) {
        Ok(()) => say(&format!("{}\n", file.display())),
        Err(error) => {
            say_error(&unwritable(&file, &error, "--out"));
            Exit::Crashed
        }
    }
}
