//! The log of a run: one line per event, with its level.

use rerun::{RecordingStream, RecordingStreamResult, TextLog, TextLogLevel};
use sim::planar::{Event, EventLevel};

use super::times::Times;

/// Where the log lies.
pub(super) const PATH: &str = "/events";

/// Events that wait to be handed over.
#[derive(Default)]
pub(super) struct Events {
    /// Time between two control steps, s; zero as long as it is not known.
    pub(super) control_period_s: f64,
    times: Times,
    texts: Vec<String>,
    levels: Vec<&'static str>,
}

impl Events {
    /// Adds an event.
    pub(super) fn push(&mut self, event: &Event) {
        let steps = (event.time_s / self.control_period_s).round();
        // a cast saturates: an event without a period or time stands at the start
        self.times.push(if steps.is_finite() { steps as u64 } else { 0 }, event.time_s);
        self.texts.push(event.text.clone());
        self.levels.push(level(event.level));
    }

    /// Hands all events to the stream.
    pub(super) fn hand_over(&mut self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        if self.texts.is_empty() {
            return Ok(());
        }
        let texts = std::mem::take(&mut self.texts);
        let lines = TextLog::update_fields().with_many_text(texts).with_many_level(self.levels.drain(..));
        let sent = stream.send_columns(PATH, self.times.columns(), lines.columns_of_unit_batches()?);
        self.times.clear();
        sent
    }
}

fn level(level: EventLevel) -> &'static str {
    match level {
        EventLevel::Info => TextLogLevel::INFO,
        EventLevel::Warning => TextLogLevel::WARN,
        EventLevel::Error => TextLogLevel::ERROR,
    }
}
