//! The list of the functions of FMI 2.0. An entry is a function's signature in C and its body; the macro
//! of `declare.rs` makes the function, its export and its type from it.
//!
//! A body borrows what the pointers point to and calls a safe method of [`Instance`]; [`call`] does
//! the rest: the lifecycle, panics, the log and the status.
//!
//! # Safety
//! Of all functions: a component is NULL or was made by `fmi2Instantiate` and not freed since; a
//! non-NULL pointer points to as many entries as the standard says, and a string ends in a zero byte.
#![allow(clippy::missing_safety_doc, reason = "said above, once")]
#![allow(non_snake_case, non_camel_case_types, reason = "the names are the standard's")]

use super::super::error::Error;
use super::super::instance::{Instance, Request};
use super::super::lifecycle::Call;
use super::call::call;
use super::host_logger::HostLogger;
use super::instantiate::instantiate;
use super::types::*;
use crate::fmi::abi::ArgumentError;
use crate::fmi::abi::borrow::{place, slice, slice_mut, structure, text};
use crate::fmi::abi::component::take_back;
use crate::fmi::abi::declare::functions;
use crate::fmi::abi::panic_guard::guarded;
use std::ptr::{null_mut, without_provenance_mut};

functions! {
    // The library.
    /// "default": the types are those of the standard's header.
    fmi2GetTypesPlatform() -> fmi2String { c"default".as_ptr() }
    /// Version of the standard.
    fmi2GetVersion() -> fmi2String { c"2.0".as_ptr() }

    // An instance and its life cycle.
    /// Makes an instance; NULL, and one line in the log, if that cannot be.
    fmi2Instantiate(
        instance_name: fmi2String, fmu_type: fmi2Type, guid: fmi2String, resource_location: fmi2String,
        functions: *const fmi2CallbackFunctions, visible: fmi2Boolean, logging_on: fmi2Boolean,
    ) -> fmi2Component {
        let Ok(functions) = structure("functions", functions) else {
            // There is no logger.
            return null_mut();
        };
        let request = Request {
            name: text(instance_name),
            fmu_type,
            guid: text(guid),
            resource_location: text(resource_location),
            logging_on: logging_on != FMI2_FALSE,
        };
        let host = HostLogger::new(functions);
        guarded(|| instantiate(&request, host)).unwrap_or(null_mut())
    }
    /// Frees an instance with all that belongs to it; NULL is allowed.
    fmi2FreeInstance(c: fmi2Component) -> () {
        let instance = take_back::<Instance>(c);
        // A panic in a destructor leaks memory at worst.
        let _ = guarded(|| drop(instance));
    }
    /// Chooses the log categories that the importer receives.
    fmi2SetDebugLogging(
        c: fmi2Component, logging_on: fmi2Boolean, n_categories: usize, categories: *const fmi2String,
    ) -> fmi2Status {
        call(c, Call::SetDebugLogging, |instance| {
            let pointers = slice("categories", categories, n_categories)?;
            let names: Option<Vec<_>> = pointers.iter().map(|&pointer| text(pointer)).collect();
            let names = names.ok_or(ArgumentError::Null("an entry of categories"))?;
            instance.set_debug_logging(logging_on != FMI2_FALSE, &names)
        })
    }
    /// Sets tolerance and times of the experiment.
    fmi2SetupExperiment(
        c: fmi2Component, tolerance_defined: fmi2Boolean, tolerance: fmi2Real, start_time: fmi2Real,
        stop_time_defined: fmi2Boolean, stop_time: fmi2Real,
    ) -> fmi2Status {
        let tolerance = (tolerance_defined != FMI2_FALSE).then_some(tolerance);
        let stop_time = (stop_time_defined != FMI2_FALSE).then_some(stop_time);
        call(c, Call::SetupExperiment, |instance| instance.setup_experiment(tolerance, start_time, stop_time))
    }
    /// Enters initialization mode, in which outputs follow start values.
    fmi2EnterInitializationMode(c: fmi2Component) -> fmi2Status {
        call(c, Call::EnterInitializationMode, Instance::enter_initialization_mode)
    }
    /// Leaves initialization mode and fixes the parameters. The first step can follow.
    fmi2ExitInitializationMode(c: fmi2Component) -> fmi2Status {
        call(c, Call::ExitInitializationMode, Instance::exit_initialization_mode)
    }
    /// Ends the run; values can still be read.
    fmi2Terminate(c: fmi2Component) -> fmi2Status { call(c, Call::Terminate, Instance::terminate) }
    /// Returns to the state after instantiation.
    fmi2Reset(c: fmi2Component) -> fmi2Status { call(c, Call::Reset, Instance::reset) }

    // Values.
    /// Reads reals.
    fmi2GetReal(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Real) -> fmi2Status {
        call(c, Call::GetReal, |instance| instance.get_real(slice("vr", vr, nvr)?, slice_mut("value", value, nvr)?))
    }
    /// Sets reals, all or none.
    fmi2SetReal(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Real) -> fmi2Status {
        call(c, Call::SetReal, |instance| instance.set_real(slice("vr", vr, nvr)?, slice("value", value, nvr)?))
    }
    /// Reads integers and enumerations.
    fmi2GetInteger(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Integer) -> fmi2Status {
        call(c, Call::GetInteger, |instance| {
            instance.get_integer(slice("vr", vr, nvr)?, slice_mut("value", value, nvr)?)
        })
    }
    /// Sets integers and enumerations, all or none.
    fmi2SetInteger(
        c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Integer,
    ) -> fmi2Status {
        call(c, Call::SetInteger, |instance| instance.set_integer(slice("vr", vr, nvr)?, slice("value", value, nvr)?))
    }
    /// Reads Booleans.
    fmi2GetBoolean(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Boolean) -> fmi2Status {
        call(c, Call::GetBoolean, |instance| {
            instance.get_boolean(slice("vr", vr, nvr)?, slice_mut("value", value, nvr)?)
        })
    }
    /// Sets Booleans, all or none.
    fmi2SetBoolean(
        c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Boolean,
    ) -> fmi2Status {
        call(c, Call::SetBoolean, |instance| instance.set_boolean(slice("vr", vr, nvr)?, slice("value", value, nvr)?))
    }
    /// No variable is a string, so only an empty list is right.
    fmi2GetString(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2String) -> fmi2Status {
        call(c, Call::GetString, |instance| instance.check_strings(slice("vr", vr, nvr)?))
    }
    /// No variable is a string, so only an empty list is right.
    fmi2SetString(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2String) -> fmi2Status {
        call(c, Call::SetString, |instance| instance.check_strings(slice("vr", vr, nvr)?))
    }
    /// Sets first time derivatives of real inputs, all or none.
    fmi2SetRealInputDerivatives(
        c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, order: *const fmi2Integer,
        value: *const fmi2Real,
    ) -> fmi2Status {
        call(c, Call::SetRealInputDerivatives, |instance| {
            let (vr, order) = (slice("vr", vr, nvr)?, slice("order", order, nvr)?);
            instance.set_input_derivatives(vr, order, slice("value", value, nvr)?)
        })
    }
    /// Reads first time derivatives of real outputs.
    fmi2GetRealOutputDerivatives(
        c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, order: *const fmi2Integer,
        value: *mut fmi2Real,
    ) -> fmi2Status {
        call(c, Call::GetRealOutputDerivatives, |instance| {
            let (vr, order) = (slice("vr", vr, nvr)?, slice("order", order, nvr)?);
            instance.get_output_derivatives(vr, order, slice_mut("value", value, nvr)?)
        })
    }
    /// Derivatives of real outputs along a direction of real inputs.
    fmi2GetDirectionalDerivative(
        c: fmi2Component, unknown: *const fmi2ValueReference, n_unknown: usize, known: *const fmi2ValueReference,
        n_known: usize, dv_known: *const fmi2Real, dv_unknown: *mut fmi2Real,
    ) -> fmi2Status {
        call(c, Call::GetDirectionalDerivative, |instance| {
            instance.directional_derivative(
                slice("vUnknown_ref", unknown, n_unknown)?,
                slice("vKnown_ref", known, n_known)?,
                slice("dvKnown", dv_known, n_known)?,
                slice_mut("dvUnknown", dv_unknown, n_unknown)?,
            )
        })
    }

    // Steps and their outcome.
    /// Moves the instance from the communication point by one step. The step is over when the call
    /// returns, so nothing need be kept for a later question about an earlier point.
    fmi2DoStep(
        c: fmi2Component, current_communication_point: fmi2Real, communication_step_size: fmi2Real,
        no_set_fmu_state_prior_to_current_point: fmi2Boolean,
    ) -> fmi2Status {
        call(c, Call::DoStep, |instance| instance.do_step(current_communication_point, communication_step_size))
    }
    /// Steps are never asynchronous, so there is nothing to cancel. The life cycle refuses this call in every state.
    fmi2CancelStep(c: fmi2Component) -> fmi2Status { call(c, Call::CancelStep, |_| Ok(())) }
    /// Status of the last step.
    fmi2GetStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut i32) -> fmi2Status {
        call(c, Call::GetStatus, |instance| {
            put(place("value", value)?, instance.step_status(s).map(|status| status as i32))
        })
    }
    /// The time that the last step reached.
    fmi2GetRealStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Real) -> fmi2Status {
        call(c, Call::GetRealStatus, |instance| put(place("value", value)?, instance.real_status(s)))
    }
    /// The standard has no integer status.
    fmi2GetIntegerStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Integer) -> fmi2Status {
        call(c, Call::GetIntegerStatus, |instance| put(place("value", value)?, instance.absent_status(s)))
    }
    /// Whether the instance wants the simulation to end.
    fmi2GetBooleanStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Boolean) -> fmi2Status {
        call(c, Call::GetBooleanStatus, |instance| {
            put(place("value", value)?, instance.boolean_status(s).map(fmi2Boolean::from))
        })
    }
    /// The standard's only string status belongs to asynchronous steps, which this FMU does not have.
    fmi2GetStringStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2String) -> fmi2Status {
        call(c, Call::GetStringStatus, |instance| put(place("value", value)?, instance.absent_status(s)))
    }

    // Saved states. The importer has handles, which are searched in a list and never dereferenced.
    /// Saves the instance in this state, or in a new one if the state is NULL.
    fmi2GetFMUstate(c: fmi2Component, state: *mut fmi2FMUstate) -> fmi2Status {
        call(c, Call::GetFMUstate, |instance| {
            let state = place("FMUstate", state)?;
            let saved = instance.get_fmu_state(state.addr());
            put(state, saved.map(without_provenance_mut))
        })
    }
    /// Restores the instance from a saved state.
    fmi2SetFMUstate(c: fmi2Component, state: fmi2FMUstate) -> fmi2Status {
        call(c, Call::SetFMUstate, |instance| instance.set_fmu_state(state.addr()))
    }
    /// Frees a state and sets it to NULL. The state, and the pointer to it, may be NULL.
    fmi2FreeFMUstate(c: fmi2Component, state: *mut fmi2FMUstate) -> fmi2Status {
        call(c, Call::FreeFMUstate, |instance| {
            if state.is_null() {
                return Ok(());
            }
            let state = place("FMUstate", state)?;
            let freed = instance.free_fmu_state(state.addr());
            put(state, freed.map(|()| null_mut()))
        })
    }
    /// Number of bytes of a state.
    fmi2SerializedFMUstateSize(c: fmi2Component, state: fmi2FMUstate, size: *mut usize) -> fmi2Status {
        call(c, Call::SerializedFMUstateSize, |instance| {
            put(place("size", size)?, instance.serialized_size(state.addr()))
        })
    }
    /// Writes the state as bytes.
    fmi2SerializeFMUstate(c: fmi2Component, state: fmi2FMUstate, bytes: *mut fmi2Byte, size: usize) -> fmi2Status {
        call(c, Call::SerializeFMUstate, |instance| {
            instance.serialize(state.addr(), slice_mut("serializedState", bytes.cast::<u8>(), size)?)
        })
    }
    /// Reads bytes into this state, or into a new one if the state is NULL.
    fmi2DeSerializeFMUstate(
        c: fmi2Component, bytes: *const fmi2Byte, size: usize, state: *mut fmi2FMUstate,
    ) -> fmi2Status {
        call(c, Call::DeSerializeFMUstate, |instance| {
            let bytes = slice("serializedState", bytes.cast::<u8>(), size)?;
            let state = place("FMUstate", state)?;
            let saved = instance.deserialize(bytes, state.addr());
            put(state, saved.map(without_provenance_mut))
        })
    }

    // Model exchange.
    /// Enters event mode, in which discrete states may change.
    fmi2EnterEventMode(c: fmi2Component) -> fmi2Status { call(c, Call::EnterEventMode, Instance::enter_event_mode) }
    /// Closes and opens contacts according to the event indicators.
    fmi2NewDiscreteStates(c: fmi2Component, event_info: *mut fmi2EventInfo) -> fmi2Status {
        call(c, Call::NewDiscreteStates, |instance| {
            let info = place("fmi2EventInfo", event_info)?;
            *info = instance.slave().update_discrete_states()?.into();
            Ok(())
        })
    }
    /// Enters continuous-time mode, in which the importer integrates.
    fmi2EnterContinuousTimeMode(c: fmi2Component) -> fmi2Status {
        call(c, Call::EnterContinuousTimeMode, Instance::enter_continuous_time_mode)
    }
    /// Returns whether an event has happened.
    fmi2CompletedIntegratorStep(
        c: fmi2Component, no_set_fmu_state_prior_to_current_point: fmi2Boolean,
        enter_event_mode: *mut fmi2Boolean, terminate_simulation: *mut fmi2Boolean,
    ) -> fmi2Status {
        call(c, Call::CompletedIntegratorStep, |instance| {
            let enter = place("enterEventMode", enter_event_mode)?;
            let terminate = place("terminateSimulation", terminate_simulation)?;
            (*enter, *terminate) = (instance.slave().update_is_due()?.into(), FMI2_FALSE);
            Ok(())
        })
    }
    /// Sets the importer's time.
    fmi2SetTime(c: fmi2Component, time: fmi2Real) -> fmi2Status {
        call(c, Call::SetTime, |instance| Ok(instance.slave().set_time(time)?))
    }
    /// Sets the continuous states.
    fmi2SetContinuousStates(c: fmi2Component, x: *const fmi2Real, nx: usize) -> fmi2Status {
        call(c, Call::SetContinuousStates, |instance| Ok(instance.slave().set_states(slice("x", x, nx)?)?))
    }
    /// Reads the derivatives of the continuous states.
    fmi2GetDerivatives(c: fmi2Component, derivatives: *mut fmi2Real, nx: usize) -> fmi2Status {
        call(c, Call::GetDerivatives, |instance| {
            Ok(instance.slave().write_derivatives(slice_mut("derivatives", derivatives, nx)?)?)
        })
    }
    /// Reads the event indicators.
    fmi2GetEventIndicators(c: fmi2Component, event_indicators: *mut fmi2Real, ni: usize) -> fmi2Status {
        call(c, Call::GetEventIndicators, |instance| {
            Ok(instance.slave().write_indicators(slice_mut("eventIndicators", event_indicators, ni)?)?)
        })
    }
    /// Reads the continuous states.
    fmi2GetContinuousStates(c: fmi2Component, x: *mut fmi2Real, nx: usize) -> fmi2Status {
        call(c, Call::GetContinuousStates, |instance| {
            Ok(instance.slave().write_states(slice_mut("x", x, nx)?)?)
        })
    }
    /// Reads the nominal values of the continuous states.
    fmi2GetNominalsOfContinuousStates(c: fmi2Component, x_nominal: *mut fmi2Real, nx: usize) -> fmi2Status {
        call(c, Call::GetNominalsOfContinuousStates, |instance| {
            Ok(instance.slave().write_nominals(slice_mut("x_nominal", x_nominal, nx)?)?)
        })
    }
}

/// Writes a value to the importer's memory, if there is a value.
fn put<T>(place: &mut T, value: Result<T, Error>) -> Result<(), Error> {
    *place = value?;
    Ok(())
}
