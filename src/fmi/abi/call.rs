//! One call from C: lend the instance, admit the call, catch panics, log the error, answer.

use super::super::error::Error;
use super::super::instance::Instance;
use super::super::lifecycle::Call;
use super::super::status::Status;
use super::component;
use super::types::fmi2Component;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs one call on a component. No panic gets past: a fault of ours ends the instance, not the
/// importer.
///
/// # Safety
/// As [`component::lend`].
pub unsafe fn call<S: Into<Status>>(
    component: fmi2Component,
    call: Call,
    body: impl FnOnce(&mut Instance) -> Result<S, Error>,
) -> Status {
    // SAFETY: the caller vouches for the component.
    match unsafe { component::lend(component) } {
        // A NULL or busy component has no log that could be written to.
        None => Status::Error,
        Some(mut lent) => guarded(|| answer(lent.instance(), call, body)).unwrap_or(Status::Fatal),
    }
}

/// Runs a body that must not unwind into C; a panic becomes its text.
pub fn guarded<T>(body: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(body)).map_err(text)
}

fn answer<S: Into<Status>>(
    instance: &mut Instance,
    call: Call,
    body: impl FnOnce(&mut Instance) -> Result<S, Error>,
) -> Status {
    let outcome = guarded(|| {
        instance.admit(call)?;
        body(instance)
    });
    let outcome = outcome.unwrap_or_else(|fault| {
        instance.give_up();
        Err(Error::Panic(fault))
    });
    outcome.map_or_else(
        |error| {
            instance.logger().say(error.status(), call, &error);
            error.status()
        },
        Into::into,
    )
}

/// What a panic says of itself.
fn text(payload: Box<dyn Any + Send>) -> String {
    match payload.downcast::<String>() {
        Ok(text) => *text,
        Err(payload) => payload.downcast_ref::<&str>().copied().unwrap_or("no message").to_owned(),
    }
}
