//! Makes an instance for the importer, or logs why it cannot be made.

use super::super::error::Error;
use super::super::instance::{Instance, Request};
use super::super::lifecycle::Call;
use super::host_logger::HostLogger;
use super::types::fmi2Component;
use crate::fmi::abi::component::give;
use crate::fmi::abi::engine::borrowed::newer;
use crate::fmi::abi::panic_guard::guarded;
use crate::fmi::slave::log::Logger;
use std::ffi::CString;
use std::ptr::null_mut;

/// Makes an instance whose messages go to `host`. If that fails, the result is NULL, with one line in the log.
pub fn instantiate(request: &Request<'_>, host: HostLogger) -> fmi2Component {
    let made = guarded(|| Instance::instantiate(request, Box::new(host), newer()));
    match made.unwrap_or_else(|fault| Err(Error::Panic(fault))) {
        Ok(instance) => give(instance),
        Err(error) => {
            let name = request.name.map(CString::from).unwrap_or_default();
            let logger = Logger::new(Box::new(host), name, request.logging_on);
            logger.say(error.severity(), Call::Instantiate.name(), &error);
            null_mut()
        }
    }
}
