//! Instances of FMI 2.0 in every state of the lifecycle.

use crate::arguments::{Argument, arguments};
use crate::importers_memory::ImportersMemory;
use crate::invoke::{Word, invoke};
use crate::product::Staged;
use host::Slave;
use host::log::Line;
use slidercrank::fmi::slave::Interface;
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::abi::types::fmi2FMUstate;
use slidercrank::fmi::v2::fmu_state::FmuState;
use slidercrank::fmi::v2::lifecycle::{Call, State};

/// Every state in which a call can meet an instance but the fatal one, which needs a fault of the library.
pub const STATES: [State; 9] = [
    State::Instantiated,
    State::InitializationMode,
    State::EventMode,
    State::ContinuousTimeMode,
    State::StepComplete,
    State::StepFailed,
    State::StepCanceled,
    State::Terminated,
    State::Error,
];

/// [s] Stop time of the experiment.
pub const STOP: f64 = 10.0;

/// An instance in some state.
pub struct Stage {
    pub slave: Slave,
    pub state: State,
    /// [s] Where it is.
    pub now: f64,
    /// A saved state of it, from when it was young.
    pub saved: fmi2FMUstate,
    /// A saved state of another instance.
    pub theirs: fmi2FMUstate,
    pub memory: ImportersMemory,
}

impl Stage {
    /// A new instance in this state, with inputs set where it takes some.
    pub fn reach(state: State, theirs: fmi2FMUstate) -> Self {
        let exchanging = state.interface() == Some(Interface::ModelExchange);
        let slave = if exchanging { Slave::exchanging() } else { Slave::new() };
        assert_eq!(slave.setup_raw(1, 1e-6, 0.0, 1, STOP), Status::Ok);
        if exchanging {
            assert_eq!(slave.set("crank.speed_start", 500.0), Status::Ok);
        } else {
            slave.wear();
        }
        // Away from the dead centre, where no load could turn the crank.
        assert_eq!(slave.set("crank.angle_start", 1.0), Status::Ok);
        let saved = slave.save();
        let mut stage = Self { slave, state, now: 0.0, saved, theirs, memory: ImportersMemory::default() };
        stage.lead();
        stage.slave.log.take();
        stage
    }

    fn lead(&mut self) {
        let slave = &self.slave;
        if self.state == State::Instantiated {
            return;
        }
        assert_eq!(slave.enter(), Status::Ok);
        if self.state == State::InitializationMode {
            return;
        }
        assert_eq!(slave.exit(), Status::Ok);
        if self.state == State::ContinuousTimeMode {
            assert_eq!(slave.enter_continuous_time_mode(), Status::Ok);
        }
        if matches!(self.state, State::EventMode | State::ContinuousTimeMode) {
            return;
        }
        self.now = slave.steps(0.0, 1e-3, 2);
        assert_eq!(slave.set_rate("slider.load", 1, 7.0), Status::Ok);
        match self.state {
            State::StepFailed => {
                // An acceleration that no integrator follows, though it is a number.
                assert_eq!(slave.set("slider.load", 1e45), Status::Ok);
                assert_eq!(slave.step(self.now, 1e-3), Status::Discard);
            }
            State::Terminated => assert_eq!(slave.terminate(), Status::Ok),
            // An importer gets there by restoring an instance that was there.
            State::StepCanceled | State::Error => {
                let mut state = FmuState::from_bytes(&self.bytes()).expect("its own state");
                state.state = self.state;
                let forged = slave.deserialize(&state.to_bytes().expect("bytes")).expect("a sound state");
                assert_eq!(slave.set_state(forged), Status::Ok);
            }
            _ => {}
        }
    }

    /// All that the instance is.
    pub fn bytes(&self) -> Vec<u8> {
        let mut state = self.slave.save();
        let bytes = self.slave.bytes_of(state);
        assert_eq!(self.slave.free(&mut state), Status::Ok);
        bytes
    }
}

impl Staged for Stage {
    type Call = Call;

    fn calls() -> Vec<Call> {
        Call::ALL.iter().copied().filter(|&call| call != Call::Instantiate).collect()
    }

    fn name(call: Call) -> &'static str {
        call.name()
    }

    fn refusal(&self, call: Call) -> Option<String> {
        // Instances in states of both kinds are for co-simulation here.
        let kind = self.state.interface().unwrap_or(Interface::CoSimulation);
        match call.interface() {
            Some(Interface::ModelExchange) if kind == Interface::CoSimulation => Some("of model exchange".into()),
            Some(Interface::CoSimulation) if kind == Interface::ModelExchange => Some("of co-simulation".into()),
            _ if !call.allowed(self.state) => Some(format!("not allowed in state '{}'", self.state)),
            _ => None,
        }
    }

    fn frees(call: Call) -> bool {
        call == Call::FreeInstance
    }

    fn arguments(&self, call: Call) -> Vec<Argument> {
        arguments(call, self)
    }

    unsafe fn invoke(&self, call: Call, words: &[Word]) -> Option<Status> {
        // SAFETY: the caller's.
        unsafe { invoke(&self.slave.api, call, words) }
    }

    fn memory(&self) -> &ImportersMemory {
        &self.memory
    }

    fn bytes(&self) -> Vec<u8> {
        self.bytes()
    }

    fn lines(&self) -> Vec<Line> {
        self.slave.log.take()
    }
}
