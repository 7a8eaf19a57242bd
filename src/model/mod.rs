//! What the asked-for mechanism is.

pub mod signals;
