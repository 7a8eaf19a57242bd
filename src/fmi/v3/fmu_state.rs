//! The standard's FMU state: where an instance is in its life, and all that its slave is.

use super::lifecycle::{Call, State};
use crate::fmi::slave::saved_states::Saved;
use crate::fmi::slave::{Interface, Settings};
use crate::simulation::Snapshot;
use serde::{Deserialize, Serialize};

/// Everything that an instance is, aside from its name, its log, and what the importer said of itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FmuState {
    /// The instance's kind of interface.
    pub interface: Interface,
    /// Where it is in its life.
    pub state: State,
    /// Whether it shows the left limit of an event.
    pub before_event: bool,
    /// What the importer set.
    pub settings: Settings,
    /// The simulation, once initialization is over.
    pub snapshot: Option<Snapshot>,
}

impl Saved for FmuState {
    // The upper half tells the version of FMI.
    const FORMAT: u32 = 3 << 16 | 9;

    /// Whether an instance can be in this state. The snapshot is checked when it is restored.
    fn makes_sense(&self) -> bool {
        let Self { interface, state, before_event, settings, snapshot } = self;
        let running = !matches!(state, State::Instantiated | State::InitializationMode);
        let side = match state {
            State::EventPending => *before_event,
            State::EventMode | State::Terminated => *interface == Interface::CoSimulation || !before_event,
            _ => !before_event,
        };
        let kind = state.interface().is_none_or(|of_state| of_state == *interface);
        Call::GetFMUState.allowed(*state) && kind && running == snapshot.is_some() && side && settings.are_sound()
    }
}
