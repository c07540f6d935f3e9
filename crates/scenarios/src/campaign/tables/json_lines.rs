//! Tables as lines of JSON: one flat object for each run; what does not exist is `null`.

use std::fs::File;
use std::io::{self, BufWriter, Write};

use serde_json::{Map, Value, json};

use super::Rows;
use super::columns::{Cell, Column};

pub(super) fn write(columns: &[Column], rows: Rows<'_>, file: &mut File) -> io::Result<()> {
    let mut file = BufWriter::new(file);
    loop {
        let rows = rows()?;
        if rows.is_empty() {
            return file.flush();
        }
        for row in &rows {
            let object: Map<String, Value> =
                columns.iter().map(|column| (column.name.clone(), value(column.cell(row)))).collect();
            serde_json::to_writer(&mut file, &object)?;
            file.write_all(b"\n")?;
        }
    }
}

fn value(cell: Option<Cell>) -> Value {
    match cell {
        None => Value::Null,
        Some(Cell::Integer(number)) => number.into(),
        Some(Cell::Number(number)) => number.into(),
        Some(Cell::Truth(truth)) => truth.into(),
        Some(Cell::Text(text)) => text.into(),
    }
}

/// Label, unit and limit of each column, as JSON.
pub(super) fn described(columns: &[Column]) -> io::Result<String> {
    let told = |column: &Column| json!({ "name": column.name, "label": column.label, "unit": column.unit, "limit": column.limit });
    Ok(serde_json::to_string(&columns.iter().map(told).collect::<Vec<_>>())?)
}
