//! Loads FMUs of FMI 2.0 and 3.0 for co-simulation, runs them from communication point to communication point, and records
//! their outputs. A crate of its own since its loop is measured: it is optimised, the rest of the program is not.

pub mod host;
pub mod inputs;
pub mod run;
pub mod trajectory;
