//! What the importer reads: each error in one line, with what was asked and what is allowed.

use super::*;
use crate::model_description::number::number;
use std::fmt;

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Argument(error) => error.fmt(f),
            Self::Variable(error) => error.fmt(f),
            Self::CallOrder(state) => write!(f, "not allowed in state '{state}'"),
            Self::ModelExchange => f.write_str("of model exchange, and this FMU is for co-simulation"),
            Self::Instantiate(error) => error.fmt(f),
            Self::Time(error) => error.fmt(f),
            Self::Category(name) => write!(f, "log category '{name}' is not declared"),
            Self::StatusKind(kind) => write!(f, "there is no {} to tell here", kind.name()),
            Self::NoStatusKind(value) => write!(f, "{value} is not an fmi2StatusKind"),
            Self::FmuState(error) => error.fmt(f),
            Self::Scene(error) => error.fmt(f),
            Self::NoNumber(name, value) => write!(f, "{name} = {value} is not a finite number"),
            Self::Simulation(error) => error.fmt(f),
            Self::Panic(what) => write!(f, "fault of the FMU: {what}"),
        }
    }
}

impl fmt::Display for ArgumentError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Null(argument) => write!(f, "argument '{argument}' is NULL"),
            Self::Misaligned(argument) => {
                write!(f, "argument '{argument}' is not aligned for its type")
            }
            Self::TooLong(argument, length) => {
                write!(f, "argument '{argument}' cannot have {length} elements")
            }
            Self::NotText(argument) => write!(f, "argument '{argument}' is not UTF-8"),
        }
    }
}

impl fmt::Display for VariableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(reference) => write!(f, "no variable has value reference {reference}"),
            Self::Type { name, is, asked } => write!(f, "{name} is of type {is}, not {asked}"),
            Self::Moment { name, write, causality, state } => {
                let verb = if *write { "set" } else { "read" };
                write!(f, "{name} ({causality}) cannot be {verb} in state '{state}'")
            }
            Self::NotFinite(name, value) => write!(f, "{name} = {value} is not a finite number"),
            Self::Refused(Refusal { name, found, allowed }) => {
                write!(f, "{name} = {} is out of range; allowed: {allowed}", number(*found))
            }
            Self::Order(name, order) => write!(f, "derivative of order {order} of {name}: only order 1 is known"),
            Self::Kind(name, needed) => write!(f, "{name} is not {needed}"),
        }
    }
}

impl fmt::Display for InstantiateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Type(kind) => write!(f, "fmuType {kind}: only fmi2CoSimulation (1) can be instantiated"),
            Self::Name => write!(f, "instanceName is NULL or empty"),
            Self::Slot(error) => error.fmt(f),
            Self::Guid { expected, given: Some(given) } => {
                write!(f, "fmuGUID '{given}' does not match this library's '{expected}'")
            }
            Self::Guid { expected, given: None } => {
                write!(f, "fmuGUID is NULL; this library's is '{expected}'")
            }
        }
    }
}

impl fmt::Display for TimeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite(name, value) => write!(f, "{name} = {value} is not a finite number"),
            Self::NotPositive(name, value) => write!(f, "{name} = {value:?} is not above 0"),
            Self::StopBeforeStart { start, stop } => {
                write!(f, "stopTime {stop:?} s lies before startTime {start:?} s")
            }
            Self::Elsewhere { given, reached } => {
                write!(f, "currentCommunicationPoint {given:?} s is not the point reached, {reached:?} s")
            }
            Self::PastStop { end, stop } => {
                write!(f, "the step ends at {end:?} s, after the stopTime {stop:?} s")
            }
        }
    }
}

impl fmt::Display for FmuStateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Null => f.write_str("FMUstate is NULL"),
            Self::Foreign => write!(
                f,
                "the FMUstate is not a live one of this instance; between instances, states travel serialized"
            ),
            Self::Buffer { given, needed } => {
                write!(f, "the buffer has {given} bytes, the serialized state needs {needed}")
            }
            Self::NotOurs => write!(f, "these bytes are not a state of this FMU"),
            Self::Version { found, known } => {
                write!(f, "the state has format version {found}; this FMU reads version {known}")
            }
            Self::Declaration => f.write_str("the state is of an FMU with other variables"),
            Self::Length { expected, given } => {
                write!(f, "the state has {given} bytes instead of {expected}")
            }
            Self::Checksum => write!(f, "the state is damaged: its checksum does not match"),
            Self::Content => write!(f, "the state's content contradicts itself"),
        }
    }
}
