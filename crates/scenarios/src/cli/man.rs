//! `wield man`: manual pages of the program and of each of its verbs.

use std::path::{Path, PathBuf};

use clap::{Command, CommandFactory};
use clap_mangen::Man;

use super::{Arguments, Exit, prepare_told, say, say_error, unwritable};
use crate::files::write_whole;

pub const AFTER_HELP: &str = "\
Examples:
  wield man | man -l -
  wield man --out ~/.local/share/man/man1";

/// Options of `wield man`.
#[derive(Debug, clap::Args)]
pub struct ManArguments {
    /// Write the pages of all verbs into this folder instead of printing that of the program
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Prints the page of the program, or writes all pages.
pub fn execute(arguments: &ManArguments) -> Exit {
    let mut program = Arguments::command();
    program.build();
    let Some(folder) = &arguments.out else {
        return match page(&program) {
            Ok(text) => say(&text),
            Err(error) => {
                say_error(&format!("write the manual: {error}"));
                Exit::Crashed
            }
        };
    };
    if prepare_told(folder).is_none() {
        return Exit::BadInput;
    }
    let verbs = program.get_subcommands().filter(|verb| verb.get_name() != "help");
    let pages = std::iter::once(&program).chain(verbs).map(|command| write(command, folder));
    pages.fold(Exit::Success, |worst, exit| if exit == Exit::Success { worst } else { exit })
}

/// A page as roff; that of a verb is called `wield-run`.
fn page(command: &Command) -> std::io::Result<String> {
    let mut text = Vec::new();
    Man::new(command.clone()).render(&mut text)?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}

fn write(command: &Command, folder: &Path) -> Exit {
    let file = folder.join(format!("{}.1", command.get_display_name().unwrap_or_else(|| command.get_name())));
    match page(command).and_then(|text| write_whole(&file, text.as_bytes())) {
        Ok(()) => say(&format!("{}\n", file.display())),
        Err(error) => {
            say_error(&unwritable(&file, &error, "--out"));
            Exit::Crashed
        }
    }
}
