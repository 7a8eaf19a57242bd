//! The C interface, and the only `unsafe` of the library.
//!
//! What comes from outside is an allegation until [`borrow`] has checked it: null, alignment and
//! length are checked there and nowhere else. What cannot be checked (that a non-null pointer
//! points to as many entries as the importer says, and that a component is a live one of ours) the
//! importer vouches for by the standard.
//!
//! [`borrow`], [`component`], [`panic_guard`] and the macro of `declare.rs` know no version of FMI.
#![allow(unsafe_code, reason = "pointers of the C interface")]

pub mod borrow;
pub mod call;
pub mod component;
pub(crate) mod declare;
pub mod dispatch_x86_64_v3;
pub mod engine;
pub mod functions;
pub mod host_logger;
pub mod instantiate;
pub mod panic_guard;
pub mod types;
