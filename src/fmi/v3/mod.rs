//! FMI 3.0 for model exchange and co-simulation: the lifecycle with event mode and intermediate update, the statuses and
//! the C interface around a [`Slave`](crate::fmi::slave::Slave).
//!
//! `abi` turns pointers into borrows, [`lifecycle`] says which call is allowed when, the [`Instance`] does what was
//! asked, and [`Status`] turns every outcome into one of the standard's statuses.
//!
//! Value references are those of FMI 2.0. What FMI 3.0 has in addition follows behind them ([`variables`]): the independent
//! variable, event indicators, clocks, arrays of the slider's corners. Enumerations pass as 64-bit integers.
//!
//! With event mode and early return, `fmi3DoStep` ends at every closing and opening of a contact. The values before
//! `fmi3UpdateDiscreteStates` are the left limits there, those after it the right limits. The trajectory is the same to the bit
//! as that without event mode, and as that of FMI 2.0. A contact's clock is active in event mode until that update.
//!
//! The standard wants `eventModeUsed` for an FMU that has clocks. An instance without event mode is made all the same: its
//! clocks are never read.
//!
//! To add a function of the standard: as in [`v2`](crate::fmi::v2).

pub mod abi;
pub mod error;
pub mod fmu_state;
pub mod instance;
pub mod lifecycle;
pub mod step;
pub mod variables;

pub use crate::fmi::status::Status;
pub use error::Error;
pub use instance::Instance;
