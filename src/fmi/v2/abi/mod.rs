//! The C interface of FMI 2.0. The parts for all versions are in [`abi`](crate::fmi::abi).
#![allow(unsafe_code, reason = "pointers of the C interface")]

pub mod call;
pub mod estimation;
pub mod functions;
pub mod host_logger;
pub mod instantiate;
pub mod types;
