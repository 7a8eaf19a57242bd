//! The FMI 2.0 face.

pub mod description;
pub mod variables;
