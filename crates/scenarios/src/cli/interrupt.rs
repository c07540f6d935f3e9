//! Ctrl-C during long work: the first lets what is in flight end, the second ends the program at once.
//!
//! Other signals that end programs do so at once: whatever is finished is on disk by then.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use super::say_aside;

/// Exit code of a program that Ctrl-C ended, as shells have it: 128 and the number of the signal.
pub const CODE: u8 = 130;

/// The flag of this process: there is one Ctrl-C.
static STOP: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// A flag that Ctrl-C sets; the same one for all that watch.
pub fn watch() -> Arc<AtomicBool> {
    Arc::clone(STOP.get_or_init(install))
}

fn install() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let installed = ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(CODE));
        }
        say_aside("stopping: the runs in flight are brought to their end; Ctrl-C again stops at once");
    });
    if let Err(error) = installed {
        say_aside(&format!("note: Ctrl-C will stop at once, without waiting for runs in flight: {error}"));
    }
    stop
}
