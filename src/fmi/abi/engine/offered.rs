//! The engine that this library provides to another library.

use super::super::panic_guard::guarded;
use super::{Bytes, Failure, Reading, Sink, Table};
use crate::fmi::slave::engine::{Run, Stops};
use crate::model::signals::{Inputs, Outputs};
use crate::simulation::{ContactReport, Side, Simulation, SimulationError, step_map};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::ffi::c_void;
use std::ptr::null_mut;

/// The functions of this library.
pub const TABLE: Table = Table {
    start,
    restore,
    step_map,
    free,
    time,
    set_inputs,
    advance,
    look,
    read,
    contacts,
    write_states,
    place,
    snapshot,
};

/// Exported only by the build for newer processors. Importers load the other build, which does not export this
/// function.
#[cfg(target_feature = "fma")]
mod export {
    use super::super::Table;
    use super::TABLE;
    use crate::model::signals::Outputs;
    use crate::scene::parameter::DECLARATION;
    use std::ptr::null;

    static OFFERED: Table = TABLE;

    #[unsafe(no_mangle)]
    unsafe extern "C" fn slidercrank_engine(declaration: *const u8, outputs: usize) -> *const Table {
        // SAFETY: the caller guarantees this number of bytes.
        let declaration = unsafe { std::slice::from_raw_parts(declaration, DECLARATION.len()) };
        if declaration == DECLARATION && outputs == size_of::<Outputs>() { &raw const OFFERED } else { null() }
    }
}

unsafe extern "C" fn start(scene: Bytes, inputs: *const Inputs, sink: Sink) -> *mut c_void {
    // SAFETY: the caller lends bytes and inputs for this call.
    let (scene, inputs) = unsafe { (scene.borrow(), *inputs) };
    let run = attempt(sink, || Simulation::start(&decoded(scene)?, inputs).map(Box::new));
    run.map_or(null_mut(), |run| Box::into_raw(run).cast())
}

unsafe extern "C" fn restore(scene: Bytes, snapshot: Bytes, sink: Sink) -> *mut c_void {
    // SAFETY: the caller lends bytes for this call.
    let (scene, snapshot) = unsafe { (scene.borrow(), snapshot.borrow()) };
    let run = attempt(sink, || Simulation::restore(&decoded(scene)?, &decoded(snapshot)?).map(Box::new));
    run.map_or(null_mut(), |run| Box::into_raw(run).cast())
}

unsafe extern "C" fn step_map(
    scene: Bytes,
    snapshot: Bytes,
    request: Bytes,
    outputs: *mut Outputs,
    count: usize,
    sink: Sink,
) {
    // SAFETY: the caller lends bytes for this call.
    let (scene, snapshot, request) = unsafe { (scene.borrow(), snapshot.borrow(), request.borrow()) };
    // SAFETY: the caller lends this many places for outputs, whose pointer comes from a slice, for this call.
    let outputs = unsafe { std::slice::from_raw_parts_mut(outputs, count) };
    let found =
        attempt(sink, || step_map::step_map(&decoded(scene)?, &decoded(snapshot)?, &decoded(request)?, outputs));
    if let Some(found) = found {
        sink.send(&Ok::<_, Failure>(found));
    }
}

unsafe extern "C" fn free(run: *mut c_void) {
    // SAFETY: the caller gives back what `start` or `restore` made.
    let run = unsafe { Box::from_raw(run.cast::<Simulation>()) };
    // A panic in a destructor leaks memory at worst.
    let _ = guarded(|| drop(run));
}

unsafe extern "C" fn time(run: *mut c_void) -> f64 {
    // SAFETY: a live run, in no other call.
    unsafe { lent(run) }.time()
}

unsafe extern "C" fn set_inputs(run: *mut c_void, inputs: *const Inputs, rates: *const Inputs, sink: Sink) {
    // SAFETY: a live run, in no other call; the caller lends inputs for this one.
    let (run, inputs, rates) = unsafe { (lent(run), *inputs, *rates) };
    attempt(sink, || {
        run.set_inputs(inputs, rates);
        Ok(())
    });
}

unsafe extern "C" fn advance(run: *mut c_void, time: f64, stops: Stops, sink: Sink) -> bool {
    // SAFETY: a live run, in no other call.
    let run = unsafe { lent(run) };
    attempt(sink, || Run::advance(run, time, stops)).unwrap_or_default()
}

unsafe extern "C" fn look(run: *mut c_void, side: Side, sink: Sink) {
    // SAFETY: a live run, in no other call.
    let run = unsafe { lent(run) };
    attempt(sink, || {
        run.look(side);
        Ok(())
    });
}

unsafe extern "C" fn read(run: *mut c_void, what: Reading, seed: *const Inputs, outputs: *mut Outputs, sink: Sink) {
    // SAFETY: a live run, in no other call; the caller lends inputs and a place for outputs for this one.
    let (run, seed, outputs) = unsafe { (lent(run), *seed, &mut *outputs) };
    attempt(sink, || {
        *outputs = match what {
            Reading::Values => run.outputs(),
            Reading::Rates => run.output_rates(),
            Reading::Sensitivity => run.output_sensitivity(seed),
        };
        Ok(())
    });
}

unsafe extern "C" fn contacts(run: *mut c_void, report: *mut ContactReport, sink: Sink) {
    // SAFETY: a live run, in no other call; the caller lends a place for the report for this one.
    let (run, report) = unsafe { (lent(run), &mut *report) };
    attempt(sink, || {
        *report = run.contacts();
        Ok(())
    });
}

unsafe extern "C" fn write_states(run: *mut c_void, states: *mut f64, rates: *mut f64, sink: Sink) -> usize {
    // SAFETY: a live run, in no other call; the caller lends two arrays of this length for this one.
    let (run, states, rates) = unsafe { (lent(run), &mut *states.cast(), &mut *rates.cast()) };
    attempt(sink, || Ok(run.write_states(states, rates))).unwrap_or_default()
}

unsafe extern "C" fn place(run: *mut c_void, phase: Bytes, sink: Sink) {
    // SAFETY: a live run, in no other call; the caller lends bytes for this one.
    let (run, phase) = unsafe { (lent(run), phase.borrow()) };
    attempt(sink, || {
        run.place(&decoded(phase)?);
        Ok(())
    });
}

unsafe extern "C" fn snapshot(run: *mut c_void, sink: Sink) {
    // SAFETY: a live run, in no other call.
    let run = unsafe { lent(run) };
    if let Some(snapshot) = attempt(sink, || Ok(run.snapshot())) {
        sink.send(&Ok::<_, Failure>(snapshot));
    }
}

/// Runs a body. Errors and panics are passed to the sink.
pub fn attempt<T>(sink: Sink, body: impl FnOnce() -> Result<T, SimulationError>) -> Option<T> {
    let outcome = guarded(body).map_err(Failure::Panic).and_then(|outcome| outcome.map_err(Failure::Simulation));
    outcome.map_err(|failure| sink.send(&Err::<(), _>(failure))).ok()
}

fn decoded<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, SimulationError> {
    postcard::from_bytes(bytes).map_err(|error| SimulationError::Snapshot(error.to_string()))
}

/// # Safety
/// A live run, in no other call.
unsafe fn lent<'a>(run: *mut c_void) -> &'a mut Simulation {
    // SAFETY: `start` or `restore` made it; the caller makes no other call on it.
    unsafe { &mut *run.cast::<Simulation>() }
}

impl Bytes {
    /// # Safety
    /// The bytes are lent for `'a`.
    pub(super) unsafe fn borrow<'a>(self) -> &'a [u8] {
        // SAFETY: guaranteed by the caller; the pointer comes from a slice and is never NULL.
        unsafe { std::slice::from_raw_parts(self.data, self.length) }
    }
}

impl Sink {
    fn send(self, message: &impl Serialize) {
        // If writing fails, there are no bytes, which the receiver treats as an internal error.
        let bytes = postcard::to_allocvec(message).unwrap_or_default();
        // SAFETY: the sink is the caller's for this call; it copies the bytes.
        unsafe { (self.take)(self.context, Bytes { data: bytes.as_ptr(), length: bytes.len() }) }
    }
}
