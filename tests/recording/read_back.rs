//! Reads a recording back: rows of each entity, timelines, properties, layout.

use std::collections::{BTreeMap, BTreeSet};
use std::io::BufReader;
use std::path::Path;

use rerun::external::arrow::array::{Array as _, ArrayRef, AsArray as _};
use rerun::external::arrow::datatypes::{Float32Type, Float64Type};
use rerun::external::re_log_encoding;
use rerun::log::{Chunk, LogMsg};
use rerun::{ComponentIdentifier, StoreKind, TimelineName};

/// What a file holds.
#[derive(Default)]
pub struct ReadBack {
    /// Rows of each entity, those without time included.
    pub rows: BTreeMap<String, usize>,
    /// Names of all timelines.
    pub timelines: BTreeSet<String>,
    /// Steps of the rows that hold a pose of an entity.
    pub pose_steps: BTreeMap<String, Vec<i64>>,
    /// Last position of each entity that has one.
    pub places: BTreeMap<String, [f32; 3]>,
    /// Points of the last row of each entity that has points.
    pub points: BTreeMap<String, Vec<[f32; 3]>>,
    /// Last value of each curve.
    pub values: BTreeMap<String, f64>,
    /// Step from which on an entity is cleared.
    pub cleared: BTreeMap<String, i64>,
    /// Names of all properties.
    pub properties: Vec<String>,
    /// Messages of the layout.
    pub layout_rows: usize,
    /// For each layout that is put in force: as the active one, as the default.
    pub activations: Vec<(bool, bool)>,
}

/// Reads a file, complete or not.
pub fn read(path: &Path) -> ReadBack {
    let mut found = ReadBack::default();
    let file = BufReader::new(std::fs::File::open(path).unwrap());
    let messages = re_log_encoding::DecoderApp::decode_eager(file).unwrap();
    for message in messages {
        match message.unwrap() {
            LogMsg::ArrowMsg(store, rows) if store.kind() == StoreKind::Recording => {
                found.add(&Chunk::from_arrow_msg(&rows).unwrap());
            }
            LogMsg::ArrowMsg(..) => found.layout_rows += 1,
            LogMsg::BlueprintActivationCommand(command) => {
                found.activations.push((command.make_active, command.make_default))
            }
            LogMsg::SetStoreInfo(_) => {}
        }
    }
    found
}

impl ReadBack {
    fn add(&mut self, chunk: &Chunk) {
        let path = chunk.entity_path().to_string();
        *self.rows.entry(path.clone()).or_default() += chunk.num_rows();
        self.timelines.extend(chunk.timelines().keys().map(TimelineName::to_string));
        if path.starts_with("/__properties") {
            self.properties.extend(chunk.component_descriptors().map(|descriptor| descriptor.component.to_string()));
        }
        let steps = chunk.timelines().get(&TimelineName::from("step")).map(|column| column.times_raw());
        let steps_of = |rows: &[(usize, ArrayRef)]| -> Vec<i64> {
            rows.iter().filter_map(|(row, _)| steps?.get(*row).copied()).collect()
        };
        let poses = cells(chunk, rerun::Transform3D::descriptor_translation().component);
        if let Some((_, last)) = poses.last() {
            self.places.extend(triples(last).last().map(|place| (path.clone(), *place)));
            self.pose_steps.entry(path.clone()).or_default().extend(steps_of(&poses));
        }
        if let Some((_, last)) = cells(chunk, rerun::Points3D::descriptor_positions().component).last() {
            self.points.insert(path.clone(), triples(last));
        }
        if let Some((_, last)) = cells(chunk, rerun::Scalars::descriptor_scalars().component).last() {
            self.values.insert(path.clone(), last.as_primitive::<Float64Type>().value(0));
        }
        let clears = cells(chunk, rerun::Clear::descriptor_is_recursive().component);
        self.cleared.extend(steps_of(&clears).into_iter().map(|step| (path.clone(), step)));
    }
}

/// Rows of a chunk in which `component` has a value, with their values.
fn cells(chunk: &Chunk, component: ComponentIdentifier) -> Vec<(usize, ArrayRef)> {
    let Some(column) = chunk.components().get_array(component) else { return Vec::new() };
    let filled = (0..column.len()).filter(|row| column.is_valid(*row) && !column.value(*row).is_empty());
    filled.map(|row| (row, column.value(row))).collect()
}

/// A cell of points as numbers.
fn triples(cell: &ArrayRef) -> Vec<[f32; 3]> {
    let numbers = cell.as_fixed_size_list().values().as_primitive::<Float32Type>().values();
    numbers.chunks_exact(3).map(|point| [point[0], point[1], point[2]]).collect()
}
