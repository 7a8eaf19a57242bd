//! The FMI face as an importer sees it: through the C functions.
#![allow(unsafe_code, reason = "the tests call the C functions")]
#![allow(clippy::panic, reason = "a test that cannot go on")]

mod calls;
mod dead_ends;
mod deadline;
mod derivatives;
mod engine;
mod estimation;
mod exchange;
mod hosted;
mod instantiate;
mod library;
mod lifecycle;
mod logging;
mod slave;
mod small_stack;
mod start_derivatives;
mod states;
mod steps;
mod threads;
mod tolerance;
mod values;
