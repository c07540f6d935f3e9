//! JSON Schemas of the files that people write, made from the very structs that read them.
//!
//! A new kind of file is one line of [`FILES`]; a new kind of task adds its schema to that of scenarios by its
//! `TaskKind`.

mod keys;
mod place;
mod query;
mod shown;
mod template;
mod tidy;
mod words;

use schemars::generate::{SchemaGenerator, SchemaSettings};
use schemars::{JsonSchema, Schema};
use serde_json::{Map, Value, json};
use sim::cutting::food::FoodFile;
use sim::cutting::knife::KnifeFile;
use skills::tool::Tool;

pub(crate) use keys::Key;
pub(crate) use query::{Answer, Book, answers, books};
pub(crate) use shown::shown;
pub(crate) use template::scenario_text;
pub(crate) use words::{as_toml, first_sentence};

use crate::scenario::Source;
use crate::scenario::named::TomlAsset;
use crate::sweep::{EXAMPLE as SWEEP_EXAMPLE, SweepFile};
use crate::tasks::TASKS;
use crate::tasks::pour::Vessel;
use crate::tool_design::{DesignFile, EXAMPLE as DESIGN_EXAMPLE};

/// Makes the schema of one type, and leaves those of its parts with the generator.
pub(crate) type Subschema = fn(&mut SchemaGenerator) -> Schema;

/// The dialect in which the schemas are written.
const DIALECT: &str = "https://json-schema.org/draft/2020-12/schema";

/// A kind of file that people write.
pub struct FileKind {
    /// What one of them is called: "tool".
    pub name: &'static str,
    /// Where they are: `assets/tools`.
    pub folder: &'static str,
    /// One line about them.
    pub summary: &'static str,
    /// Schema of the whole file.
    make: Subschema,
    /// Path and text of shipped files that show how keys are written.
    examples: fn() -> Vec<Source>,
}

/// All kinds of files that have a schema.
pub const FILES: &[FileKind] = &[
    FileKind {
        name: "scenario",
        folder: "scenarios",
        summary: "One experiment: what is there, what is to be done, how it is learned, carried out and judged.",
        make: any_scenario,
        examples: || TASKS.iter().map(crate::tasks::TaskKind::example).collect(),
    },
    FileKind {
        name: "sweep",
        folder: "scenarios/sweeps",
        summary: "Many runs of one scenario: what is varied, over what, under which seeds.",
        make: subschema::<SweepFile>,
        examples: || vec![shipped(SWEEP_EXAMPLE)],
    },
    FileKind {
        name: "design",
        folder: "scenarios/designs",
        summary: "What of a tool may be changed so that a scenario goes better by one measure.",
        make: subschema::<DesignFile>,
        examples: || vec![shipped(DESIGN_EXAMPLE)],
    },
    asset::<Tool>("assets/tools", "A tool: its shape, mass and contact surfaces."),
    asset::<FoodFile>("assets/foods", "A food: its shape and what it is made of."),
    asset::<KnifeFile>("assets/knives", "A knife: its blade and its handle."),
    asset::<Vessel>("assets/containers", "A container that is poured from or into."),
];

/// A kind of asset.
const fn asset<A: TomlAsset>(folder: &'static str, summary: &'static str) -> FileKind
where
    A::File: JsonSchema,
{
    FileKind { name: A::KIND.noun(), folder, summary, make: subschema::<A::File>, examples: example_of::<A> }
}

fn example_of<A: TomlAsset>() -> Vec<Source> {
    vec![shipped(A::EXAMPLE)]
}

/// A shipped file by its path and text.
fn shipped((file, text): (&str, &str)) -> Source {
    Source::new(file, text)
}

/// The schema of a type.
pub(crate) fn subschema<T: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    generator.subschema_for::<T>()
}

/// A scenario of any kind: each kind demands its own name under `task`, so that exactly one of them fits.
fn any_scenario(generator: &mut SchemaGenerator) -> Schema {
    let kinds: Vec<Schema> = TASKS.iter().map(|kind| (kind.schema)(generator)).collect();
    schemars::json_schema!({ "oneOf": kinds })
}

impl FileKind {
    /// The schema, as a JSON document.
    #[must_use]
    pub fn schema(&self) -> Value {
        let mut generator = SchemaSettings::draft2020_12().into_generator();
        let root = (self.make)(&mut generator).to_value();
        let mut parts = generator.take_definitions(true);
        // what the whole file is stands at the root, and not behind a reference
        let named = root["$ref"].as_str().and_then(|path| path.rsplit('/').next()).and_then(|name| parts.remove(name));
        let mut whole = match named.unwrap_or(root) {
            Value::Object(whole) => whole,
            _ => Map::new(),
        };
        whole.insert("$schema".into(), json!(DIALECT));
        whole.insert("title".into(), json!(self.name));
        whole.insert("description".into(), json!(self.summary));
        whole.insert("$defs".into(), Value::Object(parts));
        let mut whole = Value::Object(whole);
        tidy::tidy(&mut whole);
        whole
    }

    /// The same as text, with a line break at its end.
    #[must_use]
    pub fn schema_text(&self) -> String {
        format!("{:#}\n", self.schema())
    }

    /// Name of the file that holds the schema.
    #[must_use]
    pub fn schema_file(&self) -> String {
        format!("{}.schema.json", self.name)
    }

    /// Shipped files that show how keys are written: one for each kind of task, or one.
    pub(crate) fn examples(&self) -> Vec<Source> {
        (self.examples)()
    }
}

/// The parts of a schema that stand for a whole file each, with the kind of task, if files differ in it.
pub(crate) fn wholes(schema: &Value) -> Vec<(Option<&'static str>, &Value)> {
    match schema["oneOf"].as_array() {
        Some(kinds) => TASKS.iter().map(|kind| Some(kind.name)).zip(kinds).collect(),
        None => vec![(None, schema)],
    }
}

#[cfg(test)]
#[path = "bounds_tests.rs"]
mod bounds_tests;
#[cfg(test)]
#[path = "schema_tests.rs"]
mod tests;
