//! The table: time, the action of the plan, then numbers; what is no number at an instant is null there.

use std::collections::HashMap;
use std::io::{self, Write};
use std::sync::Arc;

use arrow_array::builder::{Float64Builder, StringBuilder};
use arrow_array::{ArrayRef, RecordBatch};
use arrow_schema::{DataType, Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;

/// Rows that are kept until they are written: some seconds of a run.
const BLOCK: usize = 8192;
/// Column with the name of the plan's action.
const PHASE: &str = "phase";

/// A column of numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    name: String,
    unit: &'static str,
    label: String,
}

impl Column {
    /// A column `name`, which ends in its unit.
    pub(super) fn new(name: impl Into<String>, unit: &'static str, label: impl Into<String>) -> Self {
        Self { name: name.into(), unit, label: label.into() }
    }
}

/// Columns of every joint: position, velocity, reference and torque, in the order of [`fill_joints`].
pub(super) fn joint_columns(joints: &[String]) -> impl Iterator<Item = Column> + '_ {
    let quantities = [
        ("position_rad", "rad", "position"),
        ("velocity_rad_per_s", "rad/s", "velocity"),
        ("reference_rad", "rad", "desired position"),
        ("torque_nm", "N m", "torque of the motor"),
    ];
    quantities.into_iter().flat_map(move |(end, unit, label)| {
        joints.iter().map(move |joint| Column::new(format!("{joint}_{end}"), unit, format!("{joint}: {label}")))
    })
}

/// Values of every joint: positions, velocities, references, torques.
pub(super) fn fill_joints(row: &mut Vec<f64>, values: [&[f64]; 4]) {
    values.iter().for_each(|values| row.extend_from_slice(values));
}

/// A file that is being written.
pub(super) struct Table<W: Write + Send> {
    writer: ArrowWriter<W>,
    schema: Arc<Schema>,
    phases: Vec<String>,
    phase: StringBuilder,
    numbers: Vec<Float64Builder>,
}

impl<W: Write + Send> Table<W> {
    /// Begins a table with these columns; `phases` are the names of the plan's actions.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(super) fn new(
        to: W,
        columns: &[Column],
        phases: &[String],
        about: &[(&'static str, String)],
    ) -> io::Result<Self> {
        let phase = Field::new(PHASE, DataType::Utf8, true).with_metadata(told("", "action of the plan"));
        let numbers = columns.iter().map(|column| {
            let field = Field::new(&column.name, DataType::Float64, true);
            field.with_metadata(told(column.unit, &column.label))
        });
        let schema = Arc::new(Schema::new([phase].into_iter().chain(numbers).collect::<Vec<_>>()));
        let about = about.iter().map(|(key, value)| KeyValue::new((*key).to_owned(), value.clone()));
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(about.collect()))
            .build();
        let writer = ArrowWriter::try_new(to, Arc::clone(&schema), Some(properties)).map_err(io::Error::other)?;
        let numbers = columns.iter().map(|_| Float64Builder::with_capacity(BLOCK)).collect();
        Ok(Self { writer, schema, phases: phases.to_vec(), phase: StringBuilder::new(), numbers })
    }

    /// Adds a row: a value for each column, NaN for none.
    ///
    /// # Errors
    /// If a block of rows cannot be written.
    pub(super) fn push(&mut self, phase: usize, values: &[f64]) -> io::Result<()> {
        self.phase.append_option(self.phases.get(phase));
        for (place, column) in self.numbers.iter_mut().enumerate() {
            column.append_option(values.get(place).copied().filter(|value| value.is_finite()));
        }
        if self.numbers.first().is_some_and(|column| arrow_array::builder::ArrayBuilder::len(column) >= BLOCK) {
            return self.write_block();
        }
        Ok(())
    }

    fn write_block(&mut self) -> io::Result<()> {
        let phase: ArrayRef = Arc::new(self.phase.finish());
        let numbers = self.numbers.iter_mut().map(|column| Arc::new(column.finish()) as ArrayRef);
        let arrays = [phase].into_iter().chain(numbers).collect();
        let batch = RecordBatch::try_new(Arc::clone(&self.schema), arrays).map_err(io::Error::other)?;
        self.writer.write(&batch).map_err(io::Error::other)
    }

    /// Writes what is left, and the end of the file.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.write_block()?;
        self.writer.close().map_err(io::Error::other)?;
        Ok(())
    }
}

fn told(unit: &str, label: &str) -> HashMap<String, String> {
    let pairs = [("unit", unit), ("label", label)];
    pairs
        .into_iter()
        .filter(|(_, text)| !text.is_empty())
        .map(|(key, text)| (key.to_owned(), text.to_owned()))
        .collect()
}

#[cfg(test)]
mod tests {
    use arrow_array::Array;
    use arrow_array::cast::AsArray;
    use arrow_array::types::Float64Type;
    use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;

    use super::*;

    #[test]
    fn rows_over_several_blocks_are_read_back_with_their_units() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let columns = [Column::new("time_s", "s", "simulated time"), Column::new("seen_m", "m", "seen")];
        let (phases, about) = (["push".to_owned(), "hold".to_owned()], [("wield.seed", "7".to_owned())]);
        let mut table = Table::new(file.reopen().unwrap(), &columns, &phases, &about).unwrap();
        let count = 2 * BLOCK + 3;
        for row in 0..count {
            let seen = if row % 2 == 0 { f64::NAN } else { row as f64 };
            table.push(usize::from(row >= BLOCK), &[0.001 * row as f64, seen]).unwrap();
        }
        table.finish().unwrap();

        let reader = ParquetRecordBatchReaderBuilder::try_new(file.reopen().unwrap()).unwrap();
        let schema = Arc::clone(reader.schema());
        assert_eq!(schema.field(2).metadata().get("unit").map(String::as_str), Some("m"));
        let batches: Vec<RecordBatch> = reader.with_batch_size(count).build().unwrap().map(Result::unwrap).collect();
        assert_eq!(batches.iter().map(RecordBatch::num_rows).sum::<usize>(), count);
        let first = batches.first().unwrap();
        assert_eq!(first.column(0).as_string::<i32>().value(0), "push");
        assert_eq!(first.column(1).as_primitive::<Float64Type>().value(2), 0.002);
        assert!(first.column(2).is_null(0) && first.column(2).is_valid(1));
        let last = batches.last().unwrap();
        assert_eq!(last.column(0).as_string::<i32>().value(last.num_rows() - 1), "hold");
    }
}
