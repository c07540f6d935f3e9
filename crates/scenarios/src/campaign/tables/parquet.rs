//! Tables as Apache Parquet: types, units and labels are in the file's metadata.

use std::collections::HashMap;
use std::fs::File;
use std::io;
use std::sync::Arc;

use arrow_array::builder::{BooleanBuilder, Float64Builder, Int64Builder, StringBuilder};
use arrow_array::{ArrayRef, RecordBatch};
use arrow_schema::{DataType, Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;

use super::columns::{Cell, Column, Kind};
use super::{Rows, json_lines};
use crate::campaign::{Manifest, Row};
use crate::outcome::Limit;

/// Version of the layout of tables; it grows when a column changes its meaning or goes away.
const TABLE_SCHEMA: &str = "wield.results/1";

pub(super) fn write(manifest: &Manifest, columns: &[Column], rows: Rows<'_>, file: &mut File) -> io::Result<()> {
    let schema = Arc::new(Schema::new(columns.iter().map(field).collect::<Vec<_>>()));
    let metadata = [
        ("wield.schema", TABLE_SCHEMA.to_owned()),
        ("wield.scenario", manifest.base.scenario.clone()),
        ("wield.scenario_text", manifest.base.text.clone()),
        ("wield.version", manifest.base.version.clone()),
        ("wield.columns", json_lines::described(columns)?),
    ];
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(metadata.map(|(key, value)| KeyValue::new(key.to_owned(), value)).to_vec()))
        .build();
    let mut writer = ArrowWriter::try_new(file, Arc::clone(&schema), Some(properties)).map_err(io::Error::other)?;
    loop {
        let rows = rows()?;
        if rows.is_empty() {
            break;
        }
        let arrays = columns.iter().map(|column| array(column, &rows)).collect();
        let batch = RecordBatch::try_new(Arc::clone(&schema), arrays).map_err(io::Error::other)?;
        writer.write(&batch).map_err(io::Error::other)?;
    }
    writer.close().map_err(io::Error::other)?;
    Ok(())
}

fn field(column: &Column) -> Field {
    let kind = match column.kind {
        Kind::Integer => DataType::Int64,
        Kind::Number => DataType::Float64,
        Kind::Truth => DataType::Boolean,
        Kind::Text => DataType::Utf8,
    };
    let limit = column.limit.map_or_else(String::new, |limit| match limit {
        Limit::AtMost(bound) => format!("at most {bound}"),
        Limit::AtLeast(bound) => format!("at least {bound}"),
    });
    let told = [("label", column.label.clone()), ("unit", column.unit.clone()), ("limit", limit)];
    let metadata: HashMap<String, String> =
        told.into_iter().filter(|(_, text)| !text.is_empty()).map(|(key, text)| (key.to_owned(), text)).collect();
    Field::new(&column.name, kind, true).with_metadata(metadata)
}

/// The values of a column; one of another type than the column's is no value.
fn array(column: &Column, rows: &[Row]) -> ArrayRef {
    let cells = rows.iter().map(|row| column.cell(row));
    macro_rules! built {
        ($builder:expr, $kind:ident) => {{
            let mut builder = $builder;
            for cell in cells {
                match cell {
                    Some(Cell::$kind(value)) => builder.append_value(value),
                    _ => builder.append_null(),
                }
            }
            Arc::new(builder.finish())
        }};
    }
    match column.kind {
        Kind::Integer => built!(Int64Builder::new(), Integer),
        Kind::Number => built!(Float64Builder::new(), Number),
        Kind::Truth => built!(BooleanBuilder::new(), Truth),
        Kind::Text => built!(StringBuilder::new(), Text),
    }
}
