//! A pushing scenario with the tools, demonstrations and skills that it names.

use skills::demonstration::Demonstration;
use skills::field::FieldError;
use skills::tool::Tool;
use skills::tool_use::SavedLibrary;

use super::check::{check_places, check_surfaces};
use super::{DemonstrationsConfig, KIND, PushScenario, PushTask, SyntheticConfig};
use crate::scenario::{ReadScenario, Reader, ResolvedScenario, ScenarioFile, SkillsFile};
use crate::tasks::{ResolvedTask, Runnable, TaskPart, written};

/// What a checked scenario of a push holds.
#[derive(Clone, Debug)]
pub struct ResolvedPush {
    /// The scenario with all defaults filled in, the name too.
    pub scenario: PushScenario,
    /// The tool in the hand.
    pub tool: Tool,
    /// The tool of the demonstrations.
    pub demonstration_tool: Tool,
    /// The recorded demonstrations that the scenario names, in its order.
    pub recorded: Vec<Demonstration>,
    /// The skills that the scenario names instead of demonstrations.
    pub learned: Option<SkillsFile<SavedLibrary>>,
}

impl ResolvedPush {
    /// Name of the file of the tool that the demonstrations were or are to be shown with.
    #[must_use]
    pub fn demonstration_tool_name(&self) -> &str {
        let own = match &self.scenario.demonstrations {
            DemonstrationsConfig::Synthetic(SyntheticConfig { tool, .. })
            | DemonstrationsConfig::Recorded { tool, .. } => tool.as_deref(),
            DemonstrationsConfig::Learned { .. } => self.learned.as_ref().map(|file| file.learned.tool.as_str()),
        };
        own.unwrap_or(&self.scenario.tool.asset)
    }
}

impl TaskPart for ResolvedPush {
    fn kind(&self) -> &'static str {
        KIND.name
    }

    fn file(&self) -> &dyn ScenarioFile {
        &self.scenario
    }

    fn text(&self, seed: u64) -> Result<String, String> {
        written(&self.scenario, seed)
    }

    fn as_push(&self) -> Option<&ResolvedPush> {
        Some(self)
    }

    fn start<'a>(&'a self, scenario: &'a ResolvedScenario, seed: u64) -> Box<dyn Runnable + 'a> {
        Box::new(PushTask::new(scenario, self, seed))
    }
}

impl ReadScenario for PushScenario {
    fn resolve(self, reader: &mut Reader<'_>, refused: &[FieldError]) -> Option<ResolvedTask> {
        // an object without size or a map without extent would only draw consequential complaints
        let misplaces =
            |error: &FieldError| ["world.", "object.", "task."].iter().any(|part| error.field.starts_with(part));
        if !refused.iter().any(misplaces) {
            reader.problems.extend(check_places(reader.context, &self));
        }
        let tool: Option<Tool> = reader.asset("tool.asset", &self.tool.asset);
        let shown = Shown::read(reader, &self.demonstrations, tool.as_ref());
        if let Some(tool) = &shown.tool {
            reader.problems.extend(check_surfaces(reader.context, &self, tool));
        }
        let push = ResolvedPush {
            scenario: self,
            tool: tool?,
            demonstration_tool: shown.tool?,
            recorded: shown.recorded?,
            learned: shown.learned?,
        };
        Some(ResolvedTask::Push(Box::new(push)))
    }
}

/// What a scenario names of its demonstrations, as far as it could be read.
struct Shown {
    tool: Option<Tool>,
    recorded: Option<Vec<Demonstration>>,
    learned: Option<Option<SkillsFile<SavedLibrary>>>,
}

impl Shown {
    fn read(reader: &mut Reader<'_>, demonstrations: &DemonstrationsConfig, scenario_tool: Option<&Tool>) -> Self {
        let (key, own_tool, names): (_, _, &[String]) = match demonstrations {
            DemonstrationsConfig::Synthetic(synthetic) => ("demonstrations.synthetic.tool", &synthetic.tool, &[]),
            DemonstrationsConfig::Recorded { assets, tool } => ("demonstrations.recorded.tool", tool, assets),
            DemonstrationsConfig::Learned { asset } => {
                let key = "demonstrations.learned.asset";
                let read = reader.skills(key, asset, |reader, file: SkillsFile<SavedLibrary>| {
                    let tool: Tool = reader.asset(key, &file.learned.tool)?;
                    let restored = file.skills.clone().restore(&tool);
                    Some(restored.map(|_| (tool, file)))
                });
                let (tool, learned) = read.map_or((None, None), |(tool, file)| (Some(tool), Some(Some(file))));
                return Self { tool, recorded: Some(Vec::new()), learned };
            }
        };
        let tool = match own_tool {
            Some(name) => reader.asset(key, name),
            None => scenario_tool.cloned(),
        };
        let recorded: Vec<_> = names
            .iter()
            .enumerate()
            .map(|(index, name)| reader.demonstration(&format!("demonstrations.recorded.assets.{index}"), name))
            .collect();
        Self { tool, recorded: recorded.into_iter().collect(), learned: Some(None) }
    }
}
