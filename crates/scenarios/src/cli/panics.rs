//! Panics inside a run become its failure, instead of ending the program.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind};

thread_local! {
    /// `Some` while a run is watched on this thread: what its panic said.
    static WATCHED: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Lets panics of watched runs be remembered; all others are reported as ever.
pub fn install() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let watched = WATCHED.with(|watched| match watched.borrow_mut().as_mut() {
            Some(message) => {
                *message = described(panic);
                true
            }
            None => false,
        });
        if !watched {
            usual(panic);
        }
    }));
}

/// Runs `work`; a panic becomes its message and place.
pub fn catch<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    let before = WATCHED.with(|watched| watched.replace(Some(String::new())));
    let result = catch_unwind(AssertUnwindSafe(work));
    let message = WATCHED.with(|watched| watched.replace(before)).unwrap_or_default();
    result.map_err(|payload| if message.is_empty() { payload_text(payload.as_ref()) } else { message })
}

fn described(panic: &PanicHookInfo<'_>) -> String {
    let place = panic.location().map_or_else(String::new, |place| format!(" ({}:{})", place.file(), place.line()));
    format!("a defect of wield: {}{place}", payload_text(panic.payload()))
}

fn payload_text(payload: &(dyn std::any::Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_else(|| "panic without a message".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_its_message() {
        assert_eq!(catch(|| 3), Ok(3));
        let message = catch(|| panic!("broken invariant {}", 4)).unwrap_err();
        assert!(message.contains("broken invariant 4"), "{message}");
    }
}
