//! Saved states: to memory, to bytes and back.
#![allow(clippy::missing_safety_doc, reason = "said in the parent module")]

use super::super::super::instance::Instance;
use super::super::super::lifecycle::Call;
use super::super::super::status::Status;
use super::super::borrow::{place, slice, slice_mut};
use super::super::call::call;
use super::super::types::*;
use std::ptr::{null_mut, without_provenance_mut};

/// Saves the instance: under the state given, or a new one if that is NULL.
pub unsafe extern "C" fn fmi2GetFMUstate(c: fmi2Component, state: *mut fmi2FMUstate) -> Status {
    let get = |instance: &mut Instance| {
        // SAFETY: the importer vouches for the place.
        let state = unsafe { place("FMUstate", state)? };
        *state = without_provenance_mut(instance.get_fmu_state(state.addr())?);
        Ok(())
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::GetFMUstate, get) }
}

/// Makes the instance what it was when the state was saved.
pub unsafe extern "C" fn fmi2SetFMUstate(c: fmi2Component, state: fmi2FMUstate) -> Status {
    // SAFETY: the importer vouches for `c`; the state is looked up, not followed.
    unsafe { call(c, Call::SetFMUstate, |instance| instance.set_fmu_state(state.addr())) }
}

/// Forgets a state and sets it to NULL; NULL, and NULL for the place, are allowed.
pub unsafe extern "C" fn fmi2FreeFMUstate(c: fmi2Component, state: *mut fmi2FMUstate) -> Status {
    let free = |instance: &mut Instance| {
        if state.is_null() {
            return Ok(());
        }
        // SAFETY: the importer vouches for the place.
        let state = unsafe { place("FMUstate", state)? };
        instance.free_fmu_state(state.addr())?;
        *state = null_mut();
        Ok(())
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::FreeFMUstate, free) }
}

/// Number of bytes that the state takes.
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(c: fmi2Component, state: fmi2FMUstate, size: *mut usize) -> Status {
    let tell = |instance: &mut Instance| {
        // SAFETY: the importer vouches for the place.
        let size = unsafe { place("size", size)? };
        *size = instance.serialized_size(state.addr())?;
        Ok(())
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::SerializedFMUstateSize, tell) }
}

/// Writes the state as bytes.
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: fmi2Component,
    state: fmi2FMUstate,
    bytes: *mut fmi2Byte,
    size: usize,
) -> Status {
    let write = |instance: &mut Instance| {
        // SAFETY: the importer vouches for `size` bytes.
        let buffer = unsafe { slice_mut("serializedState", bytes.cast::<u8>(), size)? };
        instance.serialize(state.addr(), buffer)
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::SerializeFMUstate, write) }
}

/// Reads bytes as a state: into the state given, or a new one if that is NULL.
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: fmi2Component,
    bytes: *const fmi2Byte,
    size: usize,
    state: *mut fmi2FMUstate,
) -> Status {
    let read = |instance: &mut Instance| {
        // SAFETY: the importer vouches for `size` bytes and for the place.
        let (bytes, state) =
            unsafe { (slice("serializedState", bytes.cast::<u8>(), size)?, place("FMUstate", state)?) };
        *state = without_provenance_mut(instance.deserialize(bytes, state.addr())?);
        Ok(())
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::DeSerializeFMUstate, read) }
}
