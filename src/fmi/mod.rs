//! The FMI 2.0 face.

pub mod variables;
