//! Catches panics, so that none unwinds into C.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs a body. If it panics, the error is the panic's message.
pub fn guarded<T>(body: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(body)).map_err(text)
}

/// Message of a panic.
fn text(payload: Box<dyn Any + Send>) -> String {
    match payload.downcast::<String>() {
        Ok(text) => *text,
        Err(payload) => payload.downcast_ref::<&str>().copied().unwrap_or("no message").to_owned(),
    }
}

#[cfg(test)]
#[allow(clippy::panic, reason = "faults on purpose")]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_its_text() {
        assert_eq!(guarded(|| std::panic::panic_any("text")), Err::<(), _>("text".into()));
        assert_eq!(guarded(|| std::panic::panic_any(String::from("text"))), Err::<(), _>("text".into()));
        assert_eq!(guarded(|| std::panic::panic_any(7)), Err::<(), _>("no message".into()));
    }
}
