//! Opens the recording stream: names, identity, timelines.

use rerun::sink::LogSink;
use rerun::{RecordingStream, RecordingStreamBuilder, RecordingStreamResult};

use super::APPLICATION;

/// Opens a stream into `sinks`; the same scenario and seed give the same identity.
pub(super) fn open(sinks: Vec<Box<dyn LogSink>>, scenario: &str, seed: u64) -> RecordingStreamResult<RecordingStream> {
    let stream = RecordingStreamBuilder::new(APPLICATION)
        .recording_id(format!("{scenario}-seed-{seed}"))
        // an environment variable of the library must not silence a recording that was asked for
        .enabled(true)
        .set_sinks(sinks)?;
    // a recording holds simulated time only: the same run gives the same rows
    stream.set_log_time_enabled(false);
    stream.set_log_tick_enabled(false);
    stream.send_recording_name(format!("{scenario}, seed {seed}"))?;
    Ok(stream)
}
