//! Sends log lines to the importer's logger.

use super::types::{fmi2CallbackFunctions, fmi2CallbackLogger, fmi2ComponentEnvironment};
use crate::fmi::slave::Severity;
use crate::fmi::slave::log::Host;
use crate::fmi::status::Status;
use std::ffi::CStr;

/// The importer's logger, if it has one.
#[derive(Clone, Copy)]
pub struct HostLogger {
    logger: Option<fmi2CallbackLogger>,
    environment: fmi2ComponentEnvironment,
}

impl HostLogger {
    /// The logger among the importer's callbacks.
    ///
    /// # Safety
    /// The logger must be NULL or a function of the standard's signature that may be called with
    /// this environment for as long as this value is used.
    pub unsafe fn new(callbacks: &fmi2CallbackFunctions) -> Self {
        Self { logger: callbacks.logger, environment: callbacks.component_environment }
    }
}

impl Host for HostLogger {
    fn log(&self, instance_name: &CStr, severity: Option<Severity>, category: &CStr, line: &CStr) {
        if let Some(logger) = self.logger {
            let status = severity.map_or(Status::Ok, Status::from) as i32;
            let (name, category, line) = (instance_name.as_ptr(), category.as_ptr(), line.as_ptr());
            // SAFETY: `new` was promised that the function may be called; the strings end in zero
            // and outlive the call; the line has no conversions that would ask for more arguments.
            unsafe { logger(self.environment, name, status, category, line) }
        }
    }
}
