//! The C interface of FMI 2.0, on what [`abi`](crate::fmi::abi) has for every version.
#![allow(unsafe_code, reason = "pointers of the C interface")]

pub mod call;
pub mod functions;
pub mod host_logger;
pub mod instantiate;
pub mod types;
