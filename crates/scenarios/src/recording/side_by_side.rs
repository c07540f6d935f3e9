//! Several runs in one recording: each below an entity of its own, side by side on the same timelines.
//!
//! A run is recorded as ever; what its stream sends is moved below the run's entity and waits until all runs are done: the
//! layout comes first in the file, or a viewer would show another while it loads, and it is known last. Names and layouts of
//! the single runs stay behind.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use nalgebra::Point3;
use rerun::blueprint::components::ContainerKind;
use rerun::external::re_log_types::ArrowMsg;
use rerun::log::{Chunk, LogMsg};
use rerun::sink::{FileSink, LogSink, SinkFlushError};
use rerun::{EntityPath, RecordingStream, RecordingStreamResult, SeriesLines, StoreKind};
use sim::planar::MapBounds;

use super::file::PartialFile;
use super::finish::FLUSH;
use super::layout::{Layout, Node};
use super::sinks::Opened;
use super::{Recorder, RecordingError, RecordingSummary, layout, plane_layout, space, store, style, summary};
use crate::outcome::Outcome;
use crate::scenario::ResolvedScenario;

/// This many plots of curves are seen at once, the others behind them.
const PLOTS: usize = 6;

/// How a scene is looked at.
pub(super) enum View {
    /// From above.
    Plane(MapBounds),
    /// In space: middle and radius of what is worth seeing, m.
    Space((Point3<f64>, f64)),
}

/// A run that was recorded.
struct Shown {
    name: String,
    below: String,
    view: Option<View>,
    /// Path and name of each of its curves.
    curves: Vec<(String, String)>,
}

/// Several runs in one recording.
pub struct SideBySide {
    file: PartialFile,
    common: Arc<Common>,
    stream: RecordingStream,
    name: String,
    seed: u64,
    shown: Vec<Shown>,
    warnings: Vec<String>,
}

impl SideBySide {
    /// Opens the file; `name` and `seed` are what the runs have in common.
    ///
    /// # Errors
    /// A [`RecordingError`] if the file cannot be written.
    pub fn start(file: &Path, name: &str, seed: u64) -> Result<Self, RecordingError> {
        let (file, sink) = PartialFile::create(file)?;
        let common = Arc::new(Common { file: sink, waiting: Mutex::default(), lost: AtomicU64::new(0) });
        let stream = store::open(vec![Box::new(Whole(Arc::clone(&common)))], name, seed)?;
        Ok(Self { file, common, stream, name: name.to_owned(), seed, shown: Vec::new(), warnings: Vec::new() })
    }

    /// A recorder of the next run.
    ///
    /// # Errors
    /// A [`RecordingError`] if the library refuses to begin.
    pub fn recorder(&self, run: &str, scenario: &ResolvedScenario) -> Result<Recorder, RecordingError> {
        let below = Below { common: Arc::clone(&self.common), entity: self.entity(run) };
        let opened = Opened { sinks: vec![Box::new(below)], ..Opened::default() };
        Recorder::over(opened, &self.name, scenario, self.seed)
    }

    /// Ends the recording of that run; the error says why it came to no outcome.
    pub fn ended(&mut self, run: &str, recorder: Recorder, result: Result<&Outcome, &str>) {
        let mut recorder = recorder;
        let view = recorder.view.take();
        let told = recorder.run.iter().flat_map(|run| run.curves().told());
        let curves = told.map(|(path, name)| (path.to_owned(), name.to_owned())).collect();
        self.shown.push(Shown { name: run.to_owned(), below: self.entity(run), view, curves });
        let summary = match result {
            Ok(outcome) => recorder.finish(outcome),
            Err(reason) => recorder.abandon(reason),
        };
        self.warnings.extend(summary.warnings.into_iter().map(|warning| format!("{run}: {warning}")));
    }

    /// The entity of the run that comes next; no two runs have the same.
    fn entity(&self, run: &str) -> String {
        let plain = |letter: char| if letter.is_alphanumeric() || "_-".contains(letter) { letter } else { '_' };
        let entity = format!("/{}", run.chars().map(plain).collect::<String>());
        if self.shown.iter().any(|other| other.below == entity) {
            return format!("{entity}_{}", self.shown.len() + 1);
        }
        entity
    }

    /// Lays the runs out, writes the file's end and gives it its name.
    #[must_use]
    pub fn finish(self) -> RecordingSummary {
        let Self { file, common, stream, shown, mut warnings, .. } = self;
        let laid_out = layout::send(&stream, |layout| write(layout, &shown));
        common.let_go();
        let named = name_curves(&stream, &shown);
        for (what, result) in [("name the curves", named), ("send the layout", laid_out)] {
            warnings.extend(result.err().map(|error| format!("recording: {what}: {error}")));
        }
        let flushed = stream.flush_with_timeout(FLUSH).map_err(|error| error.to_string());
        stream.disconnect();
        let lost = common.lost.load(Ordering::Relaxed);
        if lost > 0 {
            warnings.push(format!("recording: {lost} blocks could not be moved to their run and are missing"));
        }
        // dropping the last sink writes the file's footer
        drop((stream, common));
        let (path, bytes, warning) = file.finish(flushed);
        warnings.extend(warning);
        RecordingSummary { file: Some(path), bytes, warnings, ..RecordingSummary::default() }
    }
}

/// The file that all streams write to.
struct Common {
    file: FileSink,
    /// Rows of the runs that wait for the layout.
    waiting: Mutex<Vec<LogMsg>>,
    /// Blocks that could not be moved.
    lost: AtomicU64,
}

impl Common {
    fn waiting(&self) -> MutexGuard<'_, Vec<LogMsg>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes what waits.
    fn let_go(&self) {
        self.waiting().drain(..).for_each(|message| self.file.send(message));
    }
}

/// The common stream's side: everything goes where it says.
struct Whole(Arc<Common>);

impl LogSink for Whole {
    fn send(&self, message: LogMsg) {
        self.0.file.send(message);
    }

    fn flush_blocking(&self, timeout: Duration) -> Result<(), SinkFlushError> {
        LogSink::flush_blocking(&self.0.file, timeout)
    }
}

/// One run's side: its rows go below its entity.
struct Below {
    common: Arc<Common>,
    entity: String,
}

impl LogSink for Below {
    fn send(&self, message: LogMsg) {
        // identity and layout are the common stream's
        let LogMsg::ArrowMsg(store, rows) = message else { return };
        if store.kind() == StoreKind::Blueprint {
            return;
        }
        match moved(&rows, &self.entity) {
            Ok(Some(rows)) => self.common.waiting().push(LogMsg::ArrowMsg(store, rows)),
            Ok(None) => {}
            Err(()) => {
                self.common.lost.fetch_add(1, Ordering::Relaxed);
            }
        }
    }

    fn flush_blocking(&self, timeout: Duration) -> Result<(), SinkFlushError> {
        LogSink::flush_blocking(&self.common.file, timeout)
    }
}

/// The same rows below `entity`; none if they are properties of the recording, which has its own.
fn moved(rows: &ArrowMsg, entity: &str) -> Result<Option<ArrowMsg>, ()> {
    let chunk = Chunk::from_arrow_msg(rows).map_err(|_| ())?;
    if chunk.entity_path().starts_with(&EntityPath::properties()) {
        return Ok(None);
    }
    let path = EntityPath::from(entity).join(chunk.entity_path());
    let (rows, times, components) = (chunk.row_ids_array(), chunk.timelines(), chunk.components());
    let moved = Chunk::new(chunk.id(), path, None, rows.clone(), times.clone(), components.clone());
    moved.and_then(|chunk| chunk.to_arrow_msg()).map(Some).map_err(|_| ())
}

/// Gives each run a color of its own in the plots that all share, and its name in their legends.
fn name_curves(stream: &RecordingStream, shown: &[Shown]) -> RecordingStreamResult<()> {
    for (run, color) in shown.iter().zip(style::JOINTS.iter().cycle()) {
        for (path, _) in shared(run) {
            let line = SeriesLines::new().with_names([run.name.as_str()]).with_colors([*color]).with_widths([1.5]);
            stream.log_static(format!("{}{path}", run.below), &line)?;
        }
    }
    Ok(())
}

/// The curves that runs are compared by, what only the task knows first: those of joints and states are too many.
fn shared(run: &Shown) -> Vec<&(String, String)> {
    let compared = |path: &str| !["/plots/joint_", "/plots/state/"].iter().any(|group| path.starts_with(group));
    let mut curves: Vec<_> = run.curves.iter().filter(|(path, _)| compared(path)).collect();
    curves.sort_by_key(|(path, _)| !path.starts_with("/plots/task/"));
    curves
}

/// Writes the layout: the scenes above, curves and outcomes below.
fn write(layout: &mut Layout, shown: &[Shown]) -> RecordingStreamResult<Node> {
    let mut scenes = Vec::new();
    let mut outcomes = Vec::new();
    for run in shown {
        layout.look_below(&run.below);
        match &run.view {
            Some(View::Plane(map)) => scenes.push(plane_layout::plane(layout, &run.name, map)?),
            Some(View::Space(focus)) => scenes.push(space::layout::space(layout, &run.name, focus)?),
            None => {}
        }
        outcomes.push(layout.view("TextDocument", &run.name, summary::OUTCOME, &["$origin"])?);
    }
    layout.look_below("");
    let curves = plots(layout, shown)?;
    let scenes = layout.container(ContainerKind::Grid, "scenes", &scenes.iter().collect::<Vec<_>>(), &[])?;
    let outcomes = layout.container(ContainerKind::Tabs, "outcomes", &outcomes.iter().collect::<Vec<_>>(), &[])?;
    let below =
        layout.container(ContainerKind::Horizontal, "curves and outcomes", &[&curves, &outcomes], &[2.4, 1.0])?;
    layout.container(ContainerKind::Vertical, "runs", &[&scenes, &below], &[1.3, 1.0])
}

/// A plot for each kind of curve, with a line of every run that has it.
fn plots(layout: &mut Layout, shown: &[Shown]) -> RecordingStreamResult<Node> {
    let mut kinds: Vec<&(String, String)> = Vec::new();
    for curve in shown.iter().flat_map(shared) {
        if kinds.iter().all(|(path, _)| *path != curve.0) {
            kinds.push(curve);
        }
    }
    let mut views = Vec::new();
    for (path, name) in kinds {
        let having = shown.iter().filter(|run| run.curves.iter().any(|(other, _)| other == path));
        let rules: Vec<String> = having.map(|run| format!("+ {}{path}", run.below)).collect();
        let rules: Vec<&str> = rules.iter().map(String::as_str).collect();
        views.push(layout.shared_curves(name, &rules)?);
    }
    let pages: Vec<Node> = views
        .chunks(PLOTS)
        .enumerate()
        .map(|(page, views)| {
            let name = if page == 0 { "curves" } else { "more curves" };
            layout.container(ContainerKind::Grid, name, &views.iter().collect::<Vec<_>>(), &[])
        })
        .collect::<RecordingStreamResult<_>>()?;
    layout.container(ContainerKind::Tabs, "curves", &pages.iter().collect::<Vec<_>>(), &[])
}
