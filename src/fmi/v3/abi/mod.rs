//! The C interface of FMI 3.0. What knows no version comes from [`v2::abi`](crate::fmi::v2::abi).
#![allow(unsafe_code, reason = "pointers of the C interface")]

pub mod call;
pub mod do_step;
pub mod functions;
pub mod host_logger;
pub mod host_update;
pub mod instantiate;
pub mod types;
