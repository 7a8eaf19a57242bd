//! What the C interfaces of all versions of FMI have in common.
//!
//! What comes from outside is an allegation until [`borrow`] has checked it: null, alignment and length are checked there
//! and nowhere else. What cannot be checked (that a non-null pointer points to as many entries as the importer says, and
//! that a component is a live one of ours) the importer vouches for by the standard. A component is lent to one call at a
//! time by [`component`], and panics end in [`panic_guard`]. From a version's list of functions the macro of `declare.rs`
//! makes bodies, exports and names. [`engine`] lets another build of the library compute.
#![allow(unsafe_code, reason = "pointers of the C interface")]

mod argument_error;
pub mod borrow;
pub mod component;
pub(super) mod declare;
pub mod dispatch_x86_64_v3;
pub mod engine;
pub mod panic_guard;

pub use argument_error::ArgumentError;
