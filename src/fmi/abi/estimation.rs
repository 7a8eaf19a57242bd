//! The functions for estimators, beside those of the standards: one list and one body for every version of FMI.
//! `fmu-harness/docs/guide.md` has their C prototypes.
//!
//! # Safety
//! As of the functions of the standards: a non-NULL pointer points to one entry, or to as many as the length beside it says.

use super::ArgumentError;
use super::borrow::{AnyBits, place, slice, slice_mut};
use crate::fmi::slave::access::check_count;
use crate::fmi::slave::estimation::{PHASE, Step};
use crate::fmi::slave::{Error, Slave};

/// Declares the functions of one version under these names. Where the macro stands, `call_as` and `Call` are those of the
/// version, whose step must be allowed.
macro_rules! estimators {
    ($phase_names:ident $step_jacobian:ident $set_phase:ident) => {
        $crate::fmi::abi::declare::functions! {
            /// Writes the names of the numbers of a phase, each with a line feed at its end and a zero byte behind the
            /// last, and the size that they need. With NULL for `names` only the size is written.
            $phase_names(c: *mut c_void, names: *mut c_char, size: *mut usize) -> Status {
                call_as(c, stringify!($phase_names), Call::DoStep, |instance| {
                    estimation::phase_names(instance.slave(), names.cast(), size)
                })
            }
            /// Makes a step on a copy of the instance: the phase before and after it, the outputs after it, and their
            /// derivatives by the phase before and by parameters and inputs. With NULL for `phase` only the number of the
            /// phase's numbers is written; with NULL for `nextPhaseByPhase` there are no derivatives.
            $step_jacobian(
                c: *mut c_void, step: f64, parameters: *const u32, n_parameters: usize, outputs: *const u32,
                n_outputs: usize, n_phase: *mut usize, phase: *mut f64, next_phase: *mut f64, next_outputs: *mut f64,
                next_phase_by_phase: *mut f64, next_phase_by_parameters: *mut f64, next_outputs_by_phase: *mut f64,
                next_outputs_by_parameters: *mut f64,
            ) -> Status {
                let arrays = estimation::StepArrays {
                    parameters, n_parameters, outputs, n_outputs, n_phase, phase, next_phase, next_outputs,
                    next_phase_by_phase, next_phase_by_parameters, next_outputs_by_phase, next_outputs_by_parameters,
                };
                call_as(c, stringify!($step_jacobian), Call::DoStep, |instance| {
                    estimation::step_jacobian(instance.slave(), step, &arrays)
                })
            }
            /// Continues from this phase at the communication point, and with these values of real parameters.
            $set_phase(
                c: *mut c_void, phase: *const f64, n_phase: usize, parameters: *const u32, n_parameters: usize,
                values: *const f64,
            ) -> Status {
                call_as(c, stringify!($set_phase), Call::DoStep, |instance| {
                    estimation::set_phase(instance.slave(), [(phase, n_phase), (values, n_parameters)], parameters)
                })
            }
        }
    };
}

pub(crate) use estimators;

/// The arrays of `step_jacobian`. Those of the phase have as many entries as a phase has numbers; matrices stand row by row.
pub struct StepArrays {
    /// References of the parameters and inputs.
    pub parameters: *const u32,
    /// Their number.
    pub n_parameters: usize,
    /// References of the outputs.
    pub outputs: *const u32,
    /// Their number.
    pub n_outputs: usize,
    /// The number of a phase's numbers.
    pub n_phase: *mut usize,
    /// The phase before the step; NULL if only their number is asked for.
    pub phase: *mut f64,
    /// The phase after the step.
    pub next_phase: *mut f64,
    /// The outputs after the step.
    pub next_outputs: *mut f64,
    /// The derivatives of the phase by the phase before; NULL if there are to be no derivatives.
    pub next_phase_by_phase: *mut f64,
    /// The derivatives of the phase by the parameters.
    pub next_phase_by_parameters: *mut f64,
    /// The derivatives of the outputs by the phase before.
    pub next_outputs_by_phase: *mut f64,
    /// The derivatives of the outputs by the parameters.
    pub next_outputs_by_parameters: *mut f64,
}

/// Writes the names of the numbers of a phase, each with a line feed at its end and a zero byte behind the last, and the
/// size that they need. With NULL for `names` only the size is written.
///
/// # Safety
/// See above.
pub unsafe fn phase_names<E>(slave: &Slave, names: *mut u8, size: *mut usize) -> Result<(), E>
where
    E: From<ArgumentError> + From<Error>,
{
    // SAFETY: passed on.
    let size = unsafe { place("size", size) }?;
    let found: String = slave.phase_names().iter().map(|name| format!("{name}\n")).collect();
    let needed = found.len() + 1;
    if !names.is_null() {
        check_count("bytes of names", *size, needed)?;
        // SAFETY: passed on.
        let (text, end) = unsafe { slice_mut("names", names, needed) }?.split_at_mut(needed - 1);
        text.copy_from_slice(found.as_bytes());
        end.fill(0);
    }
    *size = needed;
    Ok(())
}

/// Makes a step of `size` [s] on a copy: the phase before and after it, the outputs after it, and their derivatives by the
/// phase before and by parameters and inputs. An error leaves the arrays as they were.
///
/// # Safety
/// See above.
pub unsafe fn step_jacobian<E>(slave: &mut Slave, size: f64, arrays: &StepArrays) -> Result<(), E>
where
    E: From<ArgumentError> + From<Error>,
{
    let StepArrays { n_parameters, n_outputs, phase, next_phase_by_phase, .. } = *arrays;
    // SAFETY: passed on.
    let (given, count) = (unsafe { place("nPhase", arrays.n_phase) }?, slave.phase_count());
    if phase.is_null() {
        *given = count;
        return Ok(());
    }
    check_count(PHASE, *given, count)?;
    // SAFETY: passed on.
    let parameters = unsafe { slice("parameters", arrays.parameters, n_parameters) }?;
    // SAFETY: passed on.
    let references = unsafe { slice("outputs", arrays.outputs, n_outputs) }?;
    let of_values = [
        ("phase", phase, count),
        ("nextPhase", arrays.next_phase, count),
        ("nextOutputs", arrays.next_outputs, n_outputs),
    ];
    let of_derivatives = [
        ("nextPhaseByPhase", next_phase_by_phase, count * count),
        ("nextPhaseByParameters", arrays.next_phase_by_parameters, count * n_parameters),
        ("nextOutputsByPhase", arrays.next_outputs_by_phase, n_outputs * count),
        ("nextOutputsByParameters", arrays.next_outputs_by_parameters, n_outputs.saturating_mul(n_parameters)),
    ];
    let wanted = !next_phase_by_phase.is_null();
    for (name, pointer, length) in of_values.into_iter().chain(of_derivatives.into_iter().filter(|_| wanted)) {
        // SAFETY: passed on.
        unsafe { slice_mut(name, pointer, length) }?;
    }
    let Step { phase, next, outputs, derivatives } = slave.mapped_step(size, parameters, references, wanted)?;
    for (array, values) in of_values.into_iter().zip([phase, next, outputs]) {
        // SAFETY: passed on.
        unsafe { write(array, &values) }?;
    }
    if let Some(found) = derivatives {
        let found = [found.phase_by_phase, found.phase_by_others, found.outputs_by_phase, found.outputs_by_others];
        for (array, values) in of_derivatives.into_iter().zip(found) {
            // SAFETY: passed on.
            unsafe { write(array, &values) }?;
        }
    }
    Ok(())
}

/// Continues from a phase at the communication point, and with `values` of the real `parameters`.
///
/// # Safety
/// See above.
pub unsafe fn set_phase<E>(
    slave: &mut Slave,
    [phase, values]: [(*const f64, usize); 2],
    parameters: *const u32,
) -> Result<(), E>
where
    E: From<ArgumentError> + From<Error>,
{
    // SAFETY: passed on.
    let phase = unsafe { slice("phase", phase.0, phase.1) }?;
    // SAFETY: passed on.
    let parameters = unsafe { slice("parameters", parameters, values.1) }?;
    // SAFETY: passed on.
    let values = unsafe { slice("values", values.0, values.1) }?;
    Ok(slave.set_phase(phase, parameters, values)?)
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
