//! An [`Engine`](crate::fmi::slave::engine::Engine) across two libraries: a table of C functions.
//!
//! Both libraries are builds of the same sources and have the same scenes, outputs and errors, but each has its own
//! memory and its own panics. Inputs and outputs are passed as C structures, everything else as bytes that the receiver
//! copies before the call returns. Errors and panics are returned as a `Failure`.
//!
//! [`offered`] is the table of this library, [`borrowed`] is an engine from the table of another library.

pub mod borrowed;
pub mod offered;

use crate::fmi::slave::engine::Stops;
use crate::model::signals::{Inputs, Outputs};
use crate::simulation::{ContactReport, Side, SimulationError};
use serde::{Deserialize, Serialize};
use std::ffi::c_void;

/// Name of the function that returns a library's table: an [`Offer`].
pub const OFFER: &str = "slidercrank_engine";

/// Returns the table, or NULL if the caller is built from other sources. `declaration` is the digest of its variables,
/// 32 bytes, and `outputs` the size of its [`Outputs`].
pub type Offer = unsafe extern "C" fn(declaration: *const u8, outputs: usize) -> *const Table;

/// Bytes that are lent for one call.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Bytes {
    data: *const u8,
    length: usize,
}

/// Receives bytes during one call.
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
    /// The values of outputs.
    Values,
    /// The first time derivatives of outputs.
    Rates,
    /// The derivatives of outputs along a direction of the inputs.
    Sensitivity,
}

/// The functions that another library calls. A run is a pointer from `start` or `restore` that has not been passed to
/// `free`; it is used in one call at a time. The sinks of `step_map` and `snapshot` receive a result or a failure, the
/// sinks of other functions receive a failure if there is one. A run that cannot be started is NULL.
#[repr(C)]
pub struct Table {
    /// Starts a run.
    pub start: unsafe extern "C" fn(scene: Bytes, inputs: *const Inputs, sink: Sink) -> *mut c_void,
    /// Starts a run where a snapshot was taken.
    pub restore: unsafe extern "C" fn(scene: Bytes, snapshot: Bytes, sink: Sink) -> *mut c_void,
    /// Computes the map of a step from a snapshot; writes `count` sets of outputs.
    pub step_map: unsafe extern "C" fn(
        scene: Bytes,
        snapshot: Bytes,
        request: Bytes,
        outputs: *mut Outputs,
        count: usize,
        sink: Sink,
    ),
    /// Ends a run.
    pub free: unsafe extern "C" fn(run: *mut c_void),
    /// The time that a run has reached.
    pub time: unsafe extern "C" fn(run: *mut c_void) -> f64,
    /// Sets the inputs and their rates.
    pub set_inputs: unsafe extern "C" fn(run: *mut c_void, inputs: *const Inputs, rates: *const Inputs, sink: Sink),
    /// Returns whether a contact has closed or opened at the end.
    pub advance: unsafe extern "C" fn(run: *mut c_void, time: f64, stops: Stops, sink: Sink) -> bool,
    /// Chooses the side of an event that outputs are read on.
    pub look: unsafe extern "C" fn(run: *mut c_void, side: Side, sink: Sink),
    /// Writes outputs.
    pub read:
        unsafe extern "C" fn(run: *mut c_void, what: Reading, seed: *const Inputs, outputs: *mut Outputs, sink: Sink),
    /// Writes what the contacts are doing.
    pub contacts: unsafe extern "C" fn(run: *mut c_void, report: *mut ContactReport, sink: Sink),
    /// Writes states and rates, each of which have room for `MAX_STATES`, and returns their number.
    pub write_states: unsafe extern "C" fn(run: *mut c_void, states: *mut f64, rates: *mut f64, sink: Sink) -> usize,
    /// Continues from another point of phase space.
    pub place: unsafe extern "C" fn(run: *mut c_void, phase: Bytes, sink: Sink),
    /// Takes a snapshot.
    pub snapshot: unsafe extern "C" fn(run: *mut c_void, sink: Sink),
}

/// The reason why a call failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Failure {
    /// The mechanism cannot start or go on.
    Simulation(SimulationError),
    /// An internal error, with its message.
    Panic(String),
}
