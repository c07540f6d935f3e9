//! Progress on stderr: a bar on a terminal once a run takes longer than two seconds, else an occasional line.

use std::cell::{Cell, RefCell};
use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::say_aside;

/// Nothing is shown before this.
const PATIENCE: Duration = Duration::from_secs(2);

/// Time between two lines where there is no terminal.
const LINE_INTERVAL: Duration = Duration::from_secs(10);

/// Progress of one run.
pub struct RunProgress {
    quiet: bool,
    started: Instant,
    last_line: Cell<Instant>,
    bar: RefCell<Option<ProgressBar>>,
}

impl RunProgress {
    /// Shows nothing yet, and nothing ever if `quiet`.
    pub fn new(quiet: bool) -> Self {
        let now = Instant::now();
        Self { quiet, started: now, last_line: Cell::new(now), bar: RefCell::new(None) }
    }

    /// Shows that `stage` is done to `share` of it, if that is known.
    pub fn show(&self, stage: &'static str, share: Option<f64>) {
        if self.quiet || self.started.elapsed() < PATIENCE {
            return;
        }
        let percent = share.map(|share| (100.0 * share.clamp(0.0, 1.0)).round());
        if stderr().is_terminal() {
            let mut bar = self.bar.borrow_mut();
            let bar = bar.get_or_insert_with(|| styled(ProgressBar::new(100)));
            bar.set_message(stage);
            bar.set_position(percent.unwrap_or(0.0) as u64);
        } else if self.last_line.get().elapsed() >= LINE_INTERVAL {
            self.last_line.set(Instant::now());
            let percent = percent.map_or_else(String::new, |percent| format!(" {percent} %"));
            say_aside(&format!("{stage}{percent} after {:.0} s", self.started.elapsed().as_secs_f64()));
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = self.bar.borrow_mut().take() {
            bar.finish_and_clear();
        }
    }
}

/// Progress of several trials, told by many threads.
pub struct TrialsProgress {
    quiet: bool,
    total: usize,
    done: AtomicUsize,
    started: Instant,
    bar: ProgressBar,
    on_terminal: bool,
}

impl TrialsProgress {
    /// Progress of `total` trials; shows nothing if `quiet`.
    pub fn new(total: usize, quiet: bool) -> Self {
        let on_terminal = stderr().is_terminal();
        let shown = on_terminal && !quiet;
        let bar =
            if shown { styled(ProgressBar::new(total as u64)).with_message("trials") } else { ProgressBar::hidden() };
        Self { quiet, total, done: AtomicUsize::new(0), started: Instant::now(), bar, on_terminal }
    }

    /// One more trial is done.
    pub fn one_done(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        if self.quiet || self.started.elapsed() < PATIENCE {
            return;
        }
        if self.on_terminal {
            self.bar.set_position(done as u64);
        } else if done == self.total || done * 10 / self.total != (done - 1) * 10 / self.total {
            say_aside(&format!("{done} of {} trials after {:.0} s", self.total, self.started.elapsed().as_secs_f64()));
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

fn styled(bar: ProgressBar) -> ProgressBar {
    match ProgressStyle::with_template("{msg:12} [{bar:40}] {pos:>3}/{len} {elapsed}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
