//! The FMI 3.0 face as an importer sees it: through the C functions.
#![allow(unsafe_code, reason = "the tests call the C functions")]
#![allow(clippy::panic, reason = "a test that cannot go on")]

mod derivatives;
mod estimation;
mod events;
mod exchange;
mod importer;
mod lifecycle;
mod product;
mod same_bits;
mod states;
mod updates;
mod values;
