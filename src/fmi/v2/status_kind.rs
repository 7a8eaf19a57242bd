//! The kinds of status that an importer can read.

/// The standard's `fmi2StatusKind`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StatusKind {
    /// Status of the last step.
    DoStep,
    /// Text about an asynchronous step.
    Pending,
    /// Time that the last step reached.
    LastSuccessfulTime,
    /// Whether the instance requests the end of the simulation.
    Terminated,
}

impl StatusKind {
    /// The kind of this number.
    pub fn of(value: i32) -> Option<Self> {
        match value {
            0 => Some(Self::DoStep),
            1 => Some(Self::Pending),
            2 => Some(Self::LastSuccessfulTime),
            3 => Some(Self::Terminated),
            _ => None,
        }
    }

    /// The standard's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::DoStep => "fmi2DoStepStatus",
            Self::Pending => "fmi2PendingStatus",
            Self::LastSuccessfulTime => "fmi2LastSuccessfulTime",
            Self::Terminated => "fmi2Terminated",
        }
    }
}
