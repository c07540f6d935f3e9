//! Reads a recording back: rows of each entity, timelines, properties, layout.

use std::collections::{BTreeMap, BTreeSet};
use std::io::BufReader;
use std::path::Path;

use rerun::external::{arrow, re_log_encoding};
use rerun::log::{Chunk, LogMsg};
use rerun::{StoreKind, TimelineName};

/// What a file holds.
#[derive(Default)]
pub struct ReadBack {
    /// Rows of each entity, those without time included.
    pub rows: BTreeMap<String, usize>,
    /// Names of all timelines.
    pub timelines: BTreeSet<String>,
    /// Last position of the object.
    pub last_object: Option<[f32; 3]>,
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
        let translation = rerun::Transform3D::descriptor_translation().component;
        if path == "/plane/object"
            && let Some(column) = chunk.components().get_array(translation)
        {
            use arrow::array::{Array as _, AsArray as _};
            let last = column.value(column.len() - 1);
            let values = last.as_fixed_size_list().values().as_primitive::<arrow::datatypes::Float32Type>().clone();
            self.last_object = Some([values.value(0), values.value(1), values.value(2)]);
        }
    }
}
