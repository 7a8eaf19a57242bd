//! Instances in every state of the lifecycle, and memory for a call's arguments.

use crate::host::Slave;
use crate::invoke::{NULL, Word};
use slidercrank::fmi::slave::Interface;
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::abi::types::fmi2FMUstate;
use slidercrank::fmi::v2::fmu_state::FmuState;
use slidercrank::fmi::v2::lifecycle::State;
use std::any::Any;
use std::cell::RefCell;
use std::ffi::CString;

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
    held: RefCell<Vec<Held>>,
}

/// An array of the importer's.
struct Held {
    /// Keeps it.
    _entries: Box<dyn Any>,
    start: *const u8,
    length: usize,
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
        let mut stage = Self { slave, state, now: 0.0, saved, theirs, held: RefCell::default() };
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

    /// Forgets all arrays.
    pub fn clear(&mut self) {
        self.held.get_mut().clear();
    }

    /// An array that lives as long as the stage.
    pub fn array<T: Copy + 'static>(&self, entries: Vec<T>) -> Word {
        let mut entries = entries.into_boxed_slice();
        let (start, length) = (entries.as_mut_ptr().cast::<u8>(), size_of_val(&*entries));
        self.held.borrow_mut().push(Held { _entries: Box::new(entries), start, length });
        Word::Pointer(start.cast())
    }

    /// The bytes of all arrays.
    pub fn memory(&self) -> Vec<u8> {
        let held = self.held.borrow();
        // SAFETY: the entries are kept, and they are numbers and pointers without padding.
        held.iter().flat_map(|held| unsafe { std::slice::from_raw_parts(held.start, held.length) }).copied().collect()
    }

    /// Text that lives as long as the stage.
    pub fn text(&self, text: &[u8]) -> Word {
        self.array(CString::new(text).expect("no zero").into_bytes_with_nul())
    }
}

/// Where no datum of more than a byte can lie.
pub fn odd(word: Word) -> Word {
    match word {
        Word::Pointer(pointer) => Word::Pointer(pointer.cast::<u8>().wrapping_add(1).cast()),
        _ => NULL,
    }
}
