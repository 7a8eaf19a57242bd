//! The common part of the C interfaces of all versions of FMI.
//!
//! [`borrow`] checks all pointers of the importer, for null, alignment and length; they are checked nowhere else. Two
//! things cannot be checked and are required by the standard: a non-null pointer points to as many elements as the
//! importer says, and a component is a live component of this library. [`component`] lends a component to one call at a
//! time, and [`panic_guard`] catches panics. The macro of `declare.rs` makes bodies, exports and names from a version's
//! list of functions. [`engine`] lets another build of the library compute.
#![allow(unsafe_code, reason = "pointers of the C interface")]

mod argument_error;
pub mod borrow;
pub mod component;
pub(super) mod declare;
pub mod dispatch_x86_64_v3;
pub mod engine;
pub mod estimation;
pub mod panic_guard;

pub use argument_error::ArgumentError;
