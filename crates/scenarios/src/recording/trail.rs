//! A growing trail: one short line per stretch of the way, shown from the start to the time cursor.

use nalgebra::Point2;
use rerun::{LineStrips2D, RecordingStream, RecordingStreamResult};

use super::shapes::plain;
use super::times::Times;

/// A stretch begins where the last one ended and is at least this long, m.
const STRETCH_M: f64 = 0.000_5;

/// Stretches that wait to be handed over.
pub(super) struct Trail {
    path: &'static str,
    times: Times,
    stretches: Vec<[[f32; 2]; 2]>,
    end: Option<Point2<f64>>,
}

impl Trail {
    /// An empty trail.
    pub(super) fn new(path: &'static str, rows: usize) -> Self {
        Self { path, times: Times::with_capacity(rows), stretches: Vec::with_capacity(rows), end: None }
    }

    /// Goes on to `point` if it is far enough from the end of the last stretch.
    pub(super) fn push(&mut self, step: u64, time_s: f64, point: Point2<f64>) {
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
        let strips = LineStrips2D::update_fields().with_strips(self.stretches.iter().copied());
        stream.send_columns(self.path, self.times.columns(), strips.columns_of_unit_batches()?)?;
        self.times.clear();
        self.stretches.clear();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trail_has_no_gaps_and_no_crumbs() {
        let mut trail = Trail::new("/plane/test", 8);
        for step in 0..=100_u32 {
            trail.push(u64::from(step), 0.0, Point2::new(f64::from(step) * 0.000_1, 0.0));
        }
        // 10 mm in stretches of half a millimeter, give or take a rounding of the decimal steps
        assert!((16..=20).contains(&trail.stretches.len()), "{}", trail.stretches.len());
        let joined = trail.stretches.windows(2).all(|pair| pair[0][1] == pair[1][0]);
        assert!(joined);
    }
}
