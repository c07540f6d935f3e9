//! Opens all places to which a recording goes.

use rerun::sink::LogSink;

use super::file::PartialFile;
use super::live::{self, LiveHandle};
use super::outlet::{Served, ViewerOutlet};
use super::{RecorderOptions, RecordingError, viewer};

/// The places of a recording, opened.
#[derive(Default)]
pub(super) struct Opened {
    /// What the stream writes to.
    pub(super) sinks: Vec<Box<dyn LogSink>>,
    /// The file, if one was asked for.
    pub(super) file: Option<PartialFile>,
    /// The live viewers and the server.
    pub(super) live: Vec<LiveHandle>,
    /// The server.
    pub(super) served: Option<Served>,
    /// What a reader should know.
    pub(super) warnings: Vec<String>,
}

/// Opens what `options` ask for, the file last: a refused viewer leaves no file behind.
pub(super) fn open(options: &RecorderOptions) -> Result<Opened, RecordingError> {
    let mut opened = Opened::default();
    if let Some(url) = &options.connect {
        opened.add(live::start(ViewerOutlet::connect(url)?).map_err(RecordingError::Thread)?);
    }
    if options.view {
        let shown = viewer::open(viewer::PROGRAM, rerun::DEFAULT_SERVER_PORT)?;
        opened.warnings.extend(shown.warning);
        opened.add(live::start(ViewerOutlet::connect(&shown.url)?).map_err(RecordingError::Thread)?);
    }
    if let Some(port) = options.serve {
        let served = Served::start(port)?;
        opened.add(live::start(served.outlet()).map_err(RecordingError::Thread)?);
        opened.served = Some(served);
    }
    if let Some(path) = &options.file {
        let (file, sink) = PartialFile::create(path)?;
        // the file comes first: nothing that happens to a viewer comes before it
        opened.sinks.insert(0, Box::new(sink));
        opened.file = Some(file);
    }
    Ok(opened)
}

impl Opened {
    fn add(&mut self, (sink, handle): (live::LiveSink, LiveHandle)) {
        self.sinks.push(Box::new(sink));
        self.live.push(handle);
    }
}
