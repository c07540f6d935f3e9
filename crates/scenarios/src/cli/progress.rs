//! Progress on stderr: a bar on a terminal once a run takes longer than two seconds, else an occasional line.

use std::cell::{Cell, RefCell};
use std::io::{IsTerminal, stderr};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::say_aside;
use crate::trials::Status;

/// Nothing is shown before this.
const PATIENCE: Duration = Duration::from_secs(2);

/// Time between two lines where there is no terminal.
pub const LINE_INTERVAL: Duration = Duration::from_secs(10);

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

/// Progress of a campaign, told by many threads.
pub struct SweepProgress {
    quiet: bool,
    total: usize,
    started: Instant,
    on_terminal: bool,
    bar: ProgressBar,
    told: Mutex<Told>,
}

/// What was counted, and what of it was shown.
struct Told {
    before: usize,
    made: usize,
    failed: usize,
    last_line: Instant,
    tenths: usize,
}

impl SweepProgress {
    /// Progress of `total` runs, of which `before` were done before; shows nothing if `quiet`.
    pub fn new(total: usize, before: usize, quiet: bool) -> Self {
        let on_terminal = stderr().is_terminal();
        let bar = if on_terminal && !quiet { wide(ProgressBar::new(total as u64)) } else { ProgressBar::hidden() };
        let now = Instant::now();
        if before > 0 && before < total && !quiet {
            say_aside(&format!("{before} of {total} runs are done: going on with the others"));
        }
        let told = Told { before, made: 0, failed: 0, last_line: now, tenths: 10 * before / total.max(1) };
        Self { quiet, total, started: now, on_terminal, bar, told: Mutex::new(told) }
    }

    /// One more run has ended.
    pub fn one_done(&self, status: Status) {
        let mut told = self.told.lock().unwrap_or_else(|broken| broken.into_inner());
        told.made += 1;
        told.failed += usize::from(!matches!(status, Status::Success | Status::Invalid));
        if self.quiet || self.started.elapsed() < PATIENCE {
            return;
        }
        let done = told.before + told.made;
        let line = progress_line(done, self.total, told.made, told.failed, self.started.elapsed().as_secs_f64());
        if self.on_terminal {
            self.bar.set_message(line);
            self.bar.set_position(done as u64);
            return;
        }
        let tenths = 10 * done / self.total.max(1);
        if tenths > told.tenths || told.last_line.elapsed() >= LINE_INTERVAL {
            (told.tenths, told.last_line) = (tenths, Instant::now());
            say_aside(&line);
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// "12 of 30 runs (40 %), 2.1 a second, 1 without success, 9 s left".
fn progress_line(done: usize, total: usize, made: usize, failed: usize, elapsed_s: f64) -> String {
    let percent = 100 * done / total.max(1);
    let rate = made as f64 / elapsed_s.max(1e-3);
    let left = duration(total.saturating_sub(done) as f64 / rate.max(1e-9));
    format!("{done} of {total} runs ({percent} %), {rate:.2} a second, {failed} without success, {left} left")
}

/// "40 s", "3 min", "2.5 h".
fn duration(seconds: f64) -> String {
    match seconds {
        0.0..120.0 => format!("{seconds:.0} s"),
        120.0..7200.0 => format!("{:.0} min", seconds / 60.0),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}

fn wide(bar: ProgressBar) -> ProgressBar {
    match ProgressStyle::with_template("[{bar:30}] {msg}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

fn styled(bar: ProgressBar) -> ProgressBar {
    match ProgressStyle::with_template("{msg:12} [{bar:40}] {pos:>3}/{len} {elapsed}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_counts_only_what_is_made_now() {
        // 10 of 30 done before, 2 in 4 seconds: 18 left take 36 s
        let line = progress_line(12, 30, 2, 1, 4.0);
        assert_eq!(line, "12 of 30 runs (40 %), 0.50 a second, 1 without success, 36 s left");
    }

    #[test]
    fn durations_are_written_as_people_say_them() {
        assert_eq!([5.4, 300.0, 9000.0].map(duration), ["5 s", "5 min", "2.5 h"]);
    }
}
