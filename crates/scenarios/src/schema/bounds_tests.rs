//! Tests of the ranges that schemas state: what a schema refuses the loader refuses, and the other way round.
//!
//! A range is stated twice, by a validator and by an attribute of the same field. Each number of each shipped file is put
//! at the ends of the range that the schema states for it, and just beyond; and far out where the schema states none.

use std::collections::BTreeSet;
use std::path::PathBuf;

use rayon::prelude::*;
use serde_json::Value;
use sim::cutting::food::FoodFile;
use sim::cutting::knife::KnifeFile;
use skills::tool::Tool;

use super::place::{at, resolved};
use super::{FILES, wholes};
use crate::assets::Assets;
use crate::diagnostic::Diagnostic;
use crate::scenario::changes::with;
use crate::scenario::named::{TomlAsset, read_asset};
use crate::scenario::{Change, Source, load, load_text};
use crate::tasks::pour::Vessel;

const PROJECT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Far beyond all that makes sense.
const FAR: f64 = 1e300;

/// Keys whose range depends on other keys, so that a schema cannot state it.
const DEPENDENT: &[&str] = &[
    "container profile.bottle.neck_radius_m maximum",
    "container profile.cone.mouth_radius_m minimum",
    "container spout.depth_m maximum",
    "container spout.length_m maximum",
    "container spout.lip_width_m maximum",
    "container spout.rise_m maximum",
    "container spout.width_m maximum",
    "container spout.width_m minimum",
    "food shape.banana.curvature_radius_m minimum",
    "food shape.banana.end_length_m maximum",
    "food shape.banana.tip_diameter_m maximum",
    "food shape.banana.tip_diameter_m minimum",
    "food shape.berry.shoulder_m maximum",
    "food shape.disc.edge_radius_m maximum",
    "knife blade.chef.belly_radius_m minimum",
    "knife blade.chef.edge_radius_m maximum",
    "knife blade.cleaver.edge_radius_m maximum",
    "knife blade.paring.belly_radius_m minimum",
    "knife blade.paring.edge_radius_m maximum",
    "knife blade.serrated.blade.edge_radius_m maximum",
    "knife blade.serrated.tooth_depth_m maximum",
    "knife blade.serrated.tooth_pitch_m maximum",
    "knife blade.wire.bow_height_m minimum",
    "scenario demonstrations.synthetic.human.hand.gain_per_s maximum",
    "scenario demonstrations.synthetic.human.lift_m minimum",
    "scenario task.pour.options.beside_m minimum",
    "scenario task.pour.options.largest_gap_m minimum",
    "scenario task.pour.options.margin_m minimum",
    "scenario task.pour.options.pour_rate_rad_per_s maximum",
    "scenario task.push.transfer.planner.flip.contact_tolerance_m maximum",
];

/// Keys whose range is fixed and that no schema states: lists of gains, and structs that pass their checks on to others.
const NOT_STATED: &[&str] = &[
    "scenario controller.impedance.damping_nm_s_per_rad.0 minimum",
    "scenario demonstrations.synthetic.human.hand.gain_per_s minimum",
    "scenario engine.contact_frequency_hz maximum",
    "scenario engine.contact_frequency_hz minimum",
    "scenario engine.control_period_s maximum",
    "scenario engine.control_period_s minimum",
    "scenario engine.length_unit_m maximum",
    "scenario engine.length_unit_m minimum",
    "scenario engine.static_contact_frequency_hz maximum",
    "scenario engine.static_contact_frequency_hz minimum",
    "scenario engine.time_step_s maximum",
    "scenario engine.time_step_s minimum",
    "scenario food.scale maximum",
    "scenario food.scale minimum",
    "scenario food.toughness_j_per_m2 minimum",
    "scenario task.push.park_m.0 maximum",
    "scenario task.push.park_m.0 minimum",
    "scenario world.obstacles.0.friction maximum",
    "scenario world.obstacles.0.friction minimum",
];

/// A shipped file whose numbers are changed.
struct Shipped {
    /// Kind of file.
    kind: &'static str,
    /// Kind of task, if it is a scenario.
    task: Option<&'static str>,
    source: Source,
}

fn assets() -> Assets {
    Assets::at(format!("{PROJECT}/assets"))
}

fn files_in(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(format!("{PROJECT}/{folder}")).unwrap().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    files.sort();
    files
}

/// All shipped scenarios with their defaults written out, and all assets.
fn shipped() -> Vec<Shipped> {
    let scenario = |file: PathBuf| {
        let scenario = load(&file, &assets()).unwrap();
        let text = scenario.text(1).unwrap();
        Shipped { kind: "scenario", task: Some(scenario.kind()), source: Source::new(file, text) }
    };
    let mut all: Vec<Shipped> = files_in("scenarios").into_iter().map(scenario).collect();
    for kind in FILES.iter().filter(|kind| kind.folder.starts_with("assets/")) {
        let asset = |file: PathBuf| Shipped { kind: kind.name, task: None, source: Source::read(&file).unwrap() };
        all.extend(files_in(kind.folder).into_iter().map(asset));
    }
    all
}

impl Shipped {
    /// What is said of the file with another number.
    fn problems_with(&self, path: &[String], value: toml::Value) -> Vec<Diagnostic> {
        let change = Change::new(path.join("."), value);
        let file = &self.source.file;
        if self.task.is_some() {
            return load_text(file, &self.source.text, &[change], &assets()).err().unwrap_or_default();
        }
        let source = with(&self.source, &[change]).unwrap();
        match self.kind {
            "tool" => refused::<Tool>(&source),
            "food" => refused::<FoodFile>(&source),
            "knife" => refused::<KnifeFile>(&source),
            _ => refused::<Vessel>(&source),
        }
    }

    /// The refusal of a number for being out of a range of its own, if there is one: its words.
    fn out_of_range(&self, path: &[String], value: &Value) -> Option<String> {
        let value = match value.as_i64() {
            Some(whole) => toml::Value::Integer(whole),
            None => toml::Value::Float(value.as_f64().unwrap()),
        };
        let last = path.iter().rfind(|step| step.parse::<usize>().is_err()).unwrap();
        let own = |problem: &Diagnostic| problem.title.contains(&format!("`{last}`"));
        let constant = |words: &String| {
            ["a number greater than", "a number of at least", "a number from"]
                .iter()
                .any(|head| words.starts_with(head))
        };
        self.problems_with(path, value).into_iter().filter(own).map(|problem| problem.expected).find(constant)
    }
}

fn refused<A: TomlAsset>(source: &Source) -> Vec<Diagnostic> {
    read_asset::<A>(source).err().unwrap_or_default()
}

/// Paths of all numbers of a file.
fn numbers(value: &toml::Value, path: &mut Vec<String>, found: &mut Vec<Vec<String>>) {
    let children: Vec<(String, &toml::Value)> = match value {
        toml::Value::Integer(_) | toml::Value::Float(_) => return found.push(path.clone()),
        toml::Value::Table(entries) => entries.iter().map(|(key, value)| (key.clone(), value)).collect(),
        toml::Value::Array(entries) => entries.iter().enumerate().map(|(at, value)| (at.to_string(), value)).collect(),
        _ => return,
    };
    for (step, child) in children {
        path.push(step);
        numbers(child, path, found);
        path.pop();
    }
}

/// A path with all entries of lists alike.
fn general(path: &[String]) -> String {
    let step = |step: &String| if step.parse::<usize>().is_ok() { "0".to_owned() } else { step.clone() };
    path.iter().map(step).collect::<Vec<_>>().join(".")
}

/// What the schema states of a number: values that it takes and values that it refuses.
fn probes(part: &Value) -> (Vec<Value>, Vec<Value>) {
    let (mut taken, mut refused) = (Vec::new(), Vec::new());
    let float = |name: &str| part[name].as_f64();
    // the number of a type without a sign is refused by its type
    if part["type"] == "number" {
        if let Some(least) = float("minimum") {
            taken.push(least);
            refused.push(least.next_down());
        }
        if let Some(most) = float("maximum") {
            taken.push(most);
            refused.push(most.next_up());
        }
        if let Some(bound) = float("exclusiveMinimum") {
            taken.push(bound.next_up().max(f64::MIN_POSITIVE));
            refused.push(bound);
        }
    }
    let values = |numbers: Vec<f64>| numbers.into_iter().map(Value::from).collect();
    (values(taken), values(refused))
}

/// What is wrong with the range of one key, and whether it is one that only the validator knows.
#[derive(Default)]
struct Findings {
    wrong: Vec<String>,
    only_validated: BTreeSet<String>,
    checked: usize,
}

fn look_at(file: &Shipped, schema: &Value, whole: &Value, path: &[String]) -> Findings {
    let mut findings = Findings::default();
    let steps: Vec<&str> = path.iter().map(String::as_str).collect();
    let Some(part) = at(schema, whole, &steps).map(|part| resolved(schema, part)) else { return findings };
    let name = format!("{} {}: {}", file.kind, file.source.file.display(), path.join("."));
    let (taken, refused) = probes(part);
    for value in &taken {
        if let Some(words) = file.out_of_range(path, value) {
            findings.wrong.push(format!("{name}: the schema takes {value}, the loader expects {words}"));
        }
    }
    for value in &refused {
        findings.checked += 1;
        if file.out_of_range(path, value).is_none() {
            findings.wrong.push(format!("{name}: the schema refuses {value}, the loader takes it"));
        }
    }
    let bounded = |names: &[&str]| names.iter().any(|name| part.get(*name).is_some());
    for (far, names) in [(-FAR, &["minimum", "exclusiveMinimum"][..]), (FAR, &["maximum"])] {
        if part["type"] == "number" && !bounded(names) && file.out_of_range(path, &Value::from(far)).is_some() {
            findings.only_validated.insert(format!("{} {} {}", file.kind, general(path), names[0]));
        }
    }
    findings
}

#[test]
fn schemas_and_loader_refuse_the_same_numbers() {
    let schemas: Vec<(&str, Value)> = FILES.iter().map(|kind| (kind.name, kind.schema())).collect();
    let mut seen = BTreeSet::new();
    let shipped = shipped();
    let mut jobs = Vec::new();
    for file in &shipped {
        let schema = &schemas.iter().find(|(name, _)| *name == file.kind).unwrap().1;
        let whole = wholes(schema).into_iter().find(|(task, _)| *task == file.task).unwrap().1;
        let (mut found, table) = (Vec::new(), file.source.text.parse::<toml::Table>().unwrap());
        numbers(&toml::Value::Table(table), &mut Vec::new(), &mut found);
        for path in found {
            // alike entries of lists, and keys that an earlier file of this kind has, are looked at once
            if seen.insert((file.kind, file.task, general(&path))) {
                jobs.push((file, schema, whole, path));
            }
        }
    }
    let findings: Vec<Findings> =
        jobs.par_iter().map(|(file, schema, whole, path)| look_at(file, schema, whole, path)).collect();
    let wrong: Vec<&String> = findings.iter().flat_map(|found| &found.wrong).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let checked: usize = findings.iter().map(|found| found.checked).sum();
    assert!(checked > 200, "only {checked} ends of ranges were looked at");
    let only_validated: BTreeSet<&str> =
        findings.iter().flat_map(|found| &found.only_validated).map(String::as_str).collect();
    let known: BTreeSet<&str> = DEPENDENT.iter().chain(NOT_STATED).copied().collect();
    assert_eq!(only_validated, known, "ranges that only the validators state");
}
