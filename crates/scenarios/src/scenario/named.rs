//! What a scenario names: tools, arm and recorded demonstrations, read from the assets and checked.

use std::collections::BTreeMap;
use std::path::Path;

use robot::{Manipulator, MeshOptions};
use serde::de::DeserializeOwned;
use skills::demonstration::Demonstration;
use skills::field::FieldError;
use skills::primitive::RestoreError;
use skills::primitive::pose::PoseTrajectory;
use skills::tool::{Tool, ToolFile};

use super::changes::{INTO_ASSET, changed_asset};
use super::document::{Node, Value, path};
use super::draft::{Draft, read};
use super::explain::{Context, bad_value, key_name};
use super::skills_file::{self, SavedSkills, SkillsFile};
use super::source::Source;
use super::{AssetUsed, ResolvedScenario};
use crate::assets::{AssetError, AssetKind, Assets};
use crate::diagnostic::Diagnostic;
use crate::suggest::{did_you_mean, listed};
use crate::tasks::spatial::{is_poses, read_poses};
use crate::tasks::{TASKS, read_demonstration};

/// What is described by TOML files of its own in the assets.
pub(crate) trait TomlAsset: Sized {
    /// What is in such a file.
    type File: DeserializeOwned;
    /// Kind of the asset.
    const KIND: AssetKind;
    /// Path and text of a valid file, which shows how keys are written.
    const EXAMPLE: (&'static str, &'static str);

    /// Checks the numbers of a file and makes of it what is used.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    fn from_file(file: Self::File) -> Result<Self, FieldError>;
}

impl TomlAsset for Tool {
    type File = ToolFile;
    const KIND: AssetKind = AssetKind::Tool;
    const EXAMPLE: (&'static str, &'static str) =
        ("assets/tools/stick.toml", include_str!("../../../../assets/tools/stick.toml"));

    fn from_file(file: ToolFile) -> Result<Self, FieldError> {
        file.tool()
    }
}

/// Reads the assets that a scenario names, collecting what is wrong with them.
pub(crate) struct Reader<'a> {
    /// Where they are found.
    pub assets: &'a Assets,
    /// The scenario.
    pub context: Context<'a>,
    /// What is wrong.
    pub problems: Vec<Diagnostic>,
    /// What the scenario changes in them: a key of the scenario, a colon, a key of the file, and the value.
    pub asset_changes: BTreeMap<String, toml::Value>,
    /// The files that were read.
    pub used: Vec<AssetUsed>,
    /// The keys that asked for files.
    pub asked: Vec<String>,
}

impl Reader<'_> {
    /// Reads the asset `name` that the key at `key` asks for: a tool, a food.
    pub fn asset<A: TomlAsset>(&mut self, key: &str, name: &str) -> Option<A> {
        let source = self.source(A::KIND, key, name)?;
        let result = read_asset(&source);
        self.keep(key, result)
    }

    /// Reads the arm `name` that the key at `key` asks for.
    pub fn arm(&mut self, key: &str, name: &str) -> Option<Manipulator> {
        let source = self.source(AssetKind::Robot, key, name)?;
        let read = Manipulator::from_urdf_str(&source.text).and_then(|mut arm| {
            arm.resolve_meshes(&self.meshes());
            arm.check_dynamics()?;
            Ok(arm)
        });
        let result = read.map_err(|error| vec![urdf_problem(&source, &error.to_string())]);
        self.keep(key, result)
    }

    /// Where the meshes of arms are looked for: beside the arms, and for a package in the folder of its name there.
    fn meshes(&self) -> MeshOptions {
        let folder = self.assets.root().join(AssetKind::Robot.folder());
        let entries = std::fs::read_dir(&folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let packages = entries.filter(|path| path.is_dir());
        let named = packages.filter_map(|path| Some((path.file_name()?.to_str()?.to_owned(), path)));
        MeshOptions { package_roots: named.collect(), base_dir: Some(folder) }
    }

    /// Reads the demonstration `name` that the key at `key` asks for.
    pub fn demonstration(&mut self, key: &str, name: &str) -> Option<Demonstration> {
        let source = self.source(AssetKind::Demonstration, key, name)?;
        let result = read_demonstration(&source).map_err(|problem| vec![*problem]);
        self.keep(key, result)
    }

    /// Reads the recorded poses `name` of what was held that the key at `key` asks for.
    pub fn poses(&mut self, key: &str, name: &str) -> Option<PoseTrajectory> {
        let source = self.source(AssetKind::Demonstration, key, name)?;
        let result = read_poses(&source).map_err(|problem| vec![*problem]);
        self.keep(key, result)
    }

    /// Reads the skills `name` of one kind of task that the key at `key` asks for, and hands them to `restore`, which finds
    /// out whether they can be used.
    pub fn skills<S: SavedSkills, T>(
        &mut self,
        key: &str,
        name: &str,
        restore: impl FnOnce(&mut Self, SkillsFile<S>) -> Option<Result<T, RestoreError>>,
    ) -> Option<T> {
        let source = self.source(AssetKind::Skills, key, name)?;
        let result = skills_file::read(&source);
        let file = self.keep(key, result)?;
        let restored = restore(self, file)?.map_err(|error| skills_file::refusal::<S>(&source, error));
        self.keep(key, restored)
    }

    /// Keeps a value, or its problems with a remark on who asked for the file.
    fn keep<T>(&mut self, key: &str, result: Result<T, Vec<Diagnostic>>) -> Option<T> {
        let path = path(key);
        let named = self.context.problem_at_value(&path, "");
        let line = named.place.map_or_else(String::new, |place| format!(":{}", place.line));
        let remark = format!("{}{line} names this file: {}", named.file.display(), key_name(&path));
        let problems = match result {
            Ok(value) => return Some(value),
            Err(problems) => problems,
        };
        self.problems.extend(problems.into_iter().map(|problem| problem.help([remark.clone()])));
        None
    }

    fn source(&mut self, kind: AssetKind, key: &str, name: &str) -> Option<Source> {
        let result = self.assets.path(kind, name).map_err(|error| Box::new(self.refused(kind, key, name, error)));
        let source = result.and_then(|file| Source::read(&file));
        let source = source.map_err(|problem| self.problems.push(*problem)).ok()?;
        let digest = blake3::hash(source.text.as_bytes()).to_hex().to_string();
        self.used.push(AssetUsed { key: key.to_owned(), kind, name: name.to_owned(), digest });
        if kind.extension() != "toml" {
            return Some(source);
        }
        self.asked.push(key.to_owned());
        let changed = changed_asset(&source, key, &self.asset_changes, self.context.source);
        changed.map_err(|problem| self.problems.push(*problem)).ok()
    }

    /// Complains about changes in assets that no key asks for, or that are no TOML.
    pub fn refuse_idle_changes(&mut self) {
        // after another problem, not every key has had its turn
        if !self.problems.is_empty() {
            return;
        }
        let own = |whole: &str| whole.split_once(INTO_ASSET).map_or(whole, |(own, _)| own).to_owned();
        let idle = self.asset_changes.keys().filter(|whole| !self.asked.contains(&own(whole)));
        let problems: Vec<Diagnostic> = idle
            .map(|whole| {
                let key = ["scenario".to_owned(), "asset_changes".to_owned(), whole.clone()];
                self.context
                    .problem_at_value(&key, format!("`{}` names no asset", own(whole)))
                    .expected(format!("one of {} before the colon", listed(&self.asked)))
                    .help(did_you_mean(&own(whole), &self.asked))
            })
            .collect();
        self.problems.extend(problems);
    }

    fn refused(&self, kind: AssetKind, key: &str, name: &str, error: AssetError) -> Diagnostic {
        let path = path(key);
        let problem = |title: String| self.context.problem_at_value(&path, title).found(format!("{name:?}"));
        let folder = self.assets.root().join(kind.folder());
        match error {
            AssetError::Escapes => problem(format!("path escaping the project in {}", key_name(&path)))
                .expected(format!("the bare name of a file in {}", folder.display()))
                .help([format!("copy the file into that folder and name it without folder and .{}", kind.extension())]),
            AssetError::Unknown { known, .. } if known.is_empty() => {
                problem(format!("unknown {} in {}", kind.noun(), key_name(&path)))
                    .expected(format!("a .{} file in {}, but there is none", kind.extension(), folder.display()))
                    .help(["name the folder of assets with --assets DIR or the variable WIELD_ASSETS".to_owned()])
            }
            AssetError::Unknown { known, .. } => problem(format!("unknown {} in {}", kind.noun(), key_name(&path)))
                .expected(format!("one of {}", listed(&known)))
                .help(did_you_mean(name, &known)),
            AssetError::Unreadable { path: file, source } => {
                Diagnostic::of_file(&file, "the file cannot be read").found(source.to_string())
            }
        }
    }
}

/// The file of the asset that a key of a scenario names, if it is one of TOML.
pub(crate) fn asset_source(scenario: &ResolvedScenario, key: &str, assets: &Assets) -> Option<Source> {
    let used = scenario.assets.iter().find(|used| used.key == key && used.kind.extension() == "toml")?;
    Source::read(&assets.path(used.kind, &used.name).ok()?).ok()
}

/// Reads and checks the file of an asset.
pub(crate) fn read_asset<A: TomlAsset>(source: &Source) -> Result<A, Vec<Diagnostic>> {
    let (file, text) = A::EXAMPLE;
    let example = Source::new(file, text);
    let Draft { value, tree, mut problems } = read::<A::File>(source, &example);
    let (Some(file), Some(tree)) = (value, tree) else { return Err(problems) };
    match A::from_file(file) {
        Ok(asset) if problems.is_empty() => return Ok(asset),
        Ok(_) => {}
        Err(error) => problems.push(field_problem(Context { source, tree: &tree, example: &example }, error)),
    }
    Err(problems)
}

/// Title line of an asset's file, for lists.
pub(crate) fn asset_description<A: TomlAsset>(
    file: &Path,
    describe: fn(A) -> String,
) -> Result<String, Vec<Diagnostic>> {
    let source = Source::read(file).map_err(|problem| vec![*problem])?;
    read_asset(&source).map(describe)
}

/// What a TOML file says about itself under `description`, for lists; nothing else in it is looked at.
pub(crate) fn stated_description(file: &Path) -> Result<String, Box<Diagnostic>> {
    let tree = Node::parse(&Source::read(file)?)?;
    Ok(match tree.child("description").map(|node| &node.value) {
        Some(Value::Text(text)) => text.clone(),
        _ => String::new(),
    })
}

/// Length and rows of a recorded demonstration, for lists.
pub(crate) fn demonstration_description(file: &Path) -> Result<String, Box<Diagnostic>> {
    let source = Source::read(file)?;
    if is_poses(&source) {
        let poses = read_poses(&source)?;
        return Ok(format!("{:.1} s: {} poses in space", poses.duration_s(), poses.poses().len()));
    }
    let Demonstration { tool, object, .. } = read_demonstration(&source)?;
    Ok(format!("{:.1} s: {} poses of the tool, {} of the object", tool.duration_s(), tool.len(), object.len()))
}

/// Origin of learned skills, for lists.
pub(crate) fn skills_description(file: &Path) -> Result<String, Vec<Diagnostic>> {
    let source = Source::read(file).map_err(|problem| vec![*problem])?;
    let task = skills_file::task_of(&source).map_err(|problem| vec![*problem])?;
    let kind = TASKS.iter().find(|kind| kind.name == task);
    match kind.and_then(|kind| kind.skills) {
        Some(describe) => describe(&source),
        None => Err(vec![Diagnostic::of_file(&source.file, "skills of an unknown kind of task").found(task)]),
    }
}

/// A refused value of a checked struct, at its place.
pub(crate) fn field_problem(context: Context<'_>, error: FieldError) -> Diagnostic {
    let path = path(&error.field);
    context.problem_at_value(&path, bad_value(&path)).found(error.found).expected(error.expected)
}

/// A refused robot description, at the line of the element that it names.
fn urdf_problem(source: &Source, reason: &str) -> Diagnostic {
    let named = reason.split('`').skip(1).step_by(2).find_map(|name| {
        let start = source.text.find(&format!("name=\"{name}\""))?;
        Some(start..start + name.len() + "name=\"\"".len())
    });
    let span = line_place(source, reason).or(named).or_else(|| xml_place(source, reason)).unwrap_or(0..0);
    // what was attempted is said by the title
    let found = ["read urdf: ", "check dynamics: "].iter().find_map(|attempt| reason.strip_prefix(attempt));
    source.problem(span, "the robot cannot be used").found(found.unwrap_or(reason))
}

/// The text of the line that "line 12:" names.
fn line_place(source: &Source, reason: &str) -> Option<std::ops::Range<usize>> {
    let digits = reason.split_once("line ")?.1.split_once(':')?.0;
    let before = digits.parse::<usize>().ok()?.checked_sub(1)?;
    let start = source.text.split_inclusive('\n').take(before).map(str::len).sum::<usize>();
    let line = source.text.get(start..)?.lines().next()?;
    let blanks = line.len() - line.trim_start().len();
    Some(start + blanks..start + line.trim_end().len())
}

/// Byte of the first "line:column" in the words of an XML parser.
fn xml_place(source: &Source, reason: &str) -> Option<std::ops::Range<usize>> {
    let numbers = reason.split(|letter: char| !letter.is_ascii_digit() && letter != ':');
    let (line, column) = numbers.filter_map(|word| word.trim_matches(':').split_once(':')).next()?;
    let (line, column): (usize, usize) = (line.parse().ok()?, column.parse().ok()?);
    let line_start: usize = source.text.split_inclusive('\n').take(line.checked_sub(1)?).map(str::len).sum();
    let start = line_start + column.saturating_sub(1);
    Some(start..start + 1)
}
