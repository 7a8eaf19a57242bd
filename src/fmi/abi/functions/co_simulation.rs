//! Steps and what came of them.
#![allow(clippy::missing_safety_doc, reason = "said in the parent module")]

use super::super::super::error::Error;
use super::super::super::instance::Instance;
use super::super::super::lifecycle::Call;
use super::super::super::status::{Status, StatusKind};
use super::super::borrow::{AnyBits, place};
use super::super::call::call;
use super::super::types::*;

/// Moves the instance from the communication point by one step. The step is over when the call
/// returns, so nothing need be kept for a later question about an earlier point.
pub unsafe extern "C" fn fmi2DoStep(
    c: fmi2Component,
    current_communication_point: fmi2Real,
    communication_step_size: fmi2Real,
    _no_set_fmu_state_prior_to_current_point: fmi2Boolean,
) -> Status {
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::DoStep, |instance| instance.do_step(current_communication_point, communication_step_size)) }
}

/// No step is ever under way, so none can be canceled: the lifecycle refuses this in every state.
pub unsafe extern "C" fn fmi2CancelStep(c: fmi2Component) -> Status {
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::CancelStep, |_| Ok(())) }
}

/// One status query: reads the kind, asks the instance, writes the answer.
///
/// # Safety
/// As for every function here; `value` is NULL or the place of a `T`.
unsafe fn query<T: AnyBits>(
    c: fmi2Component,
    function: Call,
    kind: fmi2StatusKind,
    value: *mut T,
    ask: fn(&Instance, StatusKind) -> Result<T, Error>,
) -> Status {
    let tell = |instance: &mut Instance| {
        // SAFETY: the importer vouches for the place.
        let value = unsafe { place("value", value)? };
        *value = ask(instance, StatusKind::read(kind)?)?;
        Ok(())
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, function, tell) }
}

/// Status of the last step.
pub unsafe extern "C" fn fmi2GetStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut i32) -> Status {
    let ask = |instance: &Instance, kind| instance.step_status(kind).map(|status| status as i32);
    // SAFETY: passed on.
    unsafe { query(c, Call::GetStatus, s, value, ask) }
}

/// The time that the last step reached.
pub unsafe extern "C" fn fmi2GetRealStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Real) -> Status {
    // SAFETY: passed on.
    unsafe { query(c, Call::GetRealStatus, s, value, Instance::real_status) }
}

/// The standard has no integer status.
pub unsafe extern "C" fn fmi2GetIntegerStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Integer) -> Status {
    // SAFETY: passed on.
    unsafe { query(c, Call::GetIntegerStatus, s, value, |instance, kind| instance.no_status(kind)) }
}

/// Whether the instance wants the simulation to end.
pub unsafe extern "C" fn fmi2GetBooleanStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Boolean) -> Status {
    let ask = |instance: &Instance, kind| instance.boolean_status(kind).map(fmi2Boolean::from);
    // SAFETY: passed on.
    unsafe { query(c, Call::GetBooleanStatus, s, value, ask) }
}

/// The standard's only string status is about a step under way, and none ever is.
pub unsafe extern "C" fn fmi2GetStringStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2String) -> Status {
    // SAFETY: passed on.
    unsafe { query(c, Call::GetStringStatus, s, value, |instance, kind| instance.no_status(kind)) }
}
