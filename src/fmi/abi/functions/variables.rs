//! Reading and writing variables, and their derivatives.
#![allow(clippy::missing_safety_doc, reason = "said in the parent module")]

use super::super::super::instance::Instance;
use super::super::super::lifecycle::Call;
use super::super::super::status::Status;
use super::super::borrow::{slice, slice_mut};
use super::super::call::call;
use super::super::types::*;

/// Reads reals.
pub unsafe extern "C" fn fmi2GetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Real,
) -> Status {
    // SAFETY: the importer vouches for `nvr` entries of both arrays.
    let get =
        |instance: &mut Instance| unsafe { instance.get_real(slice("vr", vr, nvr)?, slice_mut("value", value, nvr)?) };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::GetReal, get) }
}

/// Sets reals, all or none.
pub unsafe extern "C" fn fmi2SetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Real,
) -> Status {
    // SAFETY: the importer vouches for `nvr` entries of both arrays.
    let set =
        |instance: &mut Instance| unsafe { instance.set_real(slice("vr", vr, nvr)?, slice("value", value, nvr)?) };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::SetReal, set) }
}

/// Reads integers and enumerations.
pub unsafe extern "C" fn fmi2GetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Integer,
) -> Status {
    // SAFETY: the importer vouches for `nvr` entries of both arrays.
    let get = |instance: &mut Instance| unsafe {
        instance.get_integer(slice("vr", vr, nvr)?, slice_mut("value", value, nvr)?)
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::GetInteger, get) }
}

/// Sets integers and enumerations, all or none.
pub unsafe extern "C" fn fmi2SetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Integer,
) -> Status {
    // SAFETY: the importer vouches for `nvr` entries of both arrays.
    let set =
        |instance: &mut Instance| unsafe { instance.set_integer(slice("vr", vr, nvr)?, slice("value", value, nvr)?) };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::SetInteger, set) }
}

/// Reads Booleans.
pub unsafe extern "C" fn fmi2GetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Boolean,
) -> Status {
    // SAFETY: the importer vouches for `nvr` entries of both arrays.
    let get = |instance: &mut Instance| unsafe {
        instance.get_boolean(slice("vr", vr, nvr)?, slice_mut("value", value, nvr)?)
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::GetBoolean, get) }
}

/// Sets Booleans, all or none.
pub unsafe extern "C" fn fmi2SetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Boolean,
) -> Status {
    // SAFETY: the importer vouches for `nvr` entries of both arrays.
    let set =
        |instance: &mut Instance| unsafe { instance.set_boolean(slice("vr", vr, nvr)?, slice("value", value, nvr)?) };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::SetBoolean, set) }
}

/// No variable is a string, so only an empty list is right.
pub unsafe extern "C" fn fmi2GetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    _value: *mut fmi2String,
) -> Status {
    // SAFETY: the importer vouches for `nvr` entries.
    let touch = |instance: &mut Instance| unsafe { instance.touch_string(slice("vr", vr, nvr)?) };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::GetString, touch) }
}

/// No variable is a string, so only an empty list is right.
pub unsafe extern "C" fn fmi2SetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    _value: *const fmi2String,
) -> Status {
    // SAFETY: the importer vouches for `nvr` entries.
    let touch = |instance: &mut Instance| unsafe { instance.touch_string(slice("vr", vr, nvr)?) };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::SetString, touch) }
}

/// Derivatives of real outputs along a direction of real inputs.
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: fmi2Component,
    unknown: *const fmi2ValueReference,
    n_unknown: usize,
    known: *const fmi2ValueReference,
    n_known: usize,
    dv_known: *const fmi2Real,
    dv_unknown: *mut fmi2Real,
) -> Status {
    // SAFETY: the importer vouches for `n_unknown` and `n_known` entries of two arrays each.
    let get = |instance: &mut Instance| unsafe {
        instance.directional_derivative(
            slice("vUnknown_ref", unknown, n_unknown)?,
            slice("vKnown_ref", known, n_known)?,
            slice("dvKnown", dv_known, n_known)?,
            slice_mut("dvUnknown", dv_unknown, n_unknown)?,
        )
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::GetDirectionalDerivative, get) }
}

/// Sets first time derivatives of real inputs, all or none.
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    order: *const fmi2Integer,
    value: *const fmi2Real,
) -> Status {
    // SAFETY: the importer vouches for `nvr` entries of the three arrays.
    let set = |instance: &mut Instance| unsafe {
        instance.set_input_derivatives(slice("vr", vr, nvr)?, slice("order", order, nvr)?, slice("value", value, nvr)?)
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::SetRealInputDerivatives, set) }
}

/// Reads first time derivatives of real outputs.
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    order: *const fmi2Integer,
    value: *mut fmi2Real,
) -> Status {
    // SAFETY: the importer vouches for `nvr` entries of the three arrays.
    let get = |instance: &mut Instance| unsafe {
        instance.get_output_derivatives(
            slice("vr", vr, nvr)?,
            slice("order", order, nvr)?,
            slice_mut("value", value, nvr)?,
        )
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::GetRealOutputDerivatives, get) }
}
