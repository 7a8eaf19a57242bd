//! The functions of model exchange. Some importers bind them blindly, so they are there; the
//! lifecycle refuses them in every state.
#![allow(clippy::missing_safety_doc, reason = "said in the parent module")]

use super::super::super::lifecycle::Call;
use super::super::super::status::Status;
use super::super::call::call;
use super::super::types::*;

/// Exports functions that do nothing but be refused.
macro_rules! refused {
    ($($export:ident = $call:ident ($($argument:ident: $type:ty),*);)+) => {
        $(
            /// Refused: of model exchange.
            pub unsafe extern "C" fn $export(c: fmi2Component $(, $argument: $type)*) -> Status {
                $(let _ = $argument;)*
                // SAFETY: the importer vouches for `c`.
                unsafe { call(c, Call::$call, |_| Ok(())) }
            }
        )+
    };
}

refused! {
    fmi2EnterEventMode = EnterEventMode();
    fmi2NewDiscreteStates = NewDiscreteStates(event_info: *mut fmi2EventInfo);
    fmi2EnterContinuousTimeMode = EnterContinuousTimeMode();
    fmi2CompletedIntegratorStep = CompletedIntegratorStep(no_set_fmu_state_prior_to_current_point: fmi2Boolean, enter_event_mode: *mut fmi2Boolean, terminate_simulation: *mut fmi2Boolean);
    fmi2SetTime = SetTime(time: fmi2Real);
    fmi2SetContinuousStates = SetContinuousStates(x: *const fmi2Real, nx: usize);
    fmi2GetDerivatives = GetDerivatives(derivatives: *mut fmi2Real, nx: usize);
    fmi2GetEventIndicators = GetEventIndicators(event_indicators: *mut fmi2Real, ni: usize);
    fmi2GetContinuousStates = GetContinuousStates(x: *mut fmi2Real, nx: usize);
    fmi2GetNominalsOfContinuousStates = GetNominalsOfContinuousStates(x_nominal: *mut fmi2Real, nx: usize);
}
