//! One call from C: lend the instance, admit the call, catch panics, log the error, return the status.

use super::super::error::Error;
use super::super::instance::Instance;
use super::super::lifecycle::Call;
use super::host_update::HostUpdate;
use super::types::fmi3Instance;
use crate::fmi::abi::component::{Lent, lend, take_back};
use crate::fmi::abi::panic_guard::guarded;
use crate::fmi::status::Status;

/// What the importer's pointer stands for.
pub struct Hosted {
    /// The instance.
    pub instance: Instance,
    /// The importer's callback, if it has one.
    pub update: Option<HostUpdate>,
}

/// What a call does on the instance.
pub type Body<'a> = &'a mut dyn FnMut(&mut Instance) -> Result<Status, Error>;

/// Runs one call on an instance. No panic gets past: a fault of ours ends the instance, not the importer.
///
/// # Safety
/// As [`lend`].
pub unsafe fn call<S: Into<Status>>(
    instance: fmi3Instance,
    call: Call,
    body: impl FnMut(&mut Instance) -> Result<S, Error>,
) -> Status {
    // SAFETY: passed on.
    unsafe { call_as(instance, call.name(), call, body) }
}

/// Runs one call of the function `name`, which is allowed where `call` is.
///
/// # Safety
/// As [`lend`].
pub unsafe fn call_as<S: Into<Status>>(
    instance: fmi3Instance,
    name: &'static str,
    call: Call,
    mut body: impl FnMut(&mut Instance) -> Result<S, Error>,
) -> Status {
    // SAFETY: the caller vouches for the pointer.
    match unsafe { lend::<Hosted>(instance) } {
        // A NULL or busy instance has no log that could be written to.
        None => Status::Error,
        Some(mut lent) => answer(&mut lent, name, &mut |instance| {
            instance.admit(call)?;
            body(instance).map(Into::into)
        }),
    }
}

/// Runs the body, logs its error, and returns a status. All functions share its code.
pub fn answer(lent: &mut Lent<'_, Hosted>, name: &'static str, body: Body<'_>) -> Status {
    let instance = &mut lent.instance().instance;
    let outcome = guarded(|| body(instance)).unwrap_or_else(|fault| {
        instance.give_up();
        Err(Error::Panic(fault))
    });
    outcome.unwrap_or_else(|error| {
        guarded(|| {
            instance.say(error.severity(), name, &error);
            Status::from(&error)
        })
        .unwrap_or(Status::Fatal)
    })
}

/// Frees an instance, unless it is busy or within an intermediate update, whose step still needs it.
///
/// # Safety
/// As [`take_back`].
pub unsafe fn free(instance: fmi3Instance) {
    // SAFETY: the caller vouches for the pointer.
    let admitted = unsafe { call(instance, Call::FreeInstance, |instance| instance.check_free()) };
    if admitted == Status::Ok {
        // SAFETY: as above.
        let hosted = unsafe { take_back::<Hosted>(instance) };
        // What a panic in a destructor leaves behind is a leak at worst.
        let _ = guarded(|| drop(hosted));
    }
}
