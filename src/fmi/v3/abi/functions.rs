//! The list of the functions of FMI 3.0. An entry is a function's signature in C and its body; the macro of
//! `v2/abi/declare.rs` makes the function, its export and its type from it.
//!
//! A body borrows what the pointers point to and calls a safe method of [`Instance`]; [`call`] does
//! the rest: the lifecycle, panics, the log and the status. Functions that the FMU does not provide are exported, since
//! importers bind them blindly; the lifecycle refuses them in every state.
//!
//! # Safety
//! Of all functions: an instance is NULL or was made by one of the two functions that instantiate and not freed since; a
//! non-NULL pointer points to as many entries as the standard says, and a string ends in a zero byte.
#![allow(clippy::missing_safety_doc, reason = "said above, once")]
#![allow(non_snake_case, non_camel_case_types, reason = "the names are the standard's")]

use super::super::error::Error;
use super::super::instance::{Instance, Request, StepRequest};
use super::super::lifecycle::Call;
use super::call::{call, free};
use super::do_step::{Answers, do_step};
use super::host_logger::HostLogger;
use super::host_update::HostUpdate;
use super::instantiate::{instantiate, refuse, refuse_kind};
use super::types::*;
use crate::fmi::abi::ArgumentError;
use crate::fmi::abi::borrow::{place, slice, slice_mut, text};
use crate::fmi::abi::declare::functions;
use crate::fmi::abi::panic_guard::guarded;
use crate::fmi::slave::Interface;
use crate::simulation::Update;
use std::ptr::{null_mut, without_provenance_mut};

functions! {
    // The library.
    /// Version of the standard.
    fmi3GetVersion() -> fmi3String { c"3.0".as_ptr() }

    // An instance and its life cycle.
    /// Makes an instance; NULL, and one line in the log, if that cannot be. Nothing is read from the resources.
    fmi3InstantiateCoSimulation(
        instance_name: fmi3String, instantiation_token: fmi3String, resource_path: fmi3String, visible: fmi3Boolean,
        logging_on: fmi3Boolean, event_mode_used: fmi3Boolean, early_return_allowed: fmi3Boolean,
        required_intermediate_variables: *const fmi3ValueReference, n_required_intermediate_variables: usize,
        instance_environment: fmi3InstanceEnvironment, log_message: Option<fmi3LogMessageCallback>,
        intermediate_update: Option<fmi3IntermediateUpdateCallback>,
    ) -> fmi3Instance {
        let host = HostLogger::new(log_message, instance_environment);
        let name = text(instance_name);
        let required = slice(
            "requiredIntermediateVariables",
            required_intermediate_variables,
            n_required_intermediate_variables,
        );
        let update = intermediate_update.map(|callback| HostUpdate::new(callback, instance_environment));
        let made = guarded(|| match required {
            Err(error) => refuse(Call::InstantiateCoSimulation, name, host, &error.into()),
            Ok(intermediate) => {
                let steps = StepRequest {
                    event_mode_used: event_mode_used != 0,
                    early_return_allowed: early_return_allowed != 0,
                    intermediate,
                    has_callback: update.is_some(),
                };
                let (token, logging_on) = (text(instantiation_token), logging_on != 0);
                let request = Request { interface: Interface::CoSimulation, name, token, logging_on, steps };
                instantiate(&request, host, update)
            }
        });
        made.unwrap_or(null_mut())
    }
    /// Frees an instance with all that belongs to it; NULL is allowed.
    fmi3FreeInstance(instance: fmi3Instance) -> () { free(instance) }
    /// Switches log categories on or off. Errors are logged in either case.
    fmi3SetDebugLogging(
        instance: fmi3Instance, logging_on: fmi3Boolean, n_categories: usize, categories: *const fmi3String,
    ) -> fmi3Status {
        call(instance, Call::SetDebugLogging, |instance| {
            let pointers = slice("categories", categories, n_categories)?;
            let names: Option<Vec<_>> = pointers.iter().map(|&pointer| text(pointer)).collect();
            let names = names.ok_or(ArgumentError::Null("an entry of categories"))?;
            instance.set_debug_logging(logging_on != 0, &names)
        })
    }
    /// Sets tolerance and times of the experiment. From now on outputs follow start values.
    fmi3EnterInitializationMode(
        instance: fmi3Instance, tolerance_defined: fmi3Boolean, tolerance: fmi3Float64, start_time: fmi3Float64,
        stop_time_defined: fmi3Boolean, stop_time: fmi3Float64,
    ) -> fmi3Status {
        let tolerance = (tolerance_defined != 0).then_some(tolerance);
        let stop_time = (stop_time_defined != 0).then_some(stop_time);
        call(instance, Call::EnterInitializationMode, |instance| {
            instance.enter_initialization_mode(tolerance, start_time, stop_time)
        })
    }
    /// Fixes the parameters. Event mode follows if the importer uses it, else step mode.
    fmi3ExitInitializationMode(instance: fmi3Instance) -> fmi3Status {
        call(instance, Call::ExitInitializationMode, Instance::exit_initialization_mode)
    }
    /// From now on an event may be handled.
    fmi3EnterEventMode(instance: fmi3Instance) -> fmi3Status {
        call(instance, Call::EnterEventMode, Instance::enter_event_mode)
    }
    /// Handles the event: what is read from now on are right limits. One update is enough, and there are no time events.
    fmi3UpdateDiscreteStates(
        instance: fmi3Instance, discrete_states_need_update: *mut fmi3Boolean, terminate_simulation: *mut fmi3Boolean,
        nominals_of_continuous_states_changed: *mut fmi3Boolean, values_of_continuous_states_changed: *mut fmi3Boolean,
        next_event_time_defined: *mut fmi3Boolean, next_event_time: *mut fmi3Float64,
    ) -> fmi3Status {
        call(instance, Call::UpdateDiscreteStates, |instance| {
            let flags = [
                ("discreteStatesNeedUpdate", discrete_states_need_update),
                ("terminateSimulation", terminate_simulation),
                ("nominalsOfContinuousStatesChanged", nominals_of_continuous_states_changed),
                ("valuesOfContinuousStatesChanged", values_of_continuous_states_changed),
                ("nextEventTimeDefined", next_event_time_defined),
            ];
            for (name, flag) in flags {
                place(name, flag)?;
            }
            place("nextEventTime", next_event_time)?;
            let Update { states_changed, dead_end } = instance.update_discrete_states()?;
            for ((name, flag), answer) in flags.into_iter().zip([false, dead_end, false, states_changed, false]) {
                *place(name, flag)? = answer.into();
            }
            *place("nextEventTime", next_event_time)? = 0.0;
            Ok(())
        })
    }
    /// The next step can follow.
    fmi3EnterStepMode(instance: fmi3Instance) -> fmi3Status {
        call(instance, Call::EnterStepMode, Instance::enter_step_mode)
    }
    /// Moves the instance from the communication point by one step, or to an event or wherever the importer's callback
    /// wants to return.
    fmi3DoStep(
        instance: fmi3Instance, current_communication_point: fmi3Float64, communication_step_size: fmi3Float64,
        no_set_fmu_state_prior_to_current_point: fmi3Boolean, event_handling_needed: *mut fmi3Boolean,
        terminate_simulation: *mut fmi3Boolean, early_return: *mut fmi3Boolean, last_successful_time: *mut fmi3Float64,
    ) -> fmi3Status {
        let answers = Answers {
            event: event_handling_needed,
            terminate: terminate_simulation,
            early: early_return,
            time: last_successful_time,
        };
        let step = || do_step(instance, current_communication_point, communication_step_size, &answers);
        guarded(step).unwrap_or(fmi3Status::Fatal)
    }
    /// Ends the run; values can still be read.
    fmi3Terminate(instance: fmi3Instance) -> fmi3Status { call(instance, Call::Terminate, Instance::terminate) }
    /// Back to the state after instantiation.
    fmi3Reset(instance: fmi3Instance) -> fmi3Status { call(instance, Call::Reset, Instance::reset) }

    // Values: one for each reference, but for arrays, which can be read.
    /// No variable is of this type, so only an empty list is right.
    fmi3GetFloat32(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut fmi3Float32, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetFloat32, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "Float32")
        })
    }
    /// Reads real numbers, and the time.
    fmi3GetFloat64(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut fmi3Float64, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetFloat64, |instance| {
            let vr = slice("valueReferences", vr, nvr)?;
            let count = as_many("values", n_values, instance.value_count(vr)?)?;
            instance.get_float64(vr, slice_mut("values", values, count)?)
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3GetInt8(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut i8, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetInt8, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "Int8")
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3GetUInt8(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut u8, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetUInt8, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "UInt8")
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3GetInt16(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut i16, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetInt16, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "Int16")
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3GetUInt16(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut u16, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetUInt16, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "UInt16")
        })
    }
    /// Reads integers.
    fmi3GetInt32(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut i32, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetInt32, |instance| {
            let vr = slice("valueReferences", vr, nvr)?;
            let count = as_many("values", n_values, instance.value_count(vr)?)?;
            instance.get_int32(vr, slice_mut("values", values, count)?)
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3GetUInt32(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut u32, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetUInt32, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "UInt32")
        })
    }
    /// Reads enumerations.
    fmi3GetInt64(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut i64, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetInt64, |instance| {
            let vr = slice("valueReferences", vr, nvr)?;
            let count = as_many("values", n_values, instance.value_count(vr)?)?;
            instance.get_int64(vr, slice_mut("values", values, count)?)
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3GetUInt64(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut u64, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetUInt64, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "UInt64")
        })
    }
    /// Reads Booleans.
    fmi3GetBoolean(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut fmi3Boolean, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetBoolean, |instance| {
            let vr = slice("valueReferences", vr, nvr)?;
            let count = as_many("values", n_values, instance.value_count(vr)?)?;
            instance.get_boolean(vr, slice_mut("values", values, count)?)
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3GetString(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut fmi3String, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetString, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "String")
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3GetBinary(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, value_sizes: *mut usize,
        values: *mut fmi3Binary, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetBinary, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "Binary")
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3SetFloat32(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const fmi3Float32, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetFloat32, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "Float32")
        })
    }
    /// Sets real numbers, all or none.
    fmi3SetFloat64(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const fmi3Float64, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetFloat64, |instance| {
            let vr = slice("valueReferences", vr, nvr)?;
            instance.set_float64(vr, slice("values", values, as_many("values", n_values, nvr)?)?)
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3SetInt8(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const i8, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetInt8, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "Int8")
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3SetUInt8(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const u8, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetUInt8, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "UInt8")
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3SetInt16(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const i16, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetInt16, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "Int16")
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3SetUInt16(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const u16, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetUInt16, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "UInt16")
        })
    }
    /// Sets integers, all or none.
    fmi3SetInt32(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const i32, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetInt32, |instance| {
            let vr = slice("valueReferences", vr, nvr)?;
            instance.set_int32(vr, slice("values", values, as_many("values", n_values, nvr)?)?)
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3SetUInt32(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const u32, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetUInt32, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "UInt32")
        })
    }
    /// Sets enumerations, all or none.
    fmi3SetInt64(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const i64, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetInt64, |instance| {
            let vr = slice("valueReferences", vr, nvr)?;
            instance.set_int64(vr, slice("values", values, as_many("values", n_values, nvr)?)?)
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3SetUInt64(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const u64, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetUInt64, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "UInt64")
        })
    }
    /// Sets Booleans, all or none.
    fmi3SetBoolean(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const fmi3Boolean, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetBoolean, |instance| {
            let vr = slice("valueReferences", vr, nvr)?;
            instance.set_boolean(vr, slice("values", values, as_many("values", n_values, nvr)?)?)
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3SetString(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const fmi3String, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetString, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "String")
        })
    }
    /// No variable is of this type, so only an empty list is right.
    fmi3SetBinary(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, value_sizes: *const usize,
        values: *const fmi3Binary, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::SetBinary, |instance| {
            instance.check_absent(slice("valueReferences", vr, nvr)?, "Binary")
        })
    }
    /// Reads whether clocks are active.
    fmi3GetClock(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *mut fmi3Clock,
    ) -> fmi3Status {
        call(instance, Call::GetClock, |instance| {
            let vr = slice("valueReferences", vr, nvr)?;
            instance.get_clock(vr, slice_mut("values", values, nvr)?)
        })
    }
    /// First time derivatives of continuous outputs.
    fmi3GetOutputDerivatives(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, orders: *const i32,
        values: *mut fmi3Float64, n_values: usize,
    ) -> fmi3Status {
        call(instance, Call::GetOutputDerivatives, |instance| {
            let (vr, orders) = (slice("valueReferences", vr, nvr)?, slice("orders", orders, nvr)?);
            let values = slice_mut("values", values, as_many("values", n_values, nvr)?)?;
            instance.get_output_derivatives(vr, orders, values)
        })
    }
    /// Derivatives of unknowns along a direction of knowns.
    fmi3GetDirectionalDerivative(
        instance: fmi3Instance, unknowns: *const fmi3ValueReference, n_unknowns: usize,
        knowns: *const fmi3ValueReference, n_knowns: usize, seed: *const fmi3Float64, n_seed: usize,
        sensitivity: *mut fmi3Float64, n_sensitivity: usize,
    ) -> fmi3Status {
        call(instance, Call::GetDirectionalDerivative, |instance| {
            instance.directional_derivative(
                slice("unknowns", unknowns, n_unknowns)?,
                slice("knowns", knowns, n_knowns)?,
                slice("seed", seed, as_many("seed", n_seed, n_knowns)?)?,
                slice_mut("sensitivity", sensitivity, as_many("sensitivity", n_sensitivity, n_unknowns)?)?,
            )
        })
    }
    /// The transposed matrix of the same derivatives, times a vector of the unknowns' size.
    fmi3GetAdjointDerivative(
        instance: fmi3Instance, unknowns: *const fmi3ValueReference, n_unknowns: usize,
        knowns: *const fmi3ValueReference, n_knowns: usize, seed: *const fmi3Float64, n_seed: usize,
        sensitivity: *mut fmi3Float64, n_sensitivity: usize,
    ) -> fmi3Status {
        call(instance, Call::GetAdjointDerivative, |instance| {
            instance.adjoint_derivative(
                slice("unknowns", unknowns, n_unknowns)?,
                slice("knowns", knowns, n_knowns)?,
                slice("seed", seed, as_many("seed", n_seed, n_unknowns)?)?,
                slice_mut("sensitivity", sensitivity, as_many("sensitivity", n_sensitivity, n_knowns)?)?,
            )
        })
    }

    // Saved states. The importer holds handles, which are looked up and never followed.
    /// Saves the instance: under the state given, or a new one if that is NULL.
    fmi3GetFMUState(instance: fmi3Instance, state: *mut fmi3FMUState) -> fmi3Status {
        call(instance, Call::GetFMUState, |instance| {
            let state = place("FMUState", state)?;
            *state = without_provenance_mut(instance.get_fmu_state(state.addr())?);
            Ok(())
        })
    }
    /// Makes the instance what it was when the state was saved.
    fmi3SetFMUState(instance: fmi3Instance, state: fmi3FMUState) -> fmi3Status {
        call(instance, Call::SetFMUState, |instance| instance.set_fmu_state(state.addr()))
    }
    /// Forgets a state and sets it to NULL; NULL, and NULL for the place, are allowed.
    fmi3FreeFMUState(instance: fmi3Instance, state: *mut fmi3FMUState) -> fmi3Status {
        call(instance, Call::FreeFMUState, |instance| {
            if state.is_null() {
                return Ok(());
            }
            let state = place("FMUState", state)?;
            instance.free_fmu_state(state.addr())?;
            *state = null_mut();
            Ok(())
        })
    }
    /// Number of bytes that the state takes.
    fmi3SerializedFMUStateSize(instance: fmi3Instance, state: fmi3FMUState, size: *mut usize) -> fmi3Status {
        call(instance, Call::SerializedFMUStateSize, |instance| {
            let size = place("size", size)?;
            *size = instance.serialized_size(state.addr())?;
            Ok(())
        })
    }
    /// Writes the state as bytes.
    fmi3SerializeFMUState(
        instance: fmi3Instance, state: fmi3FMUState, bytes: *mut fmi3Byte, size: usize,
    ) -> fmi3Status {
        call(instance, Call::SerializeFMUState, |instance| {
            instance.serialize(state.addr(), slice_mut("serializedState", bytes, size)?)
        })
    }
    /// Reads bytes as a state: into the state given, or a new one if that is NULL.
    fmi3DeserializeFMUState(
        instance: fmi3Instance, bytes: *const fmi3Byte, size: usize, state: *mut fmi3FMUState,
    ) -> fmi3Status {
        call(instance, Call::DeserializeFMUState, |instance| {
            let bytes = slice("serializedState", bytes, size)?;
            let state = place("FMUState", state)?;
            *state = without_provenance_mut(instance.deserialize(bytes, state.addr())?);
            Ok(())
        })
    }

    // Model exchange.
    /// Makes an instance whose importer integrates; NULL, and one line in the log, if that cannot be.
    fmi3InstantiateModelExchange(
        instance_name: fmi3String, instantiation_token: fmi3String, resource_path: fmi3String, visible: fmi3Boolean,
        logging_on: fmi3Boolean, instance_environment: fmi3InstanceEnvironment,
        log_message: Option<fmi3LogMessageCallback>,
    ) -> fmi3Instance {
        let host = HostLogger::new(log_message, instance_environment);
        let request = Request {
            interface: Interface::ModelExchange,
            name: text(instance_name),
            token: text(instantiation_token),
            logging_on: logging_on != 0,
            steps: StepRequest::default(),
        };
        guarded(|| instantiate(&request, host, None)).unwrap_or(null_mut())
    }
    /// From now on the importer integrates.
    fmi3EnterContinuousTimeMode(instance: fmi3Instance) -> fmi3Status {
        call(instance, Call::EnterContinuousTimeMode, Instance::enter_continuous_time_mode)
    }
    /// Whether an event has been passed over. An importer that watches the event indicators hears of nothing new.
    fmi3CompletedIntegratorStep(
        instance: fmi3Instance, no_set_fmu_state_prior_to_current_point: fmi3Boolean,
        enter_event_mode: *mut fmi3Boolean, terminate_simulation: *mut fmi3Boolean,
    ) -> fmi3Status {
        call(instance, Call::CompletedIntegratorStep, |instance| {
            place("terminateSimulation", terminate_simulation)?;
            place("enterEventMode", enter_event_mode)?;
            let due = instance.slave().update_is_due()?;
            *place("terminateSimulation", terminate_simulation)? = 0;
            *place("enterEventMode", enter_event_mode)? = due.into();
            Ok(())
        })
    }
    /// Sets the importer's time.
    fmi3SetTime(instance: fmi3Instance, time: fmi3Float64) -> fmi3Status {
        call(instance, Call::SetTime, |instance| Ok(instance.slave().set_time(time)?))
    }
    /// Sets the continuous states.
    fmi3SetContinuousStates(instance: fmi3Instance, states: *const fmi3Float64, n_states: usize) -> fmi3Status {
        call(instance, Call::SetContinuousStates, |instance| {
            Ok(instance.slave().set_states(slice("continuousStates", states, n_states)?)?)
        })
    }
    /// Reads the derivatives of the continuous states.
    fmi3GetContinuousStateDerivatives(
        instance: fmi3Instance, derivatives: *mut fmi3Float64, n_states: usize,
    ) -> fmi3Status {
        call(instance, Call::GetContinuousStateDerivatives, |instance| {
            Ok(instance.slave().write_derivatives(slice_mut("derivatives", derivatives, n_states)?)?)
        })
    }
    /// Reads the event indicators.
    fmi3GetEventIndicators(instance: fmi3Instance, indicators: *mut fmi3Float64, n_indicators: usize) -> fmi3Status {
        call(instance, Call::GetEventIndicators, |instance| {
            Ok(instance.slave().write_indicators(slice_mut("eventIndicators", indicators, n_indicators)?)?)
        })
    }
    /// Reads the continuous states.
    fmi3GetContinuousStates(instance: fmi3Instance, states: *mut fmi3Float64, n_states: usize) -> fmi3Status {
        call(instance, Call::GetContinuousStates, |instance| {
            Ok(instance.slave().write_states(slice_mut("continuousStates", states, n_states)?)?)
        })
    }
    /// Reads the nominal values of the continuous states.
    fmi3GetNominalsOfContinuousStates(
        instance: fmi3Instance, nominals: *mut fmi3Float64, n_states: usize,
    ) -> fmi3Status {
        call(instance, Call::GetNominalsOfContinuousStates, |instance| {
            Ok(instance.slave().write_nominals(slice_mut("nominals", nominals, n_states)?)?)
        })
    }
    /// Number of event indicators.
    fmi3GetNumberOfEventIndicators(instance: fmi3Instance, n_indicators: *mut usize) -> fmi3Status {
        call(instance, Call::GetNumberOfEventIndicators, |instance| {
            let count = place("nEventIndicators", n_indicators)?;
            *count = instance.slave().indicator_count()?;
            Ok(())
        })
    }
    /// Number of continuous states.
    fmi3GetNumberOfContinuousStates(instance: fmi3Instance, n_states: *mut usize) -> fmi3Status {
        call(instance, Call::GetNumberOfContinuousStates, |instance| {
            let count = place("nContinuousStates", n_states)?;
            *count = instance.slave().state_count()?;
            Ok(())
        })
    }

    // Not provided.
    /// NULL: this FMU has no model partitions.
    fmi3InstantiateScheduledExecution(
        instance_name: fmi3String, instantiation_token: fmi3String, resource_path: fmi3String, visible: fmi3Boolean,
        logging_on: fmi3Boolean, instance_environment: fmi3InstanceEnvironment,
        log_message: Option<fmi3LogMessageCallback>, clock_update: Option<fmi3ClockUpdateCallback>,
        lock_preemption: Option<fmi3LockPreemptionCallback>, unlock_preemption: Option<fmi3UnlockPreemptionCallback>,
    ) -> fmi3Instance {
        let host = HostLogger::new(log_message, instance_environment);
        let name = text(instance_name);
        guarded(|| refuse_kind(Call::InstantiateScheduledExecution, name, host)).unwrap_or(null_mut())
    }
    fmi3ActivateModelPartition(
        instance: fmi3Instance, clock: fmi3ValueReference, activation_time: fmi3Float64,
    ) -> fmi3Status {
        call(instance, Call::ActivateModelPartition, |_| Ok(()))
    }
    fmi3EnterConfigurationMode(instance: fmi3Instance) -> fmi3Status {
        call(instance, Call::EnterConfigurationMode, |_| Ok(()))
    }
    fmi3ExitConfigurationMode(instance: fmi3Instance) -> fmi3Status {
        call(instance, Call::ExitConfigurationMode, |_| Ok(()))
    }
    fmi3SetClock(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, values: *const fmi3Clock,
    ) -> fmi3Status {
        call(instance, Call::SetClock, |_| Ok(()))
    }
    fmi3GetIntervalDecimal(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, intervals: *mut fmi3Float64,
        qualifiers: *mut fmi3IntervalQualifier,
    ) -> fmi3Status {
        call(instance, Call::GetIntervalDecimal, |_| Ok(()))
    }
    fmi3GetIntervalFraction(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, counters: *mut u64,
        resolutions: *mut u64, qualifiers: *mut fmi3IntervalQualifier,
    ) -> fmi3Status {
        call(instance, Call::GetIntervalFraction, |_| Ok(()))
    }
    fmi3GetShiftDecimal(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, shifts: *mut fmi3Float64,
    ) -> fmi3Status {
        call(instance, Call::GetShiftDecimal, |_| Ok(()))
    }
    fmi3GetShiftFraction(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, counters: *mut u64,
        resolutions: *mut u64,
    ) -> fmi3Status {
        call(instance, Call::GetShiftFraction, |_| Ok(()))
    }
    fmi3SetIntervalDecimal(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, intervals: *const fmi3Float64,
    ) -> fmi3Status {
        call(instance, Call::SetIntervalDecimal, |_| Ok(()))
    }
    fmi3SetIntervalFraction(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, counters: *const u64,
        resolutions: *const u64,
    ) -> fmi3Status {
        call(instance, Call::SetIntervalFraction, |_| Ok(()))
    }
    fmi3SetShiftDecimal(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, shifts: *const fmi3Float64,
    ) -> fmi3Status {
        call(instance, Call::SetShiftDecimal, |_| Ok(()))
    }
    fmi3SetShiftFraction(
        instance: fmi3Instance, vr: *const fmi3ValueReference, nvr: usize, counters: *const u64,
        resolutions: *const u64,
    ) -> fmi3Status {
        call(instance, Call::SetShiftFraction, |_| Ok(()))
    }
    fmi3EvaluateDiscreteStates(instance: fmi3Instance) -> fmi3Status {
        call(instance, Call::EvaluateDiscreteStates, |_| Ok(()))
    }
    fmi3GetNumberOfVariableDependencies(
        instance: fmi3Instance, vr: fmi3ValueReference, n_dependencies: *mut usize,
    ) -> fmi3Status {
        call(instance, Call::GetNumberOfVariableDependencies, |_| Ok(()))
    }
    fmi3GetVariableDependencies(
        instance: fmi3Instance, dependent: fmi3ValueReference, element_indices_of_dependent: *mut usize,
        independents: *mut fmi3ValueReference, element_indices_of_independents: *mut usize,
        dependency_kinds: *mut fmi3DependencyKind, n_dependencies: usize,
    ) -> fmi3Status {
        call(instance, Call::GetVariableDependencies, |_| Ok(()))
    }
}

/// The length of an array that has to have `needed` entries.
fn as_many(argument: &'static str, given: usize, needed: usize) -> Result<usize, Error> {
    if given == needed { Ok(given) } else { Err(Error::Length { argument, given, needed }) }
}
