//! Recordings of spatial runs: the arm's links and the tool as shapes, the task's bodies as meshes, grains as one entity.

pub(super) mod layout;
mod moving;
mod plots;
mod row;
mod scene;
mod shapes;
mod trail;

use rerun::{RecordingStream, RecordingStreamResult};
use sim::spatial::{BodyDrawing, Event, Observer, Sample, SceneDescription};

use self::moving::Moving;
use self::plots::Plots;
use self::row::Row;
use self::trail::Trail;
use super::curves::Curves;
use super::row::Decimator;
use super::side_by_side::View;
use super::times::Times;
use super::{Recorder, Run};

/// A spatial run that is being recorded.
pub(super) struct SpaceRun {
    row: Row,
    decimator: Decimator,
    times: Times,
    moving: Moving,
    plots: Plots,
    trail: Trail,
    /// Whether the next sample becomes a row in any case: bodies were drawn that have no pose yet.
    bodies_are_new: bool,
}

impl SpaceRun {
    fn new(scene: &SceneDescription, rate_hz: f64, rows: usize) -> Self {
        Self {
            row: Row::new(scene),
            decimator: Decimator::new(rate_hz, scene.control_period_s),
            times: Times::with_capacity(rows),
            moving: Moving::new(scene, rows),
            plots: Plots::new(scene, rows),
            trail: Trail::new("/world/tool_path", rows),
            bodies_are_new: false,
        }
    }

    /// The curves.
    pub(super) fn curves(&self) -> &Curves {
        self.plots.curves()
    }

    /// Number of rows that wait.
    pub(super) fn len(&self) -> usize {
        self.times.len()
    }

    fn push(&mut self) {
        self.times.push(self.row.step, self.row.time_s);
        self.moving.push(&self.row);
        self.plots.push(&self.row);
        self.trail.push(self.row.step, self.row.time_s, self.row.world_from_tool.translation.vector.into());
        self.row.written();
    }

    /// Takes up a sample that was copied but is no row yet.
    fn push_waiting(&mut self) {
        if self.row.waits {
            self.push();
        }
    }

    /// Hands all rows to the stream and keeps their room.
    pub(super) fn hand_over(&mut self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        if self.times.len() == 0 {
            return Ok(());
        }
        self.moving.send(stream, &self.times)?;
        self.plots.send(stream, &self.times)?;
        self.trail.hand_over(stream)?;
        self.times.clear();
        self.moving.clear();
        self.plots.clear();
        Ok(())
    }

    /// Takes up the last sample, which seldom falls on a row, and sends what is known only at the end.
    pub(super) fn send_last(&mut self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        self.push_waiting();
        self.plots.send_limits(stream, self.row.step, self.row.time_s)
    }
}

impl Observer for Recorder {
    fn begin(&mut self, scene: &SceneDescription) {
        self.events.control_period_s = scene.control_period_s;
        let run = SpaceRun::new(scene, self.rate_hz, self.block_rows);
        let drawn = scene::send(&self.stream, scene);
        let named = run.plots.send_static(&self.stream);
        let laid_out = super::layout::send(&self.stream, |layout| layout::write(layout, scene));
        self.view = Some(View::Space(scene.focus_world));
        self.run = Some(Run::Space(Box::new(run)));
        self.note("draw the scene", drawn);
        self.note("name the series", named);
        self.note("send the layout", laid_out);
        if !scene.bodies.is_empty() {
            Observer::bodies(self, 0.0, &scene.bodies);
        }
    }

    fn sample(&mut self, sample: &Sample<'_>) {
        let Some(Run::Space(run)) = &mut self.run else { return };
        run.row.copy(sample);
        if run.decimator.wants(sample.step) || run.bodies_are_new {
            run.bodies_are_new = false;
            run.push();
            if run.len() >= self.block_rows {
                self.hand_over();
            }
        }
    }

    fn bodies(&mut self, time_s: f64, bodies: &[BodyDrawing]) {
        // rows of bodies that vanish go first, the last sample that shows them too
        if let Some(Run::Space(run)) = &mut self.run {
            run.push_waiting();
        }
        self.hand_over();
        let Some(Run::Space(run)) = &mut self.run else { return };
        let steps = (time_s / self.events.control_period_s).round();
        // a cast saturates: a change without a period or time stands at the start
        let step = if steps.is_finite() { steps as i64 } else { 0 };
        run.bodies_are_new = true;
        let sent = run.moving.change_bodies(&self.stream, step, time_s, bodies);
        self.note("draw bodies", sent);
    }

    fn event(&mut self, event: &Event) {
        self.events.push(event);
    }
}
