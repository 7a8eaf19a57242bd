//! The FMI 2.0 co-simulation face: an importer's calls become safe methods of an [`Instance`].
//!
//! `abi` turns pointers into borrows, [`lifecycle`] says which call is allowed when, the instance
//! does what was asked, [`status`] turns its errors into the standard's statuses, and [`logger`]
//! tells the importer why, in one line.
//!
//! A refused call changes nothing: values set together are applied all or none, and an instance that
//! answered `fmi2Error` is where it was before, so that the importer may correct the call.

pub mod abi;
pub mod description;
pub mod error;
pub mod experiment;
pub mod fmu_state;
pub mod inputs;
pub mod instance;
pub mod lifecycle;
pub mod logger;
pub mod resource_location;
pub mod status;
pub mod variables;

pub use error::Error;
pub use instance::Instance;
pub use status::Status;
