//! An instance for the importer, or the reason why there is none.

use super::super::error::Error;
use super::super::instance::{Instance, Request};
use super::super::lifecycle::Call;
use super::call::Hosted;
use super::host_logger::HostLogger;
use super::host_update::HostUpdate;
use super::types::fmi3Instance;
use crate::fmi::abi::component::give;
use crate::fmi::abi::engine::borrowed::newer;
use crate::fmi::abi::panic_guard::guarded;
use crate::fmi::slave::Interface;
use crate::fmi::slave::log::Logger;
use std::ffi::{CStr, CString};
use std::ptr::null_mut;

/// Makes an instance whose messages go to `host`; NULL, and one line in the log, if that cannot be.
pub fn instantiate(request: &Request<'_>, host: HostLogger, update: Option<HostUpdate>) -> fmi3Instance {
    let made = guarded(|| Instance::instantiate(request, Box::new(host), newer()));
    match made.unwrap_or_else(|fault| Err(Error::Panic(fault))) {
        Ok(instance) => give(Hosted { instance, update }),
        Err(error) => refuse(call_of(request.interface), request.name, host, &error),
    }
}

/// NULL, and the reason in the log. There is no instance yet, so the line is sent whether logging is on or not.
pub fn refuse(call: Call, name: Option<&CStr>, host: HostLogger, error: &Error) -> fmi3Instance {
    let name = name.map(CString::from).unwrap_or_default();
    Logger::new(Box::new(host), name, true).say(error.severity(), call.name(), error);
    null_mut()
}

/// The function that makes instances of this kind of interface.
fn call_of(interface: Interface) -> Call {
    match interface {
        Interface::CoSimulation => Call::InstantiateCoSimulation,
        Interface::ModelExchange => Call::InstantiateModelExchange,
    }
}

/// NULL: the FMU has not this kind of interface.
pub fn refuse_kind(call: Call, name: Option<&CStr>, host: HostLogger) -> fmi3Instance {
    refuse(call, name, host, &Error::NotProvided(call.not_provided().unwrap_or_default()))
}
