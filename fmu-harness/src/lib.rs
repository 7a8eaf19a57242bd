//! Builds, packages, loads and runs FMUs of FMI 2.0 co-simulation.

pub mod host;
pub mod inputs;
pub mod package;
pub mod run;
pub mod trajectory;
