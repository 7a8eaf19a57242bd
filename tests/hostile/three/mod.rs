//! FMI 3.0 as the campaigns see it, and campaigns of its own.

pub mod arguments;
mod concurrency;
mod instantiate;
pub mod invoke;
mod orders;
mod product;
mod references;
mod reload;
pub mod stage;

use crate::estimators::{Estimated, estimated};
use crate::exchanged::{self, Exchanged, status};
use crate::face::{Answer, Face, Handle, Pieces};
use crate::importer::{self, Callback, Options, Slave, vr};
use host::log::Line;
use slidercrank::fmi::slave::{Interface, ValueType};
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::*;
use slidercrank::fmi::v3::fmu_state::FmuState;
use slidercrank::fmi::v3::lifecycle::{Call, State};
use slidercrank::fmi::v3::variables::time_reference;
use slidercrank::model_description::arrays::PENETRATIONS;
use slidercrank::model_description::clocks::FIRST_CLOCK;
use slidercrank::model_description::exchange::FIRST_INDICATOR;
use slidercrank::simulation::{CONTACTS, Snapshot};
use std::ops::Deref;

/// Co-simulation without event mode.
pub struct Stepping(Slave);

/// Co-simulation with event mode, early return and intermediate updates.
pub struct Events(Slave);

/// Model exchange.
pub struct Exchange(Slave);

/// Events in one step of a host that handles them.
const PATIENCE: usize = 50;

impl Pieces for FmuState {
    const PIECES: usize = 7;

    fn with(mut self, piece: usize, other: &Self) -> Self {
        match piece {
            0 => self.state = other.state,
            1 => self.settings.scene = other.settings.scene.clone(),
            2 => {
                self.settings.experiment = other.settings.experiment;
                self.settings.tolerance_set = other.settings.tolerance_set;
            }
            3 => self.settings.inputs = other.settings.inputs,
            4 => self.before_event = other.before_event,
            5 => self.interface = other.interface,
            _ => self.snapshot = other.snapshot.clone(),
        }
        self
    }

    fn snapshot(&self) -> &Option<Snapshot> {
        &self.snapshot
    }

    fn set_snapshot(&mut self, snapshot: Snapshot) {
        self.snapshot = Some(snapshot);
    }

    fn everywhere(&self, events: bool) -> Vec<(Self, bool, bool)> {
        let every = State::ALL.into_iter().map(|state| {
            let young = matches!(state, State::Instantiated | State::InitializationMode);
            let possible = self.snapshot.is_none() == young
                && Call::GetFMUState.allowed(state)
                && state.interface().is_none_or(|interface| interface == self.interface)
                && (state != State::EventPending || self.before_event)
                && (events || !matches!(state, State::EventMode | State::EventPending));
            (Self { state, ..self.clone() }, possible, state == State::Terminated)
        });
        every.collect()
    }
}

fn outcome(status: Status) -> Result<(), Status> {
    if status == Status::Ok { Ok(()) } else { Err(status) }
}

fn set_one(slave: &Slave, of: ValueType, reference: u32, value: f64) -> Status {
    // SAFETY: live instance, arrays of one entry.
    unsafe {
        match of {
            ValueType::Real => fmi3SetFloat64(slave.0, &reference, 1, &value, 1),
            ValueType::Integer => fmi3SetInt32(slave.0, &reference, 1, &(value as i32), 1),
            ValueType::Enumeration => fmi3SetInt64(slave.0, &reference, 1, &(value as i64), 1),
            ValueType::Boolean => fmi3SetBoolean(slave.0, &reference, 1, &(value as u8), 1),
        }
    }
}

fn get_one(slave: &Slave, of: ValueType, reference: u32) -> Answer {
    let (mut real, mut integer, mut item, mut truth) = (f64::NAN, i32::MIN, i64::MIN, 7);
    // SAFETY: live instance, arrays of one entry.
    let status = unsafe {
        match of {
            ValueType::Real => fmi3GetFloat64(slave.0, &reference, 1, &mut real, 1),
            ValueType::Integer => fmi3GetInt32(slave.0, &reference, 1, &mut integer, 1),
            ValueType::Enumeration => fmi3GetInt64(slave.0, &reference, 1, &mut item, 1),
            ValueType::Boolean => fmi3GetBoolean(slave.0, &reference, 1, &mut truth, 1),
        }
    };
    outcome(status).map(|()| match of {
        ValueType::Real => real,
        ValueType::Integer => f64::from(integer),
        ValueType::Enumeration => item as f64,
        ValueType::Boolean => f64::from(truth),
    })
}

fn sensitivity(slave: &Slave, unknown: u32, knowns: &[u32], seeds: &[f64]) -> Answer {
    let (references, count, mut answer) = (knowns.as_ptr(), knowns.len(), f64::NAN);
    // SAFETY: live instance, arrays of the lengths said.
    let status = unsafe {
        fmi3GetDirectionalDerivative(
            slave.0,
            &unknown,
            1,
            references,
            count,
            seeds.as_ptr(),
            seeds.len(),
            &mut answer,
            1,
        )
    };
    outcome(status).map(|()| answer)
}

/// Shows numbers of both kinds of interface that are not variables of FMI 2.0.
fn show_others(slave: &Slave, show: &mut dyn FnMut(&str, Answer)) {
    show("time", slave.try_get_reference(time_reference()));
    let mut depths = [f64::NAN; 4];
    // SAFETY: live instance, an array of the length said.
    let status = unsafe { fmi3GetFloat64(slave.0, &PENETRATIONS, 1, depths.as_mut_ptr(), depths.len()) };
    show("corner", outcome(status).map(|()| depths.iter().sum()));
    let (unknown, known, seed, mut adjoint) = (vr("slider.a"), vr("slider.load"), 2.0, f64::NAN);
    // SAFETY: live instance, arrays of one entry.
    let status = unsafe { fmi3GetAdjointDerivative(slave.0, &unknown, 1, &known, 1, &seed, 1, &mut adjoint, 1) };
    show("slider.a", outcome(status).map(|()| adjoint));
    for contact in 0..CONTACTS as u32 {
        let clock = slave.try_clocks(&[FIRST_CLOCK + contact]);
        show("clock", clock.map(|ticks| f64::from(u8::from(ticks[0]))));
        show("event indicator", slave.try_get_reference(FIRST_INDICATOR + contact));
    }
}

/// What all kinds of interface have from the slave.
macro_rules! from_slave {
    ($kind:ident) => {
        type Content = FmuState;
        const DESERIALIZE: &str = "fmi3DeserializeFMUState";
        const FAILED: Status = Status::Error;

        fn enter_from(&self, start: f64) -> Status {
            self.enter_with(None, start, None)
        }

        fn reset(&self) -> Status {
            (**self).reset()
        }

        fn set_one(&self, of: ValueType, reference: u32, value: f64) -> Status {
            set_one(self, of, reference, value)
        }

        fn get_one(&self, of: ValueType, reference: u32) -> Answer {
            get_one(self, of, reference)
        }

        fn sensitivity(&self, unknown: u32, knowns: &[u32], seeds: &[f64]) -> Answer {
            sensitivity(self, unknown, knowns, seeds)
        }

        fn time(&self) -> Answer {
            self.try_get_reference(time_reference())
        }

        fn estimated(&self) -> Estimated {
            estimated!(self.0.0, v3: slidercrank_fmi3_phase_names slidercrank_fmi3_step_jacobian slidercrank_fmi3_set_phase)
        }

        fn save_into(&self, state: &mut Handle) -> Status {
            // SAFETY: live instance, one place.
            unsafe { fmi3GetFMUState(self.0.0, state) }
        }

        fn restore(&self, state: Handle) -> Status {
            self.set_state(state)
        }

        fn forget(&self, state: &mut Handle) -> Status {
            // SAFETY: live instance, one place.
            unsafe { fmi3FreeFMUState(self.0.0, state) }
        }

        fn bytes(&self, state: Handle) -> Vec<u8> {
            self.bytes_of(state)
        }

        fn deserialize(&self, bytes: &[u8]) -> Result<Handle, Status> {
            (**self).deserialize(bytes)
        }

        fn lines(&self) -> Vec<Line> {
            lines(self)
        }
    };
}

/// The log's lines since the last look.
pub fn lines(slave: &Slave) -> Vec<Line> {
    let line = |importer::Line { status, category, text }| Line { instance: "slave".into(), status, category, text };
    slave.lines().into_iter().map(line).collect()
}

/// What both kinds of co-simulation have from the slave.
macro_rules! steps {
    () => {
        fn rate(&self, name: &str) -> Answer {
            (**self).rate(name)
        }

        fn others(&self, show: &mut dyn FnMut(&str, Answer)) {
            show_others(self, show);
        }

        fn blunders(&self, point: f64) -> Vec<Status> {
            let stepped = |point, size| self.try_step(point, size).map_or_else(|status| status, |_| Status::Ok);
            vec![
                stepped(point, -1.0),
                stepped(point + 1.0, 1e-3),
                self.set("slider.load", f64::NAN),
                self.set("rod.length", 1.0),
                self.exit(),
                self.enter_continuous_time_mode(),
                (**self).set_time(0.0),
            ]
        }
    };
}

impl Face for Stepping {
    from_slave!(Stepping);
    steps!();

    const EVENTS: bool = false;

    fn new() -> Self {
        Self(Slave::new(Options { logging: true, ..Options::default() }))
    }

    fn begin(&self) -> Status {
        self.exit()
    }

    fn press_on(&self) -> Vec<Status> {
        vec![self.enter(), self.exit()]
    }

    fn step(&self, point: f64, size: f64) -> Status {
        self.try_step(point, size).map_or_else(|status| status, |_| Status::Ok)
    }
}

impl Face for Events {
    from_slave!(Events);
    steps!();

    fn new() -> Self {
        let update: Callback = Box::new(|slave, _, _| {
            assert!(slave.get("crank.torque").is_finite());
            None
        });
        Self(Slave::new(Options { intermediate: &["crank.torque"], update: Some(update), ..Options::EVENTS }))
    }

    fn begin(&self) -> Status {
        match self.exit() {
            Status::Ok => status(self.handle()),
            other => other,
        }
    }

    fn press_on(&self) -> Vec<Status> {
        vec![self.enter(), self.exit(), self.enter_event_mode(), self.update_discrete_states(), self.enter_step_mode()]
    }

    fn step(&self, point: f64, size: f64) -> Status {
        status(self.step_through(point, point + size))
    }
}

impl Events {
    /// From event mode on.
    fn handle(&self) -> Result<(), Status> {
        outcome(self.update_discrete_states())?;
        outcome(self.enter_step_mode())
    }

    /// Steps to `end` through events, as long as there are not too many of them: each call is short, but a mechanism at
    /// the ends of its ranges may have any number.
    fn step_through(&self, mut point: f64, end: f64) -> Result<(), Status> {
        for _ in 0..PATIENCE {
            let told = self.try_step(point, end - point)?;
            if told.event {
                outcome(self.enter_event_mode())?;
                self.handle()?;
            }
            point = told.time;
            if !told.early || point >= end {
                return Ok(());
            }
        }
        Err(Status::Discard)
    }
}

impl Face for Exchange {
    from_slave!(Exchange);

    const INTERFACE: Interface = Interface::ModelExchange;

    fn new() -> Self {
        Self(Slave::exchanging())
    }

    fn begin(&self) -> Status {
        match self.exit() {
            Status::Ok => status(exchanged::handle_event(self)),
            other => other,
        }
    }

    fn press_on(&self) -> Vec<Status> {
        let [update, go] = [self.update().map(drop), Exchanged::enter_continuous_time_mode(self)].map(status);
        vec![self.enter(), self.exit(), update, go]
    }

    fn rate(&self, name: &str) -> Answer {
        // There is no such function; the outputs' rates are those of their states.
        self.try_get(name)
    }

    fn others(&self, show: &mut dyn FnMut(&str, Answer)) {
        show_others(self, show);
        exchanged::show_numbers(self, show);
    }

    fn step(&self, point: f64, size: f64) -> Status {
        status(exchanged::step(self, point, size))
    }

    fn pace() -> f64 {
        exchanged::pace()
    }

    fn blunders(&self, point: f64) -> Vec<Status> {
        vec![
            self.try_step(point, 1e-3).map_or_else(|status| status, |_| Status::Ok),
            self.set("slider.load", f64::NAN),
            self.set("rod.length", 1.0),
            status(Exchanged::set_time(self, f64::NAN)),
            status(self.write_states(&vec![f64::INFINITY; exchanged::counts().0 + 1])),
            self.exit(),
            self.enter_step_mode(),
        ]
    }
}

impl Exchanged for Exchange {
    fn set_time(&self, time: f64) -> Result<(), Status> {
        outcome((**self).set_time(time))
    }

    fn read_states(&self, states: &mut [f64]) -> Result<(), Status> {
        // SAFETY: live instance, array of the length said.
        outcome(unsafe { fmi3GetContinuousStates(self.0.0, states.as_mut_ptr(), states.len()) })
    }

    fn write_states(&self, states: &[f64]) -> Result<(), Status> {
        // SAFETY: live instance, array of the length said.
        outcome(unsafe { fmi3SetContinuousStates(self.0.0, states.as_ptr(), states.len()) })
    }

    fn read_derivatives(&self, derivatives: &mut [f64]) -> Result<(), Status> {
        let (place, count) = (derivatives.as_mut_ptr(), derivatives.len());
        // SAFETY: live instance, array of the length said.
        outcome(unsafe { fmi3GetContinuousStateDerivatives(self.0.0, place, count) })
    }

    fn read_indicators(&self, indicators: &mut [f64]) -> Result<(), Status> {
        // SAFETY: live instance, array of the length said.
        outcome(unsafe { fmi3GetEventIndicators(self.0.0, indicators.as_mut_ptr(), indicators.len()) })
    }

    fn read_nominals(&self, nominals: &mut [f64]) -> Result<(), Status> {
        let (place, count) = (nominals.as_mut_ptr(), nominals.len());
        // SAFETY: live instance, array of the length said.
        outcome(unsafe { fmi3GetNominalsOfContinuousStates(self.0.0, place, count) })
    }

    fn completed(&self) -> Result<bool, Status> {
        let (mut enter, mut over) = (7, 7);
        // SAFETY: live instance, two places.
        outcome(unsafe { fmi3CompletedIntegratorStep(self.0.0, 1, &mut enter, &mut over) })?;
        Ok(enter != 0)
    }

    fn enter_event_mode(&self) -> Result<(), Status> {
        outcome((**self).enter_event_mode())
    }

    fn update(&self) -> Result<[bool; 2], Status> {
        let ([mut again, mut over, mut nominals, mut values, mut timed], mut time) = ([7; 5], f64::NAN);
        // SAFETY: live instance, six places.
        outcome(unsafe {
            fmi3UpdateDiscreteStates(self.0.0, &mut again, &mut over, &mut nominals, &mut values, &mut timed, &mut time)
        })?;
        Ok([again != 0, over != 0])
    }

    fn enter_continuous_time_mode(&self) -> Result<(), Status> {
        outcome((**self).enter_continuous_time_mode())
    }
}

/// The importer's methods; an instance may be used from any thread, one at a time.
macro_rules! importer {
    ($($kind:ident)+) => {
        $(
            impl Deref for $kind {
                type Target = Slave;

                fn deref(&self) -> &Slave {
                    &self.0
                }
            }

            // SAFETY: an instance may be used from any thread, one at a time, and its callback holds nothing.
            unsafe impl Send for $kind {}
        )+
    };
}

importer!(Stepping Events Exchange);
