//! Builds and packages the slider-crank FMU, and runs co-simulation FMUs of FMI 2.0 and 3.0.

pub mod accuracy;
pub mod campaign;
pub mod command;
pub mod dynamics;
pub mod effects;
pub mod frame;
pub mod inspect;
pub mod laws;
pub mod output;
pub mod package;
pub mod peers;
pub mod precision;
pub mod python;
pub mod realtime;
pub mod report;
pub mod scenes;
pub mod sensitivity;
pub mod ssp;
pub mod sweep;
pub mod wear;

pub use fmu_host::{host, inputs, run, trajectory};
