//! The library in the form in which a host loads it, linked from the Rust library that the tests link.

pub use slidercrank::fmi;
