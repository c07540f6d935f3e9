//! The program `wield`.

use std::process::ExitCode;

fn main() -> ExitCode {
    scenarios::cli::main().into()
}
