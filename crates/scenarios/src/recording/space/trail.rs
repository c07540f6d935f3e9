//! The growing trail of the tool: one short line per stretch of its way, shown from the start to the time cursor.

use nalgebra::Point3;
use rerun::{LineStrips3D, RecordingStream, RecordingStreamResult};

use super::shapes::plain;
use crate::recording::times::Times;

/// A stretch begins where the last one ended and is at least this long, m.
const STRETCH_M: f64 = 0.001;

/// Stretches that wait to be handed over.
pub(super) struct Trail {
    path: &'static str,
    times: Times,
    stretches: Vec<[[f32; 3]; 2]>,
    end: Option<Point3<f64>>,
}

impl Trail {
    /// An empty trail.
    pub(super) fn new(path: &'static str, rows: usize) -> Self {
        Self { path, times: Times::with_capacity(rows), stretches: Vec::with_capacity(rows), end: None }
    }

    /// Goes on to `point` if it is far enough from the end of the last stretch.
    pub(super) fn push(&mut self, step: u64, time_s: f64, point: Point3<f64>) {
        let start = *self.end.get_or_insert(point);
        if (point - start).norm() < STRETCH_M {
            return;
        }
        self.times.push(step, time_s);
        self.stretches.push([plain(&start), plain(&point)]);
        self.end = Some(point);
    }

    /// Hands all stretches to the stream and keeps their room.
    pub(super) fn hand_over(&mut self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        if self.stretches.is_empty() {
            return Ok(());
        }
        let strips = LineStrips3D::update_fields().with_strips(self.stretches.iter().copied());
        stream.send_columns(self.path, self.times.columns(), strips.columns_of_unit_batches()?)?;
        self.times.clear();
        self.stretches.clear();
        Ok(())
    }
}
