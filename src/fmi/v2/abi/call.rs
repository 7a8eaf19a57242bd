//! A call from C: lends the instance, checks the life cycle, catches panics, logs errors and returns the status.

use super::super::error::Error;
use super::super::instance::Instance;
use super::super::lifecycle::Call;
use super::types::fmi2Component;
use crate::fmi::abi::component;
use crate::fmi::abi::panic_guard::guarded;
use crate::fmi::status::Status;

/// Runs one call on a component. Panics are caught: an internal error makes the instance unusable, but the importer
/// goes on.
///
/// # Safety
/// As [`component::lend`].
pub unsafe fn call<S: Into<Status>>(
    component: fmi2Component,
    call: Call,
    body: impl FnOnce(&mut Instance) -> Result<S, Error>,
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
    body: impl FnOnce(&mut Instance) -> Result<S, Error>,
) -> Status {
    // SAFETY: the caller guarantees that the component is valid.
    match unsafe { component::lend::<Instance>(component) } {
        // A NULL or busy component has no log that could be used.
        None => Status::Error,
        Some(mut lent) => guarded(|| answer(lent.instance(), name, call, body)).unwrap_or(Status::Fatal),
    }
}

fn answer<S: Into<Status>>(
    instance: &mut Instance,
    name: &'static str,
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
            instance.logger().say(error.severity(), name, &error);
            Status::from(&error)
        },
        Into::into,
    )
}

#[cfg(test)]
#[allow(clippy::panic, reason = "faults on purpose")]
mod tests {
    use super::super::super::instance::{CO_SIMULATION, Request};
    use super::super::super::lifecycle::State;
    use super::*;
    use crate::fmi::abi::component::{give, take_back};
    use crate::fmi::slave::Interface;
    use crate::fmi::slave::log::Silent;
    use crate::scene::slot;
    use std::ffi::CString;

    fn instance() -> fmi2Component {
        let guid = CString::new(slot::read().expect("a readable slot").1).expect("no zero");
        let request = Request {
            name: Some(c"x"),
            fmu_type: CO_SIMULATION,
            guid: Some(&guid),
            resource_location: None,
            logging_on: true,
        };
        give(Instance::instantiate(&request, Box::new(Silent), None).expect("an instance"))
    }

    fn ask(c: fmi2Component, function: Call, body: fn(&mut Instance) -> Result<(), Error>) -> Status {
        // SAFETY: the component is live.
        unsafe { call(c, function, body) }
    }

    #[test]
    fn a_panic_is_fatal_to_the_instance_and_to_nothing_else() {
        let (c, other) = (instance(), instance());
        let fault = |_: &mut Instance| std::panic::panic_any("a fault on purpose");
        assert_eq!(ask(c, Call::Reset, fault), Status::Fatal);
        for &function in Call::ALL.iter().filter(|&&function| function != Call::FreeInstance) {
            assert_eq!(ask(c, function, |_| Ok(())), Status::Fatal, "{}", function.name());
        }
        assert_eq!(ask(other, Call::Reset, Instance::reset), Status::Ok);
        for c in [c, other] {
            // SAFETY: the component is live and not used again.
            assert!(unsafe { take_back::<Instance>(c) }.is_some());
        }
    }

    #[test]
    fn a_step_that_meets_a_broken_promise_ends_in_the_error_state() {
        let c = instance();
        let broken = |instance: &mut Instance| {
            instance.fail();
            Ok(())
        };
        assert_eq!(ask(c, Call::Reset, broken), Status::Ok);
        for &function in Call::ALL {
            let ours = function.interface() != Some(Interface::ModelExchange);
            let expected = if ours && function.allowed(State::Error) { Status::Ok } else { Status::Error };
            assert_eq!(ask(c, function, |_| Ok(())), expected, "{}", function.name());
        }
        assert_eq!(ask(c, Call::Reset, Instance::reset), Status::Ok);
        // SAFETY: the component is live and not used again.
        drop(unsafe { take_back::<Instance>(c) });
    }
}
