//! An engine that another build of this library provides.

use super::super::dispatch_x86_64_v3::{Library, open};
use super::super::panic_guard::guarded;
use super::{Bytes, Failure, OFFER, Offer, Reading, Sink, Table};
use crate::fmi::slave::engine::{Engine, Run, Stops};
use crate::integrator::MAX_STATES;
use crate::model::signals::{Inputs, Outputs};
use crate::scene::Scene;
use crate::scene::parameter::DECLARATION;
use crate::simulation::step_map::{StepMap, StepRequest};
use crate::simulation::{ContactReport, Phase, Side, SimulationError, Snapshot};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::ffi::c_void;
use std::mem::transmute;
use std::ptr::NonNull;
use std::sync::OnceLock;

/// An engine from a table of functions.
#[derive(Clone, Copy)]
pub struct Borrowed {
    table: &'static Table,
}

/// The build for newer processors, if the processor can run it. It is searched once per process, at the first call.
pub fn newer() -> Option<&'static dyn Engine> {
    static NEWER: OnceLock<Option<Borrowed>> = OnceLock::new();
    let find = || guarded(|| Borrowed::of(&open()?)).ok().flatten();
    NEWER.get_or_init(find).as_ref().map(|engine| engine as &dyn Engine)
}

/// A run in the other library.
struct BorrowedRun {
    table: &'static Table,
    run: NonNull<c_void>,
}

// SAFETY: a run may be used from any thread, one at a time: it is a `Simulation`, which is `Send`.
unsafe impl Send for BorrowedRun {}

impl Borrowed {
    /// The engine with these functions.
    pub const fn from_table(table: &'static Table) -> Self {
        Self { table }
    }

    /// The engine of a library, if the library provides one for builds of the same sources.
    fn of(library: &Library) -> Option<Self> {
        let offer = library.find(OFFER)?;
        // SAFETY: a function of this name has this type.
        let offer = unsafe { transmute::<*const (), Offer>(offer) };
        // SAFETY: the digest has the required length; library and table exist until the process ends.
        let table = unsafe { offer(DECLARATION.as_ptr(), size_of::<Outputs>()).as_ref() }?;
        Some(Self::from_table(table))
    }

    fn run(self, run: *mut c_void, failure: Letter) -> Result<Box<dyn Run>, SimulationError> {
        failure.outcome()?;
        let run = NonNull::new(run).ok_or_else(|| SimulationError::Snapshot("the engine returned no run".into()))?;
        Ok(Box::new(BorrowedRun { table: self.table, run }))
    }
}

impl Engine for Borrowed {
    fn start(&self, scene: &Scene, inputs: Inputs) -> Result<Box<dyn Run>, SimulationError> {
        let (scene, mut letter) = (encoded(scene)?, Letter::default());
        // SAFETY: bytes, inputs and sink outlive the call.
        let run = unsafe { (self.table.start)(lend(&scene), &raw const inputs, letter.sink()) };
        self.run(run, letter)
    }

    fn restore(&self, scene: &Scene, snapshot: &Snapshot) -> Result<Box<dyn Run>, SimulationError> {
        let (scene, snapshot, mut letter) = (encoded(scene)?, encoded(snapshot)?, Letter::default());
        // SAFETY: bytes and sink outlive the call.
        let run = unsafe { (self.table.restore)(lend(&scene), lend(&snapshot), letter.sink()) };
        self.run(run, letter)
    }

    fn step_map(
        &self,
        scene: &Scene,
        snapshot: &Snapshot,
        request: &StepRequest,
        outputs: &mut [Outputs],
    ) -> Result<StepMap, SimulationError> {
        let (scene, snapshot, request) = (encoded(scene)?, encoded(snapshot)?, encoded(request)?);
        let mut letter = Letter::default();
        // SAFETY: bytes, places for outputs and sink outlive the call.
        unsafe {
            let (places, count) = (outputs.as_mut_ptr(), outputs.len());
            (self.table.step_map)(lend(&scene), lend(&snapshot), lend(&request), places, count, letter.sink());
        }
        letter.opened()
    }
}

impl BorrowedRun {
    fn read(&mut self, what: Reading, seed: Inputs) -> Outputs {
        let (mut outputs, mut letter) = (Outputs::default(), Letter::default());
        // SAFETY: a live run, lent to this call alone; inputs, place and sink outlive the call.
        unsafe {
            (self.table.read)(self.run.as_ptr(), what, &raw const seed, &raw mut outputs, letter.sink());
        }
        letter.infallible();
        outputs
    }
}

impl Run for BorrowedRun {
    fn time(&self) -> f64 {
        // SAFETY: a live run, lent to this call alone.
        unsafe { (self.table.time)(self.run.as_ptr()) }
    }

    fn set_inputs(&mut self, inputs: Inputs, rates: Inputs) {
        let mut letter = Letter::default();
        // SAFETY: a live run, lent to this call alone; inputs and sink outlive the call.
        unsafe {
            (self.table.set_inputs)(self.run.as_ptr(), &raw const inputs, &raw const rates, letter.sink());
        }
        letter.infallible();
    }

    fn advance(&mut self, time: f64, stops: Stops) -> Result<bool, SimulationError> {
        let mut letter = Letter::default();
        // SAFETY: a live run, lent to this call alone; the sink outlives the call.
        let event = unsafe { (self.table.advance)(self.run.as_ptr(), time, stops, letter.sink()) };
        letter.outcome()?;
        Ok(event)
    }

    fn look(&mut self, side: Side) {
        let mut letter = Letter::default();
        // SAFETY: a live run, lent to this call alone; the sink outlives the call.
        unsafe { (self.table.look)(self.run.as_ptr(), side, letter.sink()) };
        letter.infallible();
    }

    fn outputs(&mut self) -> Outputs {
        self.read(Reading::Values, Inputs::default())
    }

    fn output_rates(&mut self) -> Outputs {
        self.read(Reading::Rates, Inputs::default())
    }

    fn output_sensitivity(&mut self, seed: Inputs) -> Outputs {
        self.read(Reading::Sensitivity, seed)
    }

    fn contacts(&mut self) -> ContactReport {
        let (mut report, mut letter) = (ContactReport::default(), Letter::default());
        // SAFETY: a live run, lent to this call alone; place and sink outlive the call.
        unsafe { (self.table.contacts)(self.run.as_ptr(), &raw mut report, letter.sink()) };
        letter.infallible();
        report
    }

    fn write_states(&mut self, states: &mut [f64; MAX_STATES], rates: &mut [f64; MAX_STATES]) -> usize {
        let mut letter = Letter::default();
        // SAFETY: a live run, lent to this call alone; both arrays and the sink outlive the call.
        let count = unsafe {
            (self.table.write_states)(self.run.as_ptr(), states.as_mut_ptr(), rates.as_mut_ptr(), letter.sink())
        };
        letter.infallible();
        count.min(MAX_STATES)
    }

    fn place(&mut self, phase: &Phase) {
        let (phase, mut letter) = (encoded(phase).unwrap_or_else(fault), Letter::default());
        // SAFETY: a live run, lent to this call alone; bytes and sink outlive the call.
        unsafe { (self.table.place)(self.run.as_ptr(), lend(&phase), letter.sink()) };
        letter.infallible();
    }

    fn snapshot(&self) -> Snapshot {
        let mut letter = Letter::default();
        // SAFETY: a live run, lent to this call alone; the sink outlives the call.
        unsafe { (self.table.snapshot)(self.run.as_ptr(), letter.sink()) };
        letter.opened().unwrap_or_else(fault)
    }
}

impl Drop for BorrowedRun {
    fn drop(&mut self) {
        // SAFETY: a live run, which is not used again.
        unsafe { (self.table.free)(self.run.as_ptr()) }
    }
}

/// The message of the other library at the end of a call; empty without bytes.
#[derive(Default)]
struct Letter(Option<Vec<u8>>);

impl Letter {
    /// The sink that receives the message.
    fn sink(&mut self) -> Sink {
        unsafe extern "C" fn take(context: *mut c_void, bytes: Bytes) {
            // SAFETY: the context is the message below, and the bytes are lent for this call.
            let (letter, bytes) = unsafe { (&mut *context.cast::<Letter>(), bytes.borrow()) };
            letter.0 = Some(bytes.to_vec());
        }
        Sink { context: (&raw mut *self).cast(), take }
    }

    /// The content. A panic in the other library continues as a panic here, which the call from C catches.
    fn opened<T: DeserializeOwned>(self) -> Result<T, SimulationError> {
        match postcard::from_bytes::<Result<T, Failure>>(&self.0.unwrap_or_default()) {
            Ok(Ok(content)) => Ok(content),
            Ok(Err(Failure::Simulation(error))) => Err(error),
            Ok(Err(Failure::Panic(text))) => std::panic::resume_unwind(Box::new(text)),
            Err(error) => std::panic::resume_unwind(Box::new(format!("the engine's message cannot be read: {error}"))),
        }
    }

    /// Whether there is no message.
    fn outcome(self) -> Result<(), SimulationError> {
        if self.0.is_none() { Ok(()) } else { self.opened() }
    }

    /// Checks that there is no message.
    fn infallible(self) {
        self.outcome().unwrap_or_else(fault);
    }
}

fn fault<T>(error: SimulationError) -> T {
    std::panic::resume_unwind(Box::new(format!("the engine: {error}")))
}

fn encoded(data: &impl Serialize) -> Result<Vec<u8>, SimulationError> {
    postcard::to_allocvec(data).map_err(|error| SimulationError::Snapshot(error.to_string()))
}

fn lend(bytes: &[u8]) -> Bytes {
    Bytes { data: bytes.as_ptr(), length: bytes.len() }
}
