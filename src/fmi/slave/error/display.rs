//! Messages of errors: one line each, with the given value and the allowed values.

use super::*;
use crate::model_description::number::number;
use std::fmt;

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Variable(error) => error.fmt(f),
            Self::Time(error) => error.fmt(f),
            Self::SavedState(error) => error.fmt(f),
            Self::Scene(error) => error.fmt(f),
            Self::PhaseNotFinite(name, value) => write!(f, "{name} = {value} is not a finite number"),
            Self::PhaseBeyond(name, value) => {
                write!(f, "no motion goes on from these numbers, of which {name} = {value:e} is the largest")
            }
            Self::OutputNotFinite(name, value) => write!(f, "{name} = {value} is not a finite number"),
            Self::NoDerivative(name) => {
                write!(f, "{name} has no derivative with respect to these start values: it jumps there")
            }
            Self::Simulation(error) => error.fmt(f),
            Self::Interface => f.write_str("for the other kind of interface: co-simulation or model exchange"),
            Self::Count { of, given, needed } => write!(f, "{given} {of}, where there are {needed}"),
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
            Self::Absent(name) => write!(f, "the scene has no {name}"),
            Self::Structure(name) => write!(
                f,
                "{name}: this value asks for other states or event indicators than modelDescription.xml lists for model \
                 exchange; co-simulation takes it, and so does a package of a scene that has it"
            ),
            Self::Kind(name, needed) => write!(f, "{name} is not {needed}"),
            Self::Twice(name) => write!(f, "{name} is named twice"),
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

impl fmt::Display for SavedStateError {
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
                // The upper half is 3 for FMI 3.0.
                let told = |format: u32| match format >> 16 {
                    0 => format!("version {format} for FMI 2.0"),
                    3 => format!("version {} for FMI 3.0", format & 0xffff),
                    _ => format!("version {format}"),
                };
                write!(f, "the state has format {}; this FMU reads {}", told(*found), told(*known))
            }
            Self::Declaration => f.write_str("the state is of an FMU with other variables"),
            Self::Length { expected, given } => {
                write!(f, "the state has {given} bytes instead of {expected}")
            }
            Self::Interface => f.write_str(
                "the state is of an instance of the other kind of interface: co-simulation or model exchange",
            ),
            Self::Checksum => write!(f, "the state is damaged: its checksum does not match"),
            Self::Content => write!(f, "the state's content contradicts itself"),
        }
    }
}
