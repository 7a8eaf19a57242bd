//! The standard's FMU state: the state of the life cycle and the state of the slave.

use super::lifecycle::{Call, State};
use crate::fmi::slave::Settings;
use crate::fmi::slave::saved_states::Saved;
use crate::fmi::status::Status;
use crate::simulation::Snapshot;
use serde::{Deserialize, Serialize};

/// The state of an instance, without its name and its logging.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FmuState {
    /// State of the life cycle.
    pub state: State,
    /// Settings of the importer.
    pub settings: Settings,
    /// Status of the last step.
    pub last_step: Status,
    /// Whether the last step reached a dead end.
    pub dead_end: bool,
    /// The simulation, after initialization.
    pub snapshot: Option<Snapshot>,
}

impl Saved for FmuState {
    const FORMAT: u32 = 16;

    /// Whether an instance could be in this state: there is a snapshot after initialization and only then, and all
    /// settings are values that an importer can set. The snapshot is checked when it is restored.
    fn makes_sense(&self) -> bool {
        let ended = !self.dead_end || self.last_step == Status::Discard;
        let before = matches!(self.state, State::Instantiated | State::InitializationMode);
        Call::GetFMUstate.allowed(self.state) && ended && before == self.snapshot.is_none() && self.settings.are_sound()
    }
}
