//! Loading: from a scenario file to a checked scenario with everything that it names.

use std::path::Path;

use skills::demonstration::Demonstration;

use super::check::{check_arm, check_places, check_surfaces};
use super::document::{Node, path};
use super::draft::{Draft, read};
use super::explain::Context;
use super::named::{Reader, field_problem};
use super::parts::name_of_file;
use super::source::Source;
use super::{DemonstrationsConfig, ResolvedScenario, Scenario, SkillsFile};
use crate::assets::Assets;
use crate::diagnostic::Diagnostic;

/// Reads and checks a scenario file and everything that it names.
///
/// # Errors
/// Everything that is wrong, as far as it can be told apart: at least one [`Diagnostic`].
pub fn load(file: &Path, assets: &Assets) -> Result<ResolvedScenario, Vec<Diagnostic>> {
    let source = Source::read(file).map_err(|problem| vec![*problem])?;
    resolve(&source, assets)
}

/// Remarks on a scenario that can be used: oddities of its robot's description.
#[must_use]
pub fn notes(resolved: &ResolvedScenario) -> Vec<String> {
    let robot = &resolved.scenario.robot.asset;
    resolved.arm.warnings().iter().map(|warning| format!("robot `{robot}`: {warning}")).collect()
}

/// Title of a scenario file, for lists; `None` if the file cannot be read that far.
#[must_use]
pub fn title(file: &Path) -> Option<String> {
    let source = Source::read(file).ok()?;
    match &Node::parse(&source).ok()?.at(&path("scenario.title"))?.value {
        super::document::Value::Text(title) => Some(title.clone()),
        _ => None,
    }
}

/// A scenario file that shows how keys are written.
fn example() -> Source {
    let text = include_str!("../../../../scenarios/push_stick.toml");
    Source { file: "scenarios/push_stick.toml".into(), text: text.into() }
}

fn resolve(source: &Source, assets: &Assets) -> Result<ResolvedScenario, Vec<Diagnostic>> {
    let example = example();
    let Draft { value, tree, mut problems } = read::<Scenario>(source, &example);
    let (Some(mut scenario), Some(tree)) = (value, tree) else { return Err(problems) };
    let context = Context { source, tree: &tree, example: &example };

    let refused = scenario.refused_values();
    // an object without size or a map without extent would only draw consequential complaints
    let placeable =
        !refused.iter().any(|error| ["world.", "object.", "task."].iter().any(|part| error.field.starts_with(part)));
    problems.extend(refused.into_iter().map(|error| field_problem(context, error)));
    if placeable {
        problems.extend(check_places(context, &scenario));
    }
    let mut reader = Reader { assets, context, problems };
    let named = read_named(&mut reader, &scenario);
    let mut problems = reader.problems;
    if let Some(arm) = &named.arm {
        problems.extend(check_arm(context, &scenario, arm));
    }
    if let Some(tool) = &named.demonstration_tool {
        problems.extend(check_surfaces(context, &scenario, tool));
    }
    problems.sort_by_key(|problem| (problem.file != source.file, problem.place.as_ref().map(|place| place.span.start)));
    match named {
        Named {
            tool: Some(tool),
            demonstration_tool: Some(demonstration_tool),
            arm: Some(arm),
            recorded: Some(recorded),
            learned: Some(learned),
        } if problems.is_empty() => {
            let name = scenario.scenario.name.get_or_insert_with(|| name_of_file(&source.file)).clone();
            let source = source.text.to_string();
            Ok(ResolvedScenario { name, scenario, tool, demonstration_tool, arm, recorded, learned, source })
        }
        _ => Err(problems),
    }
}

/// What a scenario names, as far as it could be read.
struct Named {
    tool: Option<skills::tool::Tool>,
    demonstration_tool: Option<skills::tool::Tool>,
    arm: Option<robot::Manipulator>,
    recorded: Option<Vec<Demonstration>>,
    learned: Option<Option<SkillsFile>>,
}

fn read_named(reader: &mut Reader<'_>, scenario: &Scenario) -> Named {
    let tool = reader.tool("tool.asset", &scenario.tool.asset);
    let arm = reader.arm("robot.asset", &scenario.robot.asset);
    let (key, own_tool, names): (_, _, &[String]) = match &scenario.demonstrations {
        DemonstrationsConfig::Synthetic(synthetic) => ("demonstrations.synthetic.tool", &synthetic.tool, &[]),
        DemonstrationsConfig::Recorded { assets, tool } => ("demonstrations.recorded.tool", tool, assets),
        DemonstrationsConfig::Learned { asset } => {
            let read = reader.skills("demonstrations.learned.asset", asset);
            let (demonstration_tool, learned) =
                read.map_or((None, None), |(tool, file)| (Some(tool), Some(Some(file))));
            return Named { tool, demonstration_tool, arm, recorded: Some(Vec::new()), learned };
        }
    };
    let demonstration_tool = match own_tool {
        Some(name) => reader.tool(key, name),
        None => tool.clone(),
    };
    let recorded: Vec<_> = names
        .iter()
        .enumerate()
        .map(|(index, name)| reader.demonstration(&format!("demonstrations.recorded.assets.{index}"), name))
        .collect();
    Named { tool, demonstration_tool, arm, recorded: recorded.into_iter().collect(), learned: Some(None) }
}

#[cfg(test)]
#[path = "load_tests.rs"]
mod tests;
