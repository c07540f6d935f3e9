//! A live sink that never makes a run wait: a queue of bounded size with a thread of its own.
//!
//! What a late viewer needs (identity, layout, everything without a time) is kept for as long as it takes; rows in time are
//! dropped, oldest first and counted, when more of them wait than the queue may hold.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use rerun::SizeBytes as _;
use rerun::StoreKind;
use rerun::log::{Chunk, LogMsg};
use rerun::sink::{LogSink, SinkFlushError};

use super::outlet::{Outlet, OutletState};

/// Rows in time may fill this much memory while nobody takes them: hours of a run at 100 rows per second.
const QUEUE_BYTES: u64 = 256 << 20;

/// Time between two looks at a viewer that is not there yet.
const LOOK: Duration = Duration::from_millis(20);

/// The stream's side: takes messages at once.
pub(super) struct LiveSink(Arc<Shared>);

/// The recorder's side: ends the stream in bounded time.
pub(super) struct LiveHandle(Arc<Shared>);

struct Shared {
    queue: Mutex<Queue>,
    changed: Condvar,
}

#[derive(Default)]
struct Queue {
    kept: VecDeque<LogMsg>,
    passing: VecDeque<(LogMsg, u64)>,
    passing_bytes: u64,
    dropped: u64,
    end: Option<Instant>,
    closed: bool,
    delivered: bool,
}

/// How a live stream ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ended {
    /// Messages that no viewer got.
    pub(super) dropped: u64,
    /// Whether everything else has left.
    pub(super) delivered: bool,
}

/// Starts the thread that serves `outlet`.
pub(super) fn start(outlet: impl Outlet) -> std::io::Result<(LiveSink, LiveHandle)> {
    let shared = Arc::new(Shared { queue: Mutex::default(), changed: Condvar::new() });
    let worker = Arc::clone(&shared);
    std::thread::Builder::new().name("live-recording".into()).spawn(move || worker.serve(outlet))?;
    Ok((LiveSink(Arc::clone(&shared)), LiveHandle(shared)))
}

impl LogSink for LiveSink {
    fn send(&self, message: LogMsg) {
        self.0.lock().put(message);
        self.0.changed.notify_all();
    }

    /// Waits for nobody: the recorder ends the stream through its handle.
    fn flush_blocking(&self, _timeout: Duration) -> Result<(), SinkFlushError> {
        Ok(())
    }
}

impl Drop for LiveSink {
    fn drop(&mut self) {
        self.0.lock().end_at(Instant::now());
        self.0.changed.notify_all();
    }
}

impl LiveHandle {
    /// Gives the viewer until `deadline` to take what waits.
    pub(super) fn end(&self, deadline: Instant) -> Ended {
        let mut queue = self.0.lock();
        queue.end_at(deadline);
        self.0.changed.notify_all();
        while !queue.closed {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            queue = self.0.wait(queue, left);
        }
        queue.give_up();
        Ended { dropped: queue.dropped, delivered: queue.delivered }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, queue: MutexGuard<'a, Queue>, time: Duration) -> MutexGuard<'a, Queue> {
        self.changed.wait_timeout(queue, time).unwrap_or_else(PoisonError::into_inner).0
    }

    fn serve(&self, outlet: impl Outlet) {
        let delivered = self.forward(&outlet);
        // a viewer's connection closes in order before the run goes on to its end
        drop(outlet);
        let mut queue = self.lock();
        queue.delivered = delivered;
        queue.give_up();
        self.changed.notify_all();
    }

    /// Forwards messages until the end; whether all have left.
    fn forward(&self, outlet: &impl Outlet) -> bool {
        loop {
            let mut queue = self.lock();
            let end = queue.end;
            let left = end.map(|end| end.saturating_duration_since(Instant::now()));
            match (outlet.state(), left) {
                (OutletState::Closed, _) => return false,
                (OutletState::Waiting, Some(left)) if left.is_zero() => return false,
                (OutletState::Waiting, left) => {
                    drop(self.wait(queue, left.map_or(LOOK, |left| left.min(LOOK))));
                    continue;
                }
                (OutletState::Open, _) => {}
            }
            match (queue.take(), left) {
                (Some(message), _) => {
                    drop(queue);
                    outlet.send(message);
                }
                (None, Some(left)) => {
                    drop(queue);
                    return outlet.flush(left);
                }
                (None, None) => drop(self.wait(queue, 10 * LOOK)),
            }
        }
    }
}

impl Queue {
    fn put(&mut self, message: LogMsg) {
        if self.closed {
            self.dropped += 1;
        } else if is_needed_late(&message) {
            self.kept.push_back(message);
        } else {
            let bytes = message.total_size_bytes();
            self.passing_bytes += bytes;
            self.passing.push_back((message, bytes));
            self.shrink(QUEUE_BYTES);
        }
    }

    fn shrink(&mut self, limit: u64) {
        while self.passing_bytes > limit {
            let Some((_, bytes)) = self.passing.pop_front() else { return };
            self.passing_bytes -= bytes;
            self.dropped += 1;
        }
    }

    /// The next message: identity and layout come before rows in time.
    fn take(&mut self) -> Option<LogMsg> {
        if let Some(message) = self.kept.pop_front() {
            return Some(message);
        }
        let (message, bytes) = self.passing.pop_front()?;
        self.passing_bytes -= bytes;
        Some(message)
    }

    /// The earliest end that was asked for counts.
    fn end_at(&mut self, deadline: Instant) {
        self.end = Some(self.end.map_or(deadline, |end| end.min(deadline)));
    }

    fn give_up(&mut self) {
        self.closed = true;
        self.dropped += (self.kept.len() + self.passing.len()) as u64;
        self.kept.clear();
        self.passing.clear();
        self.passing_bytes = 0;
    }
}

/// Whether a viewer that comes late cannot do without a message: identity, layout, and what has no time.
fn is_needed_late(message: &LogMsg) -> bool {
    match message {
        LogMsg::SetStoreInfo(_) | LogMsg::BlueprintActivationCommand(_) => true,
        LogMsg::ArrowMsg(store, _) if store.kind() == StoreKind::Blueprint => true,
        LogMsg::ArrowMsg(_, rows) => Chunk::from_arrow_msg(rows).is_ok_and(|chunk| chunk.is_static()),
    }
}

#[cfg(test)]
#[path = "live_tests.rs"]
mod tests;
