//! The C face, and the only `unsafe` of the library.
//!
//! What comes from outside is an allegation until [`borrow`] has checked it: null, alignment and
//! length are looked at there and nowhere else. What cannot be checked (that a non-null pointer
//! points to as many entries as the importer says, and that a component is a live one of ours) the
//! importer vouches for by the standard.
#![allow(unsafe_code, reason = "pointers of the C interface")]

pub mod borrow;
pub mod call;
pub mod component;
pub mod exports;
pub mod functions;
pub mod host_logger;
pub mod newer;
pub mod types;
