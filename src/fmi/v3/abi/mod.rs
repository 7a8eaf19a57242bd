//! The C interface of FMI 3.0, on what [`abi`](crate::fmi::abi) has for every version.
#![allow(unsafe_code, reason = "pointers of the C interface")]

pub mod call;
pub mod do_step;
pub mod estimation;
pub mod functions;
pub mod host_logger;
pub mod host_update;
pub mod instantiate;
pub mod types;
