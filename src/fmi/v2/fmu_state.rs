//! The standard's FMU state: where an instance is in its life, and all that its slave is.

use super::lifecycle::{Call, State};
use crate::fmi::slave::Settings;
use crate::fmi::slave::saved_states::Saved;
use crate::fmi::status::Status;
use crate::simulation::Snapshot;
use serde::{Deserialize, Serialize};

/// Everything that an instance is, its name and its logging aside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FmuState {
    /// Where it is in its life.
    pub state: State,
    /// What the importer set.
    pub settings: Settings,
    /// Status of the last step.
    pub last_step: Status,
    /// Whether that step came to where no step leads on.
    pub dead_end: bool,
    /// The simulation, once initialization is over.
    pub snapshot: Option<Snapshot>,
}

impl Saved for FmuState {
    const FORMAT: u32 = 9;

    /// Whether an instance can be in this state: a snapshot belongs to it once initialization is over, and nothing in
    /// it is what an importer cannot set. The snapshot is checked when it is restored.
    fn makes_sense(&self) -> bool {
        let ended = !self.dead_end || self.last_step == Status::Discard;
        let before = matches!(self.state, State::Instantiated | State::InitializationMode);
        Call::GetFMUstate.allowed(self.state) && ended && before == self.snapshot.is_none() && self.settings.are_sound()
    }
}
