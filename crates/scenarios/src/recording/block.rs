//! Rows that wait to be handed over together.

use rerun::{RecordingStream, RecordingStreamResult};
use sim::planar::SceneDescription;

use super::curves::Curves;
use super::moving::Moving;
use super::plots::Plots;
use super::row::Row;
use super::times::Times;
use super::trail::Trail;

/// Rows of everything that changes with time.
pub(super) struct Block {
    times: Times,
    moving: Moving,
    plots: Plots,
    trails: [Trail; 2],
}

impl Block {
    /// Room for `rows` rows of `scene`.
    pub(super) fn new(scene: &SceneDescription, rows: usize) -> Self {
        Self {
            times: Times::with_capacity(rows),
            moving: Moving::new(scene, rows),
            plots: Plots::new(scene, rows),
            trails: [Trail::new("/plane/object_path", rows), Trail::new("/plane/tool_path", rows)],
        }
    }

    /// Sends names and colors of all series.
    pub(super) fn send_static(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        self.plots.send_static(stream)
    }

    /// The curves.
    pub(super) fn curves(&self) -> &Curves {
        self.plots.curves()
    }

    /// Number of rows that wait.
    pub(super) fn len(&self) -> usize {
        self.times.len()
    }

    /// Adds a row.
    pub(super) fn push(&mut self, row: &mut Row) {
        self.times.push(row.step, row.time_s);
        self.moving.push(row);
        self.plots.push(row);
        for (trail, pose) in self.trails.iter_mut().zip([&row.world_from_object, &row.world_from_tool]) {
            trail.push(row.step, row.time_s, pose.translation.vector.into());
        }
        row.written();
    }

    /// Hands all rows to the stream and keeps their room.
    pub(super) fn hand_over(&mut self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        if self.times.len() == 0 {
            return Ok(());
        }
        self.moving.send(stream, &self.times)?;
        self.plots.send(stream, &self.times)?;
        for trail in &mut self.trails {
            trail.hand_over(stream)?;
        }
        self.times.clear();
        self.moving.clear();
        self.plots.clear();
        Ok(())
    }

    /// Sends what is known only at the end.
    pub(super) fn send_last(&self, stream: &RecordingStream, last: &Row) -> RecordingStreamResult<()> {
        self.plots.send_limits(stream, last)
    }
}
