//! FMI 2.0 as the campaigns see it.

use crate::estimators::{Estimated, estimated};
use crate::exchanged::{self, Exchanged, status};
use crate::face::{Answer, Face, Handle, Pieces};
use host::Slave;
use host::log::Line;
use slidercrank::fmi::slave::{Interface, ValueType};
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::fmu_state::FmuState;
use slidercrank::fmi::v2::lifecycle::{Call, State};
use slidercrank::simulation::Snapshot;
use std::cell::Cell;
use std::ops::Deref;

/// Co-simulation.
pub struct Stepping(pub Slave);

/// Model exchange.
pub struct Exchange {
    slave: Slave,
    /// [s] Where the importer is.
    time: Cell<f64>,
}

impl Deref for Stepping {
    type Target = Slave;

    fn deref(&self) -> &Slave {
        &self.0
    }
}

impl Deref for Exchange {
    type Target = Slave;

    fn deref(&self) -> &Slave {
        &self.slave
    }
}

impl Pieces for FmuState {
    const PIECES: usize = 6;

    fn with(mut self, piece: usize, other: &Self) -> Self {
        match piece {
            0 => self.state = other.state,
            1 => self.settings.scene = other.settings.scene.clone(),
            2 => {
                self.settings.experiment = other.settings.experiment;
                self.settings.tolerance_set = other.settings.tolerance_set;
            }
            3 => self.settings.inputs = other.settings.inputs,
            4 => (self.last_step, self.dead_end) = (other.last_step, other.dead_end),
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

    fn everywhere(&self, _events: bool) -> Vec<(Self, bool, bool)> {
        let exchange = self.state.interface() == Some(Interface::ModelExchange);
        let every = State::ALL.into_iter().map(|state| {
            let young = matches!(state, State::Instantiated | State::InitializationMode);
            let other = if exchange { Interface::CoSimulation } else { Interface::ModelExchange };
            let possible = self.snapshot.is_none() == young
                && Call::GetFMUstate.allowed(state)
                && state.interface() != Some(other);
            let ended = !young && !matches!(state, State::StepComplete | State::EventMode | State::ContinuousTimeMode);
            (Self { state, ..self.clone() }, possible, ended)
        });
        every.collect()
    }
}

fn set_one(slave: &Slave, of: ValueType, reference: u32, value: f64) -> Status {
    let (api, c) = (&slave.api, slave.c);
    // SAFETY: live component, arrays of one entry.
    unsafe {
        match of {
            ValueType::Real => (api.SetReal)(c, &reference, 1, &value),
            ValueType::Integer | ValueType::Enumeration => (api.SetInteger)(c, &reference, 1, &(value as i32)),
            ValueType::Boolean => (api.SetBoolean)(c, &reference, 1, &(value as i32)),
        }
    }
}

fn get_one(slave: &Slave, of: ValueType, reference: u32) -> Answer {
    let (api, c) = (&slave.api, slave.c);
    let (mut real, mut integer) = (f64::NAN, i32::MIN);
    // SAFETY: live component, arrays of one entry.
    let status = unsafe {
        match of {
            ValueType::Real => (api.GetReal)(c, &reference, 1, &mut real),
            ValueType::Integer | ValueType::Enumeration => (api.GetInteger)(c, &reference, 1, &mut integer),
            ValueType::Boolean => (api.GetBoolean)(c, &reference, 1, &mut integer),
        }
    };
    match (status, of) {
        (Status::Ok, ValueType::Real) => Ok(real),
        (Status::Ok, _) => Ok(f64::from(integer)),
        _ => Err(status),
    }
}

fn sensitivity(slave: &Slave, unknown: u32, knowns: &[u32], seeds: &[f64]) -> Answer {
    let (references, count, mut answer) = (knowns.as_ptr(), knowns.len(), f64::NAN);
    // SAFETY: live component, arrays of the lengths said.
    let status = unsafe {
        (slave.api.GetDirectionalDerivative)(slave.c, &unknown, 1, references, count, seeds.as_ptr(), &mut answer)
    };
    if status == Status::Ok { Ok(answer) } else { Err(status) }
}

/// What both kinds of interface have from the slave.
macro_rules! from_slave {
    () => {
        type Content = FmuState;
        const DESERIALIZE: &str = "fmi2DeSerializeFMUstate";
        const FAILED: Status = Status::Discard;

        fn enter_from(&self, start: f64) -> Status {
            assert_eq!(self.setup_raw(0, 0.0, start, 0, 0.0), Status::Ok);
            self.enter()
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

        fn estimated(&self) -> Estimated {
            estimated!(self.c, v2: slidercrank_phase_names slidercrank_step_jacobian slidercrank_set_phase)
        }

        fn save_into(&self, state: &mut Handle) -> Status {
            (**self).save_into(state)
        }

        fn restore(&self, state: Handle) -> Status {
            self.set_state(state)
        }

        fn forget(&self, state: &mut Handle) -> Status {
            self.free(state)
        }

        fn bytes(&self, state: Handle) -> Vec<u8> {
            self.bytes_of(state)
        }

        fn deserialize(&self, bytes: &[u8]) -> Result<Handle, Status> {
            (**self).deserialize(bytes)
        }

        fn lines(&self) -> Vec<Line> {
            self.log.take()
        }
    };
}

impl Face for Stepping {
    from_slave!();

    const ONE_IN: usize = 1;

    fn new() -> Self {
        Self(Slave::new())
    }

    fn begin(&self) -> Status {
        self.exit()
    }

    fn press_on(&self) -> Vec<Status> {
        vec![self.enter(), self.exit()]
    }

    fn set_slope(&self, name: &str, slope: f64) -> Option<Status> {
        Some(self.set_rate(name, 1, slope))
    }

    fn rate(&self, name: &str) -> Answer {
        (**self).rate(name, 1)
    }

    fn time(&self) -> Answer {
        let mut time = f64::NAN;
        // SAFETY: live component, one place.
        let status = unsafe { (self.api.GetRealStatus)(self.c, 2, &mut time) };
        if status == Status::Ok { Ok(time) } else { Err(status) }
    }

    fn step(&self, point: f64, size: f64) -> Status {
        (**self).step(point, size)
    }

    fn blunders(&self, point: f64) -> Vec<Status> {
        vec![
            self.step(point, -1.0),
            self.step(point + 1.0, 1e-3),
            self.set("slider.load", f64::NAN),
            self.set("rod.length", 1.0),
            self.set_rate("slider.x", 1, 1.0),
            self.exit(),
            self.enter_event_mode(),
            self.set_time(0.0),
        ]
    }
}

impl Face for Exchange {
    from_slave!();

    const INTERFACE: Interface = Interface::ModelExchange;

    fn new() -> Self {
        Self { slave: Slave::exchanging(), time: Cell::new(0.0) }
    }

    fn begin(&self) -> Status {
        match self.exit() {
            Status::Ok => status(exchanged::handle_event(self)),
            other => other,
        }
    }

    fn press_on(&self) -> Vec<Status> {
        let [update, go] = [self.update().map(drop), self.enter_continuous_time_mode()].map(status);
        vec![self.enter(), self.exit(), update, go]
    }

    fn rate(&self, name: &str) -> Answer {
        // There is no such function; the outputs' rates are those of their states.
        self.try_get(name)
    }

    fn others(&self, show: &mut dyn FnMut(&str, Answer)) {
        exchanged::show_numbers(self, show);
    }

    fn time(&self) -> Answer {
        Ok(self.time.get())
    }

    fn step(&self, point: f64, size: f64) -> Status {
        status(exchanged::step(self, point, size))
    }

    fn pace() -> f64 {
        exchanged::pace()
    }

    fn blunders(&self, point: f64) -> Vec<Status> {
        vec![
            (**self).step(point, 1e-3),
            self.set("slider.load", f64::NAN),
            self.set("rod.length", 1.0),
            status(Exchanged::set_time(self, f64::NAN)),
            status(self.write_states(&vec![f64::INFINITY; exchanged::counts().0 + 1])),
            self.exit(),
        ]
    }
}

fn outcome(status: Status) -> Result<(), Status> {
    if status == Status::Ok { Ok(()) } else { Err(status) }
}

impl Exchanged for Exchange {
    fn set_time(&self, time: f64) -> Result<(), Status> {
        outcome((**self).set_time(time)).map(|()| self.time.set(time))
    }

    fn read_states(&self, states: &mut [f64]) -> Result<(), Status> {
        // SAFETY: live component, array of the length said.
        outcome(unsafe { (self.api.GetContinuousStates)(self.c, states.as_mut_ptr(), states.len()) })
    }

    fn write_states(&self, states: &[f64]) -> Result<(), Status> {
        outcome(self.set_states(states))
    }

    fn read_derivatives(&self, derivatives: &mut [f64]) -> Result<(), Status> {
        // SAFETY: live component, array of the length said.
        outcome(unsafe { (self.api.GetDerivatives)(self.c, derivatives.as_mut_ptr(), derivatives.len()) })
    }

    fn read_indicators(&self, indicators: &mut [f64]) -> Result<(), Status> {
        // SAFETY: live component, array of the length said.
        outcome(unsafe { (self.api.GetEventIndicators)(self.c, indicators.as_mut_ptr(), indicators.len()) })
    }

    fn read_nominals(&self, nominals: &mut [f64]) -> Result<(), Status> {
        // SAFETY: live component, array of the length said.
        outcome(unsafe { (self.api.GetNominalsOfContinuousStates)(self.c, nominals.as_mut_ptr(), nominals.len()) })
    }

    fn completed(&self) -> Result<bool, Status> {
        let (mut enter, mut over) = (-1, -1);
        // SAFETY: live component, two places.
        outcome(unsafe { (self.api.CompletedIntegratorStep)(self.c, 1, &mut enter, &mut over) })?;
        Ok(enter != 0)
    }

    fn enter_event_mode(&self) -> Result<(), Status> {
        outcome((**self).enter_event_mode())
    }

    fn update(&self) -> Result<[bool; 2], Status> {
        let info = self.try_new_discrete_states()?;
        Ok([info.new_discrete_states_needed != 0, info.terminate_simulation != 0])
    }

    fn enter_continuous_time_mode(&self) -> Result<(), Status> {
        outcome((**self).enter_continuous_time_mode())
    }
}
