//! Functions beside those of FMI 3.0, for estimators. They are allowed where `fmi3DoStep` is; a refused call changes
//! nothing. `fmu-harness/docs/guide.md` has their C prototypes.
//!
//! # Safety
//! As of the [functions](super::functions) of the standard.
#![allow(clippy::missing_safety_doc, reason = "said above, once")]
#![allow(non_snake_case, non_camel_case_types, reason = "the names are in the standard's style")]

use super::super::lifecycle::Call;
use super::call::call_as;
use super::types::*;
use crate::fmi::abi::declare::functions;
use crate::fmi::abi::estimation::{self, StepArrays};

functions! {
    /// Writes the names of the numbers of a phase, each with a line feed at its end and a zero byte behind the last, and
    /// the size that they need. With NULL for `names` only the size is written.
    slidercrank_fmi3_phase_names(c: fmi3Instance, names: *mut fmi3Byte, size: *mut usize) -> fmi3Status {
        call_as(c, "slidercrank_fmi3_phase_names", Call::DoStep, |instance| {
            estimation::phase_names(instance.slave(), names.cast(), size)
        })
    }
    /// Makes a step on a copy of the instance: the phase before and after it, the outputs after it, and their derivatives
    /// by the phase before and by parameters and inputs. With NULL for `phase` only the number of the phase's numbers is
    /// written; with NULL for `nextPhaseByPhase` there are no derivatives.
    slidercrank_fmi3_step_jacobian(
        c: fmi3Instance, step: fmi3Float64, parameters: *const fmi3ValueReference, n_parameters: usize,
        outputs: *const fmi3ValueReference, n_outputs: usize, n_phase: *mut usize, phase: *mut fmi3Float64,
        next_phase: *mut fmi3Float64, next_outputs: *mut fmi3Float64, next_phase_by_phase: *mut fmi3Float64,
        next_phase_by_parameters: *mut fmi3Float64, next_outputs_by_phase: *mut fmi3Float64,
        next_outputs_by_parameters: *mut fmi3Float64,
    ) -> fmi3Status {
        let arrays = StepArrays {
            parameters, n_parameters, outputs, n_outputs, n_phase, phase, next_phase, next_outputs,
            next_phase_by_phase, next_phase_by_parameters, next_outputs_by_phase, next_outputs_by_parameters,
        };
        call_as(c, "slidercrank_fmi3_step_jacobian", Call::DoStep, |instance| {
            estimation::step_jacobian(instance.slave(), step, &arrays)
        })
    }
    /// Continues from this phase at the communication point, and with these values of real parameters.
    slidercrank_fmi3_set_phase(
        c: fmi3Instance, phase: *const fmi3Float64, n_phase: usize, parameters: *const fmi3ValueReference,
        n_parameters: usize, values: *const fmi3Float64,
    ) -> fmi3Status {
        call_as(c, "slidercrank_fmi3_set_phase", Call::DoStep, |instance| {
            estimation::set_phase(instance.slave(), [(phase, n_phase), (values, n_parameters)], parameters)
        })
    }
}
