//! Functions beside those of FMI 2.0, for estimators. They are allowed where `fmi2DoStep` is; a refused call changes
//! nothing. `fmu-harness/docs/guide.md` has their C prototypes.
//!
//! # Safety
//! As of the [functions](super::functions) of the standard.
#![allow(clippy::missing_safety_doc, reason = "said above, once")]
#![allow(non_snake_case, non_camel_case_types, reason = "the names are in the standard's style")]

use super::super::lifecycle::Call;
use super::call::call_as;
use super::types::*;
use crate::fmi::abi::ArgumentError;
use crate::fmi::abi::borrow::{AnyBits, place, slice, slice_mut};
use crate::fmi::abi::declare::functions;
use crate::fmi::slave::access::check_count;
use crate::fmi::slave::estimation::{PHASE, Step};

functions! {
    /// Writes the names of the numbers of a phase, each with a line feed at its end and a zero byte behind the last, and
    /// the size that they need. With NULL for `names` only the size is written.
    slidercrank_phase_names(c: fmi2Component, names: *mut fmi2Byte, size: *mut usize) -> fmi2Status {
        call_as(c, "slidercrank_phase_names", Call::DoStep, |instance| {
            let size = place("size", size)?;
            let names_found: String = instance.slave().phase_names().iter().map(|name| format!("{name}\n")).collect();
            let needed = names_found.len() + 1;
            if !names.is_null() {
                check_count("bytes of names", *size, needed)?;
                let (text, end) = slice_mut("names", names.cast::<u8>(), needed)?.split_at_mut(needed - 1);
                text.copy_from_slice(names_found.as_bytes());
                end.fill(0);
            }
            *size = needed;
            Ok(())
        })
    }
    /// Makes a step on a copy of the instance: the phase before and after it, the outputs after it, and their derivatives
    /// by the phase before and by parameters and inputs. With NULL for `phase` only the number of the phase's numbers is
    /// written; with NULL for `nextPhaseByPhase` there are no derivatives.
    slidercrank_step_jacobian(
        c: fmi2Component, step: fmi2Real, parameters: *const fmi2ValueReference, n_parameters: usize,
        outputs: *const fmi2ValueReference, n_outputs: usize, n_phase: *mut usize, phase: *mut fmi2Real,
        next_phase: *mut fmi2Real, next_outputs: *mut fmi2Real, next_phase_by_phase: *mut fmi2Real,
        next_phase_by_parameters: *mut fmi2Real, next_outputs_by_phase: *mut fmi2Real,
        next_outputs_by_parameters: *mut fmi2Real,
    ) -> fmi2Status {
        call_as(c, "slidercrank_step_jacobian", Call::DoStep, |instance| {
            let (given, count) = (place("nPhase", n_phase)?, instance.slave().phase_count());
            if phase.is_null() {
                *given = count;
                return Ok(());
            }
            check_count(PHASE, *given, count)?;
            let parameters = slice("parameters", parameters, n_parameters)?;
            let references = slice("outputs", outputs, n_outputs)?;
            let of_values = [
                ("phase", phase, count),
                ("nextPhase", next_phase, count),
                ("nextOutputs", next_outputs, n_outputs),
            ];
            let of_derivatives = [
                ("nextPhaseByPhase", next_phase_by_phase, count * count),
                ("nextPhaseByParameters", next_phase_by_parameters, count * n_parameters),
                ("nextOutputsByPhase", next_outputs_by_phase, n_outputs * count),
                ("nextOutputsByParameters", next_outputs_by_parameters, n_outputs.saturating_mul(n_parameters)),
            ];
            let wanted = !next_phase_by_phase.is_null();
            for (name, pointer, length) in of_values.into_iter().chain(of_derivatives.into_iter().filter(|_| wanted)) {
                slice_mut(name, pointer, length)?;
            }
            let Step { phase, next, outputs, derivatives } =
                instance.slave().mapped_step(step, parameters, references, wanted)?;
            for (array, values) in of_values.into_iter().zip([phase, next, outputs]) {
                write(array, &values)?;
            }
            if let Some(found) = derivatives {
                let found =
                    [found.phase_by_phase, found.phase_by_others, found.outputs_by_phase, found.outputs_by_others];
                for (array, values) in of_derivatives.into_iter().zip(found) {
                    write(array, &values)?;
                }
            }
            Ok(())
        })
    }
    /// Continues from this phase at the communication point, and with these values of real parameters.
    slidercrank_set_phase(
        c: fmi2Component, phase: *const fmi2Real, n_phase: usize, parameters: *const fmi2ValueReference,
        n_parameters: usize, values: *const fmi2Real,
    ) -> fmi2Status {
        call_as(c, "slidercrank_set_phase", Call::DoStep, |instance| {
            let (phase, parameters) =
                (slice("phase", phase, n_phase)?, slice("parameters", parameters, n_parameters)?);
            Ok(instance.slave().set_phase(phase, parameters, slice("values", values, n_parameters)?)?)
        })
    }
}

/// An array of the importer: its name, its start and its length.
type Array<T> = (&'static str, *mut T, usize);

/// Writes an array whose length is that of the values. Arrays are borrowed one after the other, since an importer may pass
/// one memory twice.
///
/// # Safety
/// As [`slice_mut`].
unsafe fn write<T: AnyBits>((name, start, length): Array<T>, values: &[T]) -> Result<(), ArgumentError> {
    // SAFETY: passed on.
    unsafe { slice_mut(name, start, length) }?.copy_from_slice(values);
    Ok(())
}
