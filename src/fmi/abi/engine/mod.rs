//! An [`Engine`](crate::fmi::slave::engine::Engine) across the border of two libraries: a table of C functions.
//!
//! Both libraries are builds of the same sources, so they know the same scenes, outputs and errors; but each has its own
//! memory and its own panics. Inputs and outputs pass as C structures, everything else as bytes that the receiver copies
//! before the call returns. What fails, a panic included, is returned as a `Failure`.
//!
//! [`offered`] is the table of this library, [`borrowed`] an engine made of the table of another one.

pub mod borrowed;
pub mod offered;

use crate::fmi::slave::engine::Stops;
use crate::model::signals::{Inputs, Outputs};
use crate::simulation::{ContactReport, Side, SimulationError};
use serde::{Deserialize, Serialize};
use std::ffi::c_void;

/// Name of the function that hands out a library's table: an [`Offer`].
pub const OFFER: &str = "slidercrank_engine";

/// Hands out the table, or NULL to a library of other sources: `declaration` has 32 bytes, the digest of its variables,
/// and `outputs` is the size of its [`Outputs`].
pub type Offer = unsafe extern "C" fn(declaration: *const u8, outputs: usize) -> *const Table;

/// Bytes that are lent for one call.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Bytes {
    data: *const u8,
    length: usize,
}

/// Takes bytes during one call.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Sink {
    context: *mut c_void,
    take: unsafe extern "C" fn(context: *mut c_void, bytes: Bytes),
}

/// Which outputs are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Reading {
    /// Their values.
    Values,
    /// Their first time derivatives.
    Rates,
    /// Their derivatives along a direction of the inputs.
    Sensitivity,
}

/// What another library calls. A run is a pointer that `start` or `restore` gave and `free` was not given yet; one call
/// at a time is made on it. The sink of `snapshot` gets a snapshot or a failure, that of any other a failure if there is
/// one; then a run is NULL.
#[repr(C)]
pub struct Table {
    start: unsafe extern "C" fn(scene: Bytes, inputs: *const Inputs, sink: Sink) -> *mut c_void,
    restore: unsafe extern "C" fn(scene: Bytes, snapshot: Bytes, sink: Sink) -> *mut c_void,
    free: unsafe extern "C" fn(run: *mut c_void),
    time: unsafe extern "C" fn(run: *mut c_void) -> f64,
    set_inputs: unsafe extern "C" fn(run: *mut c_void, inputs: *const Inputs, rates: *const Inputs, sink: Sink),
    /// Returns whether a contact has closed or opened at the end.
    advance: unsafe extern "C" fn(run: *mut c_void, time: f64, stops: Stops, sink: Sink) -> bool,
    look: unsafe extern "C" fn(run: *mut c_void, side: Side, sink: Sink),
    read: unsafe extern "C" fn(run: *mut c_void, what: Reading, seed: *const Inputs, outputs: *mut Outputs, sink: Sink),
    contacts: unsafe extern "C" fn(run: *mut c_void, report: *mut ContactReport, sink: Sink),
    /// Writes states and rates, each of which have room for `MAX_STATES`, and returns their number.
    write_states: unsafe extern "C" fn(run: *mut c_void, states: *mut f64, rates: *mut f64, sink: Sink) -> usize,
    snapshot: unsafe extern "C" fn(run: *mut c_void, sink: Sink),
}

/// Why a call failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Failure {
    /// The mechanism cannot start or go on.
    Simulation(SimulationError),
    /// A fault of ours, with what is known of it.
    Panic(String),
}
