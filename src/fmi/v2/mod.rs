//! FMI 2.0 for co-simulation and model exchange: the lifecycle, the statuses and the C interface around a
//! [`Slave`](crate::fmi::slave::Slave).
//!
//! `abi` turns pointers into borrows, [`lifecycle`] lists the calls that are allowed in each state, the [`Instance`]
//! executes calls, [`Status`] is one of the standard's statuses for every outcome, and the slave's log gives the
//! importer the reason in one line.
//!
//! To add a function of the standard: an entry in the list of `abi/functions.rs`, the safe method of
//! [`Instance`] that the entry calls, and the function's row in [`lifecycle`], without which the
//! entry does not compile.

pub mod abi;
pub mod description;
pub mod error;
pub mod fmu_state;
pub mod instance;
pub mod lifecycle;
pub mod resource_location;
pub mod status_kind;

pub use crate::fmi::status::Status;
pub use error::Error;
pub use instance::Instance;
