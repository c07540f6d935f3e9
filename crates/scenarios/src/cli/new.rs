//! `wield new`: a scenario or a tool to begin with.

use std::io;
use std::path::{Path, PathBuf};

use toml_edit::{DocumentMut, value};

use super::{Exit, assets_for, say, say_error, unwritable};
use crate::assets::{AssetKind, Assets};
use crate::files::write_new;
use crate::schema::scenario_text;
use crate::suggest::{did_you_mean, listed};
use crate::tasks::{TASKS, TaskKind};

pub const AFTER_HELP: &str = "\
A new scenario is a shipped one that says as comments what else could be stated, with defaults. It passes `wield check`
and runs as it is. A new tool is a copy of the first one of its family.

Nothing is overwritten.

Examples:
  wield new                           the kinds of scenarios
  wield new push                      push.toml
  wield new cut --out melon.toml
  wield new tool l --name my_l        assets/tools/my_l.toml

Exit codes: 0 success, 2 bad input or a file that is there already.";

/// What stands in the place of a kind of task for a tool.
const TOOL: &str = "tool";

/// Options of `wield new`.
#[derive(Debug, clap::Args)]
pub struct NewArguments {
    /// Kind of task, or `tool`; the kinds are listed if absent
    #[arg(value_name = "TASK")]
    what: Option<String>,
    /// Family of the tool
    #[arg(value_name = "FAMILY")]
    family: Option<String>,
    /// Name of the tool
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// File to write [default: <TASK>.toml, for a tool <NAME>.toml in the folder of tools]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Writes the file and says what to do with it.
pub fn execute(arguments: &NewArguments, assets: Option<&Path>) -> Exit {
    let Some(what) = &arguments.what else { return say(&kinds()) };
    let made = if what == TOOL { tool(arguments, &assets_for(assets, None)) } else { scenario(arguments, what) };
    let (file, text) = match made {
        Ok(made) => made,
        Err(reason) => {
            say_error(&format!("new: {reason}"));
            return Exit::BadInput;
        }
    };
    match write_new(&file, text.as_bytes()) {
        Ok(()) => say(&format!("{}\n", file.display())),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            say_error(&format!("new: {} is there already; name another place with --out", file.display()));
            Exit::BadInput
        }
        Err(error) => {
            say_error(&unwritable(&file, &error, "--out"));
            Exit::BadInput
        }
    }
}

fn kinds() -> String {
    let width = TASKS.iter().map(|kind| kind.name.len()).max().unwrap_or(0);
    TASKS.iter().map(|kind| format!("{:width$}  {}\n", kind.name, kind.summary)).collect()
}

fn scenario(arguments: &NewArguments, what: &str) -> Result<(PathBuf, String), String> {
    if let Some(extra) = arguments.family.as_ref().or(arguments.name.as_ref()) {
        return Err(format!(
            "found {extra:?} for a scenario; expected it only for a tool; a scenario's name is its file's"
        ));
    }
    let kind = TASKS.iter().find(|kind| kind.name == what).ok_or_else(|| {
        let names: Vec<&str> = TASKS.iter().map(|kind: &TaskKind| kind.name).chain([TOOL]).collect();
        let meant = did_you_mean(what, &names).map_or_else(String::new, |meant| format!("; {meant}"));
        format!("found {what:?}; expected one of {}{meant}", listed(&names))
    })?;
    let file = arguments.out.clone().unwrap_or_else(|| format!("{what}.toml").into());
    Ok((file.clone(), scenario_text(kind, &file.display().to_string())?))
}

fn tool(arguments: &NewArguments, assets: &Assets) -> Result<(PathBuf, String), String> {
    let (Some(family), Some(name)) = (&arguments.family, &arguments.name) else {
        return Err("found no family or no name of the tool; expected both, as in: wield new tool l --name my_l".into());
    };
    if name.is_empty() || !name.chars().all(|letter| letter.is_alphanumeric() || letter == '_' || letter == '-') {
        return Err(format!("found the name {name:?}; expected letters, digits, `_` and `-` only"));
    }
    let mut families = Vec::new();
    for file in assets.list(AssetKind::Tool).iter().filter_map(|stem| assets.path(AssetKind::Tool, stem).ok()) {
        let Some(mut document) = std::fs::read_to_string(&file).ok().and_then(|text| text.parse::<DocumentMut>().ok())
        else {
            continue;
        };
        let own = document.get("family").and_then(|table| table.as_table_like()).and_then(|table| table.iter().next());
        let Some(own) = own.map(|(own, _)| own.to_owned()) else { continue };
        if own == *family {
            document["name"] = value(name.as_str());
            let folder = assets.root().join(AssetKind::Tool.folder());
            let target = arguments.out.clone().unwrap_or_else(|| folder.join(format!("{name}.toml")));
            return Ok((target, document.to_string()));
        }
        families.push(own);
    }
    families.sort();
    families.dedup();
    Err(format!(
        "found the family {family:?}; expected one of {} (of the tools in {})",
        listed(&families),
        assets.root().display()
    ))
}
