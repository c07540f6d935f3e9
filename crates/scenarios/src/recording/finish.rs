//! The end of a recording: outcome, flush, bounded farewell to viewers, final name.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::{Recorder, summary};
use crate::outcome::Outcome;

/// Time that viewers get to take what waits for them.
const FAREWELL: Duration = Duration::from_millis(1500);

/// Time that the disk gets to take what waits for it.
pub(super) const FLUSH: Duration = Duration::from_secs(60);

/// What became of a recording.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordingSummary {
    /// The file; under its temporary name if it is not complete.
    pub file: Option<PathBuf>,
    /// Size of the file, bytes.
    pub bytes: Option<u64>,
    /// Messages that no viewer got, because none was there or it was too slow.
    pub dropped_live_messages: u64,
    /// What a reader should know, one sentence each.
    pub warnings: Vec<String>,
}

impl Recorder {
    /// Writes the outcome, ends all streams in bounded time and gives the file its name.
    #[must_use]
    pub fn finish(mut self, outcome: &Outcome) -> RecordingSummary {
        self.send_last_rows();
        let sent = summary::send_outcome(&self.stream, outcome);
        self.note("send the outcome", sent);
        self.close()
    }

    /// Ends the recording of a run that broke off and has no outcome; the rows up to its end tell why.
    #[must_use]
    pub fn abandon(mut self, reason: &str) -> RecordingSummary {
        self.send_last_rows();
        let sent = summary::send_failure(&self.stream, reason);
        self.note("send the reason", sent);
        self.close()
    }

    fn close(mut self) -> RecordingSummary {
        let flushed = self.stream.flush_with_timeout(FLUSH).map_err(|error| error.to_string());
        let dropped_live_messages = self.end_live();
        // dropping the sinks writes the file's footer
        self.stream.disconnect();
        let mut summary = RecordingSummary { dropped_live_messages, warnings: self.warnings, ..Default::default() };
        match (self.file, flushed) {
            (Some(file), flushed) => {
                let (path, bytes, warning) = file.finish(flushed);
                summary.file = Some(path);
                summary.bytes = bytes;
                summary.warnings.extend(warning);
            }
            (None, Err(reason)) => summary.warnings.push(format!("recording: {reason}")),
            (None, Ok(())) => {}
        }
        summary
    }

    /// Sends what waits and the last sample, which seldom falls on a row.
    fn send_last_rows(&mut self) {
        if let Some(run) = &mut self.run {
            let last = run.send_last(&self.stream);
            self.note("send the last row", last);
        }
        self.hand_over();
    }

    fn end_live(&mut self) -> u64 {
        let deadline = Instant::now() + FAREWELL;
        let ends: Vec<_> = self.live.iter().map(|live| live.end(deadline)).collect();
        if ends.iter().any(|ended| !ended.delivered) {
            self.warnings
                .push("recording: a live viewer was absent, slow or went away; it did not see the whole run".into());
        }
        ends.iter().map(|ended| ended.dropped).sum()
    }
}
