//! Tests of the live sink: nobody there, somebody late, somebody who hangs or goes.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use super::*;

/// Time that a test of a bounded end may take beyond the bound: a loaded machine.
const SLACK: Duration = Duration::from_millis(500);

#[derive(Default)]
struct Script {
    open: AtomicBool,
    gone: AtomicBool,
    hangs: AtomicBool,
    taken: AtomicU64,
}

struct Scripted(Arc<Script>);

impl Outlet for Scripted {
    fn state(&self) -> OutletState {
        match (self.0.gone.load(Ordering::SeqCst), self.0.open.load(Ordering::SeqCst)) {
            (true, _) => OutletState::Closed,
            (false, true) => OutletState::Open,
            (false, false) => OutletState::Waiting,
        }
    }

    fn send(&self, _message: LogMsg) {
        while self.0.hangs.load(Ordering::SeqCst) {
            std::thread::sleep(LOOK);
        }
        self.0.taken.fetch_add(1, Ordering::SeqCst);
    }

    fn flush(&self, _timeout: Duration) -> bool {
        true
    }
}

/// Three messages that are needed late and five rows in time.
fn messages() -> Vec<LogMsg> {
    let (stream, storage) = rerun::RecordingStreamBuilder::new("test").enabled(true).memory().unwrap();
    stream.set_log_time_enabled(false);
    stream.set_log_tick_enabled(false);
    for step in 0..5 {
        let times = [rerun::TimeColumn::new_sequence("step", [step])];
        let columns = rerun::Scalars::new([1.0]).columns_of_unit_batches().unwrap();
        stream.send_columns("plots/test", times, columns).unwrap();
    }
    storage.take().into_iter().filter(|message| !matches!(message, LogMsg::SetStoreInfo(_))).collect()
}

fn rows_in_time() -> Vec<LogMsg> {
    messages().into_iter().filter(|message| !is_needed_late(message)).collect()
}

fn run(script: &Arc<Script>, patience: Duration) -> (Ended, Duration) {
    let (sink, handle) = start(Scripted(Arc::clone(script))).unwrap();
    rows_in_time().into_iter().for_each(|message| sink.send(message));
    let begin = Instant::now();
    (handle.end(begin + patience), begin.elapsed())
}

#[test]
fn a_listener_gets_everything() {
    let script = Arc::new(Script::default());
    script.open.store(true, Ordering::SeqCst);
    let (ended, _) = run(&script, Duration::from_secs(10));
    assert_eq!(ended, Ended { dropped: 0, delivered: true });
    assert_eq!(script.taken.load(Ordering::SeqCst), rows_in_time().len() as u64);
}

#[test]
fn a_late_listener_gets_everything() {
    let script = Arc::new(Script::default());
    let late = Arc::clone(&script);
    let opener = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(100));
        late.open.store(true, Ordering::SeqCst);
    });
    let (ended, _) = run(&script, Duration::from_secs(10));
    opener.join().unwrap();
    assert_eq!(ended, Ended { dropped: 0, delivered: true });
}

#[test]
fn nobody_costs_no_more_than_the_patience() {
    let patience = Duration::from_millis(200);
    let (ended, took) = run(&Arc::new(Script::default()), patience);
    assert_eq!(ended, Ended { dropped: rows_in_time().len() as u64, delivered: false });
    assert!(took < patience + SLACK, "{took:?}");
}

#[test]
fn a_listener_who_hangs_costs_no_more_than_the_patience() {
    let script = Arc::new(Script::default());
    script.open.store(true, Ordering::SeqCst);
    script.hangs.store(true, Ordering::SeqCst);
    let patience = Duration::from_millis(200);
    let (ended, took) = run(&script, patience);
    script.hangs.store(false, Ordering::SeqCst);
    assert!(!ended.delivered);
    assert!(took < patience + SLACK, "{took:?}");
}

#[test]
fn a_listener_who_is_gone_is_not_waited_for() {
    let script = Arc::new(Script::default());
    script.gone.store(true, Ordering::SeqCst);
    let (ended, took) = run(&script, Duration::from_secs(10));
    assert_eq!(ended, Ended { dropped: rows_in_time().len() as u64, delivered: false });
    assert!(took < SLACK, "{took:?}");
}

#[test]
fn a_full_queue_drops_the_oldest_rows_and_counts_them() {
    let mut queue = Queue::default();
    rows_in_time().into_iter().for_each(|message| queue.put(message));
    let before = queue.passing.len();
    assert!(before > 0);
    let room = queue.passing_bytes - 1;
    queue.shrink(room);
    assert_eq!((queue.passing.len(), queue.dropped), (before - 1, 1));
}

#[test]
fn what_has_no_time_is_kept() {
    let (stream, storage) = rerun::RecordingStreamBuilder::new("test").enabled(true).memory().unwrap();
    stream.log_static("summary", &rerun::TextDocument::new("kept")).unwrap();
    let mut queue = Queue::default();
    storage.take().into_iter().for_each(|message| queue.put(message));
    assert!(queue.passing.is_empty());
    assert!(queue.kept.len() >= 2, "identity and document");
}
