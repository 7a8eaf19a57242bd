//! Why a call is refused: each cause with the names and numbers that the importer needs.

mod display;

use super::lifecycle::State;
use super::status::StatusKind;
use crate::scene::check::SceneError;
use crate::scene::parameter::Refusal;
use crate::scene::slot::SlotError;
use crate::simulation::SimulationError;

/// Why a call is refused or a step not finished.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A pointer from outside cannot be used.
    Argument(ArgumentError),
    /// A value reference or a value cannot be used.
    Variable(VariableError),
    /// The call does not belong in this state.
    CallOrder(State),
    /// The function belongs to model exchange.
    ModelExchange,
    /// Instantiation was asked for something else than this unit.
    Instantiate(InstantiateError),
    /// A time or a tolerance cannot be used.
    Time(TimeError),
    /// The log category is not declared.
    Category(String),
    /// The status asked for is not known here.
    StatusKind(StatusKind),
    /// A number that is no status kind.
    NoStatusKind(i32),
    /// A saved state cannot be used.
    FmuState(FmuStateError),
    /// The parameters do not go together.
    Scene(SceneError),
    /// An output that is NaN or infinite.
    NoNumber(&'static str, f64),
    /// The mechanism cannot start or go on.
    Simulation(SimulationError),
    /// A fault of ours, with what is known of it.
    Panic(String),
}

/// Why a pointer from outside cannot be used. Each holds the argument's name.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ArgumentError {
    /// NULL where data are needed.
    Null(&'static str),
    /// Not where such a datum can lie.
    Misaligned(&'static str),
    /// More elements than any sensible call has.
    TooLong(&'static str, usize),
    /// Not UTF-8.
    NotText(&'static str),
}

/// Why a value reference or a value cannot be used.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum VariableError {
    /// No variable has this value reference.
    Unknown(u32),
    /// The variable is of another type than the function's.
    Type {
        /// Name of the variable.
        name: &'static str,
        /// Its type.
        is: &'static str,
        /// The function's type.
        asked: &'static str,
    },
    /// The variable cannot be read or written now.
    Moment {
        /// Name of the variable.
        name: &'static str,
        /// Whether it was to be written, rather than read.
        write: bool,
        /// What it is: input, output or fixed parameter.
        causality: &'static str,
        /// State of the instance.
        state: State,
    },
    /// NaN or infinite.
    NotFinite(&'static str, f64),
    /// Outside the declared range, or not an item of the enumeration.
    Refused(Refusal),
    /// Derivatives are of order 1 only.
    Order(&'static str, i32),
    /// The function is about the other kind of variable. The last field says which it needs.
    Kind(&'static str, &'static str),
}

/// Why there is no instance.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum InstantiateError {
    /// Not co-simulation.
    Type(i32),
    /// NULL or empty.
    Name,
    /// The packaged scene inside the library cannot be read.
    Slot(SlotError),
    /// The XML that the importer read is not this library's.
    Guid {
        /// The library's.
        expected: String,
        /// The importer's, if any.
        given: Option<String>,
    },
}

/// Why a time or a tolerance cannot be used.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TimeError {
    /// NaN or infinite.
    NotFinite(&'static str, f64),
    /// Not above 0.
    NotPositive(&'static str, f64),
    /// The stop lies before the start.
    StopBeforeStart {
        /// [s]
        start: f64,
        /// [s]
        stop: f64,
    },
    /// The importer's communication point is not where the instance is.
    Elsewhere {
        /// [s] The importer's.
        given: f64,
        /// [s] The instance's.
        reached: f64,
    },
    /// The step would end after the experiment's stop time.
    PastStop {
        /// [s] End of the step.
        end: f64,
        /// [s] Stop time.
        stop: f64,
    },
}

/// Why a saved state cannot be used.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum FmuStateError {
    /// NULL.
    Null,
    /// Not a live state of this instance.
    Foreign,
    /// The buffer is shorter than the state.
    Buffer {
        /// Bytes given.
        given: usize,
        /// Bytes needed.
        needed: usize,
    },
    /// Too short or without our magic number.
    NotOurs,
    /// Written by another version of the format.
    Version {
        /// Theirs.
        found: u32,
        /// Ours.
        known: u32,
    },
    /// Written by an FMU with another declaration of variables.
    Declaration,
    /// Cut or with bytes after the end.
    Length {
        /// Bytes that the header tells of.
        expected: usize,
        /// Bytes given.
        given: usize,
    },
    /// Checksum does not match.
    Checksum,
    /// The checksum matches but the content makes no sense.
    Content,
}

impl From<Refusal> for Error {
    fn from(refusal: Refusal) -> Self {
        VariableError::Refused(refusal).into()
    }
}

/// `impl From<$part> for Error`.
macro_rules! from {
    ($($part:ident => $item:ident),+) => {
        $(impl From<$part> for Error {
            fn from(error: $part) -> Self {
                Self::$item(error)
            }
        })+
    };
}

from! {
    ArgumentError => Argument, VariableError => Variable, InstantiateError => Instantiate,
    TimeError => Time, FmuStateError => FmuState,
    SceneError => Scene, SimulationError => Simulation
}

impl std::error::Error for Error {}
