//! Instances of FMI 3.0 in every state of the lifecycle.

use super::arguments::arguments;
use super::invoke::invoke;
use super::lines;
use crate::arguments::Argument;
use crate::importer::{Options, Slave};
use crate::importers_memory::ImportersMemory;
use crate::invoke::Word;
use crate::product::Staged;
use crate::scenes::{MECHANISMS, packaged};
use crate::stage::STOP;
use host::log::Line;
use slidercrank::fmi::slave::Interface;
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::fmi3FreeFMUState;
use slidercrank::fmi::v3::abi::types::fmi3FMUState;
use slidercrank::fmi::v3::lifecycle::{Call, State};
use slidercrank::scene::Scene;

/// How an importer uses an instance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Use {
    Steps,
    Events,
    Exchange,
}

impl Use {
    pub fn interface(self) -> Interface {
        if self == Self::Exchange { Interface::ModelExchange } else { Interface::CoSimulation }
    }
}

/// Every use, and the states in which a call between two others can meet an instance, but the fatal one, which needs a
/// fault of the library.
pub const STATES: [(Use, State); 14] = [
    (Use::Steps, State::Instantiated),
    (Use::Steps, State::StepMode),
    (Use::Steps, State::Terminated),
    (Use::Events, State::Instantiated),
    (Use::Events, State::InitializationMode),
    (Use::Events, State::EventMode),
    (Use::Events, State::StepMode),
    (Use::Events, State::EventPending),
    (Use::Events, State::Terminated),
    (Use::Exchange, State::Instantiated),
    (Use::Exchange, State::InitializationMode),
    (Use::Exchange, State::EventMode),
    (Use::Exchange, State::ContinuousTimeMode),
    (Use::Exchange, State::Terminated),
];

/// An instance in some state.
pub struct Stage {
    pub slave: Slave,
    pub usage: Use,
    pub state: State,
    /// [s] Where it is.
    pub now: f64,
    /// A saved state of it, from when it was young.
    pub saved: fmi3FMUState,
    /// A saved state of another instance.
    pub theirs: fmi3FMUState,
    pub memory: ImportersMemory,
}

/// An instance that is new but for start values with which it moves, and inputs.
pub fn young(usage: Use, options: Options<'_>) -> Slave {
    let slave = match usage {
        Use::Exchange => Slave::exchanging(),
        _ => Slave::new(options),
    };
    if usage != Use::Exchange {
        assert_eq!(slave.set_enumeration("joint.C.model", 2), Status::Ok);
    }
    assert_eq!(slave.set("crank.speed_start", 500.0), Status::Ok);
    // Away from the dead centre, where no load could turn the crank.
    assert_eq!(slave.set("crank.angle_start", 1.0), Status::Ok);
    restrain(&slave);
    slave
}

/// The most evaluations of a step that these hosts allow.
pub fn restrain(slave: &Slave) {
    assert_eq!(slave.set_integer("solver.max_evaluations", 20_000), Status::Ok);
}

impl Stage {
    /// A new instance in this state.
    pub fn reach((usage, state): (Use, State), theirs: fmi3FMUState) -> Self {
        let options =
            if usage == Use::Events { Options::EVENTS } else { Options { logging: true, ..Options::default() } };
        let slave = young(usage, options);
        let saved = slave.save();
        let mut stage = Self { slave, usage, state, now: 0.0, saved, theirs, memory: ImportersMemory::default() };
        stage.lead();
        stage.slave.lines();
        stage
    }

    fn lead(&mut self) {
        let Self { slave, usage, state, .. } = self;
        if *state == State::Instantiated {
            return;
        }
        assert_eq!(slave.enter_with(Some(1e-6), 0.0, Some(STOP)), Status::Ok);
        if *state == State::InitializationMode {
            return;
        }
        assert_eq!(slave.exit(), Status::Ok);
        if *state == State::EventMode {
            return;
        }
        match usage {
            Use::Steps => {}
            Use::Events => slave.handle_event(),
            Use::Exchange => {
                assert_eq!(slave.update_discrete_states(), Status::Ok);
                assert_eq!(slave.enter_continuous_time_mode(), Status::Ok);
            }
        }
        if *usage != Use::Exchange {
            self.now = slave.step(0.0, if *state == State::EventPending { 0.01 } else { 1e-5 }).time;
        }
        if *state == State::Terminated {
            assert_eq!(slave.terminate(), Status::Ok);
        }
    }

    /// The scene of the instance, as far as its contacts go.
    pub fn scene(&self) -> Scene {
        MECHANISMS[if self.usage == Use::Exchange { packaged() } else { 0 }].scene()
    }
}

impl Staged for Stage {
    type Call = Call;

    fn calls() -> Vec<Call> {
        let makes =
            [Call::InstantiateCoSimulation, Call::InstantiateModelExchange, Call::InstantiateScheduledExecution];
        // That one has no instance, either.
        Call::ALL.iter().copied().filter(|call| !makes.contains(call) && *call != Call::GetVersion).collect()
    }

    fn name(call: Call) -> &'static str {
        call.name()
    }

    fn refusal(&self, call: Call) -> Option<String> {
        match call.interface() {
            Some(interface) if interface != self.usage.interface() => Some(interface.mismatch().into()),
            _ if !call.allowed(self.state) => {
                let out_of_order = || format!("not allowed in state '{}'", self.state);
                Some(call.not_provided().map_or_else(out_of_order, Into::into))
            }
            _ if call == Call::EnterEventMode && self.usage == Use::Steps => Some("eventModeUsed = fmi3False".into()),
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
        unsafe { invoke(call, words) }
    }

    fn memory(&self) -> &ImportersMemory {
        &self.memory
    }

    fn bytes(&self) -> Vec<u8> {
        let mut state = self.slave.save();
        let bytes = self.slave.bytes_of(state);
        // SAFETY: live instance, one place.
        assert_eq!(unsafe { fmi3FreeFMUState(self.slave.0, &mut state) }, Status::Ok);
        bytes
    }

    fn lines(&self) -> Vec<Line> {
        lines(&self.slave)
    }
}
