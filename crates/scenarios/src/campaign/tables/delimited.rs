//! Tables as comma-separated values: a line of names, then a line for each run; what does not exist is empty.

use std::fs::File;
use std::io;

use super::Rows;
use super::columns::{Cell, Column};

pub(super) fn write(columns: &[Column], rows: Rows<'_>, file: &mut File) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    writer.write_record(columns.iter().map(|column| &column.name))?;
    loop {
        let rows = rows()?;
        if rows.is_empty() {
            return writer.flush();
        }
        for row in &rows {
            writer.write_record(columns.iter().map(|column| text(column.cell(row))))?;
        }
    }
}

/// Numbers in the fewest digits that read back as the same number.
fn text(cell: Option<Cell>) -> String {
    match cell {
        None => String::new(),
        Some(Cell::Integer(number)) => number.to_string(),
        Some(Cell::Number(number)) => number.to_string(),
        Some(Cell::Truth(truth)) => truth.to_string(),
        Some(Cell::Text(text)) => text,
    }
}
