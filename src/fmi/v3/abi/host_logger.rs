//! The importer's logger as a safe host of log lines.

use super::types::{fmi3InstanceEnvironment, fmi3LogMessageCallback};
use crate::fmi::slave::Severity;
use crate::fmi::slave::log::Host;
use crate::fmi::status::Status;
use std::ffi::CStr;

/// The importer's logger, if it has one.
#[derive(Clone, Copy)]
pub struct HostLogger {
    logger: Option<fmi3LogMessageCallback>,
    environment: fmi3InstanceEnvironment,
}

impl HostLogger {
    /// The importer's logger.
    ///
    /// # Safety
    /// The logger must be NULL or a function of the standard's signature that may be called with this environment for as
    /// long as this value is used.
    pub unsafe fn new(logger: Option<fmi3LogMessageCallback>, environment: fmi3InstanceEnvironment) -> Self {
        Self { logger, environment }
    }
}

impl Host for HostLogger {
    fn log(&self, _: &CStr, severity: Option<Severity>, category: &CStr, line: &CStr) {
        if let Some(logger) = self.logger {
            // SAFETY: `new` was promised that the function may be called; the strings end in zero and outlive the call.
            unsafe {
                let status = severity.map_or(Status::Ok, Status::from) as i32;
                logger(self.environment, status, category.as_ptr(), line.as_ptr());
            }
        }
    }
}
