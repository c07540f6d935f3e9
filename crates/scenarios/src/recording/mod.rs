//! The Rerun recorder: a run as a file that opens ready to read, and as a live picture.
//!
//! A [`Recorder`] listens to a run as its observer. It copies what it is told into buffers, thins it out to the scenario's
//! recording rate and hands it over in blocks, so that a run does not wait for it. The file holds every row; a live viewer
//! sits behind a queue of bounded size, so that an absent, slow or dying viewer costs the run nothing but its picture.

mod block;
mod curves;
mod error;
mod events;
mod file;
mod finish;
mod layout;
mod live;
mod moving;
mod outlet;
mod plane_layout;
mod plots;
mod row;
mod scene;
mod shapes;
mod side_by_side;
mod sinks;
mod space;
mod store;
mod style;
mod summary;
mod times;
mod trail;
mod viewer;

use std::path::PathBuf;

use rerun::{RecordingStream, RecordingStreamResult};
use sim::planar::{Event, Observer, Sample, SceneDescription};

pub use error::RecordingError;
pub use finish::RecordingSummary;
pub use outlet::Served;
pub use side_by_side::SideBySide;

use self::block::Block;
use self::curves::Curves;
use self::events::Events;
use self::file::PartialFile;
use self::live::LiveHandle;
use self::row::{Decimator, Row};
use self::side_by_side::View;
use self::sinks::Opened;
use self::space::SpaceRun;
use crate::scenario::ResolvedScenario;

/// Name under which a viewer groups recordings and remembers layouts.
const APPLICATION: &str = "wield";

/// Rows handed over at once to a file: large blocks make small files.
const FILE_BLOCK_ROWS: usize = 1000;

/// Rows handed over at once when somebody watches.
const LIVE_BLOCK_ROWS: usize = 250;

/// Where a recording goes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecorderOptions {
    /// File to write, usually `*.rrd`.
    pub file: Option<PathBuf>,
    /// Address of a running viewer: `rerun+http://127.0.0.1:9876/proxy`.
    pub connect: Option<String>,
    /// Port of this machine at which viewers may ask for the recording.
    pub serve: Option<u16>,
    /// Whether to start an installed viewer and to show the run in it.
    pub view: bool,
}

/// Writes and streams one run.
pub struct Recorder {
    stream: RecordingStream,
    file: Option<PartialFile>,
    live: Vec<LiveHandle>,
    served: Option<Served>,
    rate_hz: f64,
    tolerance_m: f64,
    block_rows: usize,
    run: Option<Run>,
    view: Option<View>,
    events: Events,
    warnings: Vec<String>,
}

/// What is known once the scene was told.
enum Run {
    /// A scene seen from above.
    Plane(Box<PlaneRun>),
    /// A scene in space.
    Space(Box<SpaceRun>),
}

/// A planar run that is being recorded.
struct PlaneRun {
    row: Row,
    decimator: Decimator,
    block: Block,
}

impl Run {
    fn curves(&self) -> &Curves {
        match self {
            Self::Plane(run) => run.block.curves(),
            Self::Space(run) => run.curves(),
        }
    }

    fn hand_over(&mut self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        match self {
            Self::Plane(run) => run.block.hand_over(stream),
            Self::Space(run) => run.hand_over(stream),
        }
    }

    /// Sends the last sample, which seldom falls on a row, and what is known only at the end.
    fn send_last(&mut self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        match self {
            Self::Plane(run) => {
                if run.row.waits {
                    run.block.push(&mut run.row);
                }
                run.block.send_last(stream, &run.row)
            }
            Self::Space(run) => run.send_last(stream),
        }
    }
}

impl Recorder {
    /// Opens file, viewer and server, and sends what is known before the run: names, task, properties.
    ///
    /// # Errors
    /// A [`RecordingError`] if the file cannot be written, the address is no viewer's address, the port is taken or no
    /// viewer is installed. A viewer that does not answer is no error.
    pub fn start(options: &RecorderOptions, scenario: &ResolvedScenario, seed: u64) -> Result<Self, RecordingError> {
        Self::over(sinks::open(options)?, &scenario.name, scenario, seed)
    }

    /// Records to what was opened; `name` with the seed is the recording's identity.
    fn over(opened: Opened, name: &str, scenario: &ResolvedScenario, seed: u64) -> Result<Self, RecordingError> {
        let stream = store::open(opened.sinks, name, seed)?;
        let mut recorder = Self {
            stream,
            file: opened.file,
            block_rows: if opened.live.is_empty() { FILE_BLOCK_ROWS } else { LIVE_BLOCK_ROWS },
            live: opened.live,
            served: opened.served,
            rate_hz: scenario.recording().rate_hz,
            tolerance_m: scenario.goal_tolerance_m().unwrap_or(0.0),
            run: None,
            view: None,
            events: Events::default(),
            warnings: opened.warnings,
        };
        let sent = summary::send_task(&recorder.stream, scenario, seed);
        recorder.note("send the task", sent);
        Ok(recorder)
    }

    /// The server of `--serve`; while it is held, viewers may come, also after the run.
    #[must_use]
    pub fn served(&self) -> Option<Served> {
        self.served.clone()
    }

    /// Keeps the first word about each kind of trouble: an observer cannot fail.
    fn note(&mut self, what: &str, result: Result<(), impl std::fmt::Display>) {
        if let Err(error) = result {
            let warning = format!("recording: {what}: {error}");
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
    }

    /// Hands over all rows that wait.
    fn hand_over(&mut self) {
        let Some(run) = &mut self.run else { return };
        let sent = run.hand_over(&self.stream);
        let told = self.events.hand_over(&self.stream);
        self.note("send a block of rows", sent);
        self.note("send events", told);
    }
}

impl Observer for Recorder {
    fn begin(&mut self, scene: &SceneDescription) {
        self.events.control_period_s = scene.control_period_s;
        let run = PlaneRun {
            row: Row::new(scene),
            decimator: Decimator::new(self.rate_hz, scene.control_period_s),
            block: Block::new(scene, self.block_rows),
        };
        let drawn = scene::send(&self.stream, scene, self.tolerance_m);
        let named = run.block.send_static(&self.stream);
        let laid_out = layout::send(&self.stream, |layout| plane_layout::write(layout, scene));
        self.view = Some(View::Plane(scene.world.map.clone()));
        self.run = Some(Run::Plane(Box::new(run)));
        self.note("draw the scene", drawn);
        self.note("name the series", named);
        self.note("send the layout", laid_out);
    }

    fn sample(&mut self, sample: &Sample<'_>) {
        let Some(Run::Plane(run)) = &mut self.run else { return };
        run.row.copy(sample);
        if run.decimator.wants(sample.step) {
            run.block.push(&mut run.row);
            if run.block.len() >= self.block_rows {
                self.hand_over();
            }
        }
    }

    fn event(&mut self, event: &Event) {
        self.events.push(event);
    }
}
