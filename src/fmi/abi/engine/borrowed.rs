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
    /// The engine of a library, if the library provides one for builds of the same sources.
    fn of(library: &Library) -> Option<Self> {
        let offer = library.find(OFFER)?;
        // SAFETY: a function of this name has this type.
        let offer = unsafe { transmute::<*const (), Offer>(offer) };
        // SAFETY: the digest has the required length; library and table exist until the process ends.
        let table = unsafe { offer(DECLARATION.as_ptr(), size_of::<Outputs>()).as_ref() }?;
        Some(Self { table })
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

#[cfg(test)]
#[allow(clippy::panic, reason = "a fault on purpose")]
mod tests {
    use super::super::offered::TABLE;
    use super::*;
    use crate::fmi::slave::engine::Own;
    use crate::scene::JointModel;
    use crate::simulation::step_map::{By, PhaseNumbers};

    /// This library as the engine of another library.
    const ACROSS: Borrowed = Borrowed { table: &TABLE };

    fn worn() -> Scene {
        let mut scene = Scene::default();
        scene.joint.c.model = JointModel::Clearance;
        scene.crank.speed_start = 500.0;
        scene
    }

    /// All results of a run, after some steps with changing inputs.
    fn course(engine: &dyn Engine) -> (Vec<Outputs>, Snapshot) {
        let mut run = engine.start(&worn(), Inputs::default()).expect("a start");
        let mut seen = vec![run.outputs()];
        for point in 1..=20 {
            let inputs = Inputs { crank_torque: f64::from(point), slider_load: -2.0 };
            run.set_inputs(inputs, Inputs { crank_torque: 3.0, slider_load: 0.0 });
            let end = f64::from(point) * 1e-3;
            while run.time() < end {
                let event = run.advance(end, Stops::Events).expect("a step");
                assert!(event || run.time() == end);
                run.look(Side::Before);
                seen.push(run.outputs());
                run.look(Side::After);
            }
            seen.extend([run.outputs(), run.output_rates(), run.output_sensitivity(inputs)]);
        }
        assert_eq!(run.time(), 20.0 * 1e-3);
        (seen, run.snapshot())
    }

    #[test]
    fn a_run_across_the_border_is_the_same_run() {
        assert_eq!(course(&ACROSS), course(&Own));
    }

    #[test]
    fn a_snapshot_is_the_same_for_every_engine() {
        let (_, snapshot) = course(&Own);
        let ends = [&ACROSS as &dyn Engine, &Own].map(|engine| {
            let mut run = engine.restore(&worn(), &snapshot).expect("its own snapshot");
            run.advance(0.03, Stops::Steps).expect("a step");
            (run.outputs(), run.snapshot())
        });
        assert_eq!(ends[0], ends[1]);
    }

    #[test]
    fn a_step_map_and_a_placed_phase_are_the_same_across_the_border() {
        let (_, snapshot) = course(&Own);
        let by = vec![By::Parameter("joint.C.clearance".into()), By::SliderLoad];
        let request = StepRequest { end: 0.0205, derivatives: true, by };
        let numbers = PhaseNumbers::of(&worn());
        let found = [&ACROSS as &dyn Engine, &Own].map(|engine| {
            let mut outputs = vec![Outputs::default(); request.output_sets(&numbers)];
            let map = engine.step_map(&worn(), &snapshot, &request, &mut outputs).expect("no grazing");
            let mut run = engine.restore(&worn(), &snapshot).expect("its own snapshot");
            run.place(&numbers.phase(run.time(), &map.next));
            (map, outputs, run.outputs(), run.snapshot())
        });
        assert_eq!(found[0], found[1]);
        let (map, outputs, ..) = &found[0];
        assert!(map.jacobian.len() == numbers.count() && outputs.last().is_some_and(|last| last.slider.v != 0.0));
        let wrong = StepRequest { by: vec![By::Parameter("solver.method".into())], ..request };
        let error = |engine: &dyn Engine| engine.step_map(&worn(), &snapshot, &wrong, &mut [Outputs::default()]);
        assert_eq!(error(&ACROSS), error(&Own));
    }

    #[test]
    fn errors_cross_the_border_as_they_are() {
        let error = |engine: &dyn Engine, edit: fn(&mut Scene)| {
            let mut scene = worn();
            edit(&mut scene);
            engine.start(&scene, Inputs::default()).map(drop).expect_err("no start")
        };
        for edit in [
            |scene: &mut Scene| scene.guide.offset = 0.3,
            |scene: &mut Scene| {
                scene.solver.method = crate::scene::Method::Moreau;
                scene.energy.audit = true;
            },
        ] {
            assert_eq!(error(&ACROSS, edit), error(&Own, edit));
        }
        let broken = |engine: &dyn Engine| engine.restore(&worn(), &Snapshot::default()).map(drop).expect_err("no run");
        assert_eq!(broken(&ACROSS), broken(&Own));
        let lost = |engine: &dyn Engine| {
            let load = Inputs { crank_torque: 0.0, slider_load: 1e308 };
            let mut run = engine.start(&worn(), load).expect("a start");
            (run.advance(1.0, Stops::Nowhere).expect_err("no step"), run.time().to_bits())
        };
        assert_eq!(lost(&ACROSS), lost(&Own));
    }

    #[test]
    fn a_panic_crosses_the_border_as_a_panic() {
        unsafe extern "C" fn breaks(_: *mut c_void, _: f64, _: Stops, sink: Sink) -> bool {
            super::super::offered::attempt::<()>(sink, || std::panic::panic_any("a fault on purpose"));
            false
        }
        static BROKEN: Table = Table { advance: breaks, ..TABLE };
        let engine = Borrowed { table: &BROKEN };
        let mut run = engine.start(&worn(), Inputs::default()).expect("a start");
        let caught = guarded(|| run.advance(1.0, Stops::Nowhere));
        assert_eq!(caught, Err("a fault on purpose".into()));
    }
}
