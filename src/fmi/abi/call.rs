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

#[cfg(test)]
#[allow(clippy::panic, reason = "faults on purpose")]
mod tests {
    use super::super::component::{give, take_back};
    use super::super::host_logger::HostLogger;
    use super::*;
    use crate::fmi::instance::Request;
    use crate::fmi::lifecycle::State;
    use crate::scene::slot;
    use std::ffi::CString;

    fn instance() -> fmi2Component {
        let guid = CString::new(slot::read().expect("a readable slot").1).expect("no zero");
        let request = Request {
            name: Some(c"x"),
            fmu_type: 1,
            guid: Some(&guid),
            resource_location: None,
            host: HostLogger::SILENT,
            logging_on: true,
        };
        give(Instance::instantiate(&request).expect("an instance"))
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
            assert!(unsafe { take_back(c) }.is_some());
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
            let expected = if function.allowed(State::Error) { Status::Ok } else { Status::Error };
            assert_eq!(ask(c, function, |_| Ok(())), expected, "{}", function.name());
        }
        assert_eq!(ask(c, Call::Reset, Instance::reset), Status::Ok);
        // SAFETY: the component is live and not used again.
        drop(unsafe { take_back(c) });
    }

    #[test]
    fn a_panic_tells_its_text() {
        assert_eq!(guarded(|| std::panic::panic_any("text")), Err::<(), _>("text".into()));
        assert_eq!(guarded(|| std::panic::panic_any(String::from("text"))), Err::<(), _>("text".into()));
        assert_eq!(guarded(|| std::panic::panic_any(7)), Err::<(), _>("no message".into()));
    }

    #[test]
    fn a_busy_instance_is_neither_lent_nor_taken() {
        let c = instance();
        // SAFETY: the component is live; it is not taken back while lent.
        unsafe {
            let lent = component::lend(c);
            assert!(lent.is_some() && component::lend(c).is_none() && take_back(c).is_none());
            drop(lent);
            assert!(take_back(c).is_some());
        }
    }
}
