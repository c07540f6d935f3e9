//! `wield list`: what there is to run and to name in scenarios.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use sim::cutting::food::FoodFile;
use sim::cutting::knife::KnifeFile;

use super::{Exit, assets_for, say, say_error};
use crate::assets::{AssetKind, Assets, stems};
use crate::scenario::{asset_description, demonstration_description, skills_description, stated_description, title};
use crate::sweep::sweep_title;
use crate::tasks::TASKS;
use crate::tool_design::design_title;

/// Options of `wield list`.
#[derive(Debug, clap::Args)]
pub struct ListArguments {
    /// What to list; everything if absent
    #[arg(value_name = "KIND")]
    kind: Option<Listed>,
}

/// What can be listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Listed {
    /// Scenario files beside the folder of assets
    Scenarios,
    /// Sweep files, in the folder `sweeps` of the scenarios
    Sweeps,
    /// Design files, in the folder `designs` of the scenarios
    Designs,
    /// Tool shapes
    Tools,
    /// Arms
    Robots,
    /// Kinds of tasks
    Tasks,
    /// Recorded demonstrations
    Demonstrations,
    /// Learned skills
    Skills,
    /// What can be cut
    Foods,
    /// What cuts
    Knives,
    /// What can be poured from or into
    Containers,
}

impl Listed {
    /// Whether a list of everything leaves it out if there is none.
    fn is_rare(self) -> bool {
        matches!(self, Self::Sweeps | Self::Designs | Self::Foods | Self::Knives | Self::Containers)
    }
}

/// Prints one line for each thing of the kind, or of all kinds under their headings.
pub fn execute(arguments: &ListArguments, assets: Option<&Path>) -> Exit {
    let assets = assets_for(assets, None);
    if !assets.root().is_dir() && arguments.kind != Some(Listed::Tasks) {
        say_error(&format!(
            "list: found no folder of assets at {}; expected one; name it with --assets DIR or WIELD_ASSETS",
            assets.root().display()
        ));
        return Exit::BadInput;
    }
    match arguments.kind {
        Some(kind) => say(&lines(&entries(kind, &assets), "")),
        None => {
            let sections = Listed::value_variants().iter().filter_map(|&kind| section(kind, &assets));
            say(&sections.collect::<Vec<_>>().join("\n"))
        }
    }
}

/// All of a kind under its heading; `None` if a kind that seldom exists does not.
fn section(kind: Listed, assets: &Assets) -> Option<String> {
    let heading = kind.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
    let entries = entries(kind, assets);
    let body = match entries.is_empty() {
        true if kind.is_rare() => return None,
        true => "  none\n".to_owned(),
        false => lines(&entries, "  "),
    };
    Some(format!("{heading}:\n{body}"))
}

/// Name and description of each thing of a kind.
fn entries(kind: Listed, assets: &Assets) -> Vec<(String, String)> {
    let describe = |kind: AssetKind, describe: fn(&Path) -> String| {
        let named = assets.list(kind).into_iter();
        named
            .map(|name| {
                let text = assets.path(kind, &name).map_or_else(|error| error.to_string(), |file| describe(&file));
                (name, text)
            })
            .collect()
    };
    match kind {
        Listed::Scenarios => beside(assets, "scenarios", |file| title(file).unwrap_or_else(|| BROKEN.into())),
        Listed::Sweeps => beside(assets, "scenarios/sweeps", |file| sweep_title(file).unwrap_or_else(|| BROKEN.into())),
        Listed::Designs => {
            beside(assets, "scenarios/designs", |file| design_title(file).unwrap_or_else(|| BROKEN.into()))
        }
        Listed::Tools => describe(AssetKind::Tool, tool),
        Listed::Robots => describe(AssetKind::Robot, robot),
        Listed::Tasks => TASKS.iter().map(|task| (task.name.to_owned(), task.summary.to_owned())).collect(),
        Listed::Demonstrations => describe(AssetKind::Demonstration, demonstration),
        Listed::Skills => describe(AssetKind::Skills, skills),
        Listed::Foods => describe(AssetKind::Food, food),
        Listed::Knives => describe(AssetKind::Knife, knife),
        Listed::Containers => describe(AssetKind::Container, described),
    }
}

/// What is said about a file that cannot be read.
const BROKEN: &str = "(broken: `wield check` tells why)";

/// Path and description of each TOML file of a folder beside that of the assets.
fn beside(assets: &Assets, folder: &str, describe: impl Fn(&Path) -> String) -> Vec<(String, String)> {
    let folder = assets.root().parent().map_or_else(|| PathBuf::from(folder), |project| project.join(folder));
    let files = stems(&folder, "toml").into_iter().map(|stem| folder.join(format!("{stem}.toml")));
    files.map(|file| (file.display().to_string(), describe(&file))).collect()
}

fn tool(file: &Path) -> String {
    asset_description(file, |tool: skills::tool::Tool| tool.description)
        .unwrap_or_else(|problems| first_line(problems.first()))
}

fn food(file: &Path) -> String {
    asset_description(file, |food: FoodFile| food.description).unwrap_or_else(|problems| first_line(problems.first()))
}

fn knife(file: &Path) -> String {
    asset_description(file, |knife: KnifeFile| knife.description)
        .unwrap_or_else(|problems| first_line(problems.first()))
}

fn robot(file: &Path) -> String {
    let read = || -> Result<robot::Manipulator, String> {
        let text = std::fs::read_to_string(file).map_err(|error| error.to_string())?;
        robot::Manipulator::from_urdf_str(&text).map_err(|error| error.to_string())
    };
    match read() {
        Ok(arm) => format!("{} joints, {} frames", arm.joint_count(), arm.frame_names().count()),
        Err(reason) => format!("(broken: {reason})"),
    }
}

fn demonstration(file: &Path) -> String {
    demonstration_description(file).unwrap_or_else(|problem| first_line(Some(&problem)))
}

fn skills(file: &Path) -> String {
    skills_description(file).unwrap_or_else(|problems| first_line(problems.first()))
}

fn described(file: &Path) -> String {
    stated_description(file).unwrap_or_else(|problem| first_line(Some(&problem)))
}

fn first_line(problem: Option<&crate::diagnostic::Diagnostic>) -> String {
    format!("(broken: {})", problem.map_or_else(String::new, |problem| problem.title.clone()))
}

fn lines(entries: &[(String, String)], indent: &str) -> String {
    let width = entries.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    entries.iter().map(|(name, text)| format!("{}\n", format!("{indent}{name:width$}  {text}").trim_end())).collect()
}
