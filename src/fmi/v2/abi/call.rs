//! A call from C: lends the instance, checks the life cycle, catches panics, logs errors and returns the status.

use super::super::error::Error;
use super::super::instance::Instance;
use super::super::lifecycle::Call;
use super::types::fmi2Component;
use crate::fmi::abi::component;
use crate::fmi::abi::panic_guard::guarded;
use crate::fmi::status::Status;

/// What a call does on the instance.
type Body<'a> = &'a mut dyn FnMut(&mut Instance) -> Result<Status, Error>;

/// Runs one call on a component. Panics are caught: an internal error makes the instance unusable, but the importer
/// goes on.
///
/// # Safety
/// As [`component::lend`].
pub unsafe fn call<S: Into<Status>>(
    component: fmi2Component,
    call: Call,
    body: impl FnMut(&mut Instance) -> Result<S, Error>,
) -> Status {
    // SAFETY: passed on.
    unsafe { call_as(component, call.name(), call, body) }
}

/// Runs one call of the function `name`, which is allowed where `call` is.
///
/// # Safety
/// As [`component::lend`].
pub unsafe fn call_as<S: Into<Status>>(
    component: fmi2Component,
    name: &'static str,
    call: Call,
    mut body: impl FnMut(&mut Instance) -> Result<S, Error>,
) -> Status {
    // SAFETY: the caller guarantees that the component is valid.
    match unsafe { component::lend::<Instance>(component) } {
        // A NULL or busy component has no log that could be used.
        None => Status::Error,
        Some(mut lent) => answer(lent.instance(), name, call, &mut |instance| body(instance).map(Into::into)),
    }
}

/// Runs the body, logs its error, and returns a status. All functions share its code.
fn answer(instance: &mut Instance, name: &'static str, call: Call, body: Body<'_>) -> Status {
    let outcome = guarded(|| {
        instance.admit(call)?;
        body(instance)
    });
    let outcome = outcome.unwrap_or_else(|fault| {
        instance.give_up();
        Err(Error::Panic(fault))
    });
    outcome.unwrap_or_else(|error| {
        guarded(|| {
            instance.logger().say(error.severity(), name, &error);
            Status::from(&error)
        })
        .unwrap_or(Status::Fatal)
    })
}
