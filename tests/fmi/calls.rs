//! A call on an instance: panics and internal errors end in the instance's state.

use slidercrank::fmi::abi::component::{give, take_back};
use slidercrank::fmi::slave::Interface;
use slidercrank::fmi::slave::log::Silent;
use slidercrank::fmi::status::Status;
use slidercrank::fmi::v2::abi::call::call;
use slidercrank::fmi::v2::abi::types::fmi2Component;
use slidercrank::fmi::v2::error::Error;
use slidercrank::fmi::v2::instance::{CO_SIMULATION, Instance, Request};
use slidercrank::fmi::v2::lifecycle::{Call, State};
use slidercrank::scene::slot;
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
