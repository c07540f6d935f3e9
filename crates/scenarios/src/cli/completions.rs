//! `wield completions`: what shells need to complete verbs, options and files.

use clap::CommandFactory;
use clap_complete::{Shell, generate};

use super::{Arguments, Exit, say};

pub const AFTER_HELP: &str = "\
Examples:
  wield completions bash > ~/.local/share/bash-completion/completions/wield
  wield completions zsh > ~/.zfunc/_wield
  wield completions fish > ~/.config/fish/completions/wield.fish";

/// Options of `wield completions`.
#[derive(Debug, clap::Args)]
pub struct CompletionsArguments {
    /// Shell
    shell: Shell,
}

/// Prints the shell's script.
pub fn execute(arguments: &CompletionsArguments) -> Exit {
    let mut script = Vec::new();
    generate(arguments.shell, &mut Arguments::command(), "wield", &mut script);
    say(&String::from_utf8_lossy(&script))
}
