//! Each call of the standard with sound arguments.

use crate::host::{Slave, vr};
use Call::*;
use slidercrank::fmi::Status;
use slidercrank::fmi::abi::types::{fmi2EventInfo, fmi2FMUstate, fmi2String};
use slidercrank::fmi::lifecycle::Call;
use std::ptr::null;

/// Makes a call with sound arguments; `None` if it has no status.
pub fn perform(call: Call, slave: &Slave, saved: fmi2FMUstate) -> Option<Status> {
    let (api, c) = (slave.api, slave.c);
    let (mut real, mut integer, mut size, mut string): (f64, i32, usize, fmi2String) = (0.0, 0, 0, null());
    let (mut flag, mut bytes, mut state) = (0, slave.bytes_of(saved), saved);
    let mut info = fmi2EventInfo {
        new_discrete_states_needed: 0,
        terminate_simulation: 0,
        nominals_of_continuous_states_changed: 0,
        values_of_continuous_states_changed: 0,
        next_event_time_defined: 0,
        next_event_time: 0.0,
    };
    let (input, output, gravity, model) = (vr("slider.load"), vr("slider.x"), vr("gravity"), vr("joint.C.model"));
    let one = 1;
    // SAFETY: live component, arrays and places of the lengths said.
    Some(unsafe {
        match call {
            GetTypesPlatform | GetVersion | Instantiate | FreeInstance => return None,
            SetDebugLogging => (api.SetDebugLogging)(c, 1, 0, null()),
            SetupExperiment => (api.SetupExperiment)(c, 0, 0.0, 0.0, 0, 0.0),
            EnterInitializationMode => (api.EnterInitializationMode)(c),
            ExitInitializationMode => (api.ExitInitializationMode)(c),
            Terminate => (api.Terminate)(c),
            Reset => (api.Reset)(c),
            GetReal => (api.GetReal)(c, &gravity, 1, &mut real),
            GetInteger => (api.GetInteger)(c, &model, 1, &mut integer),
            GetBoolean => (api.GetBoolean)(c, null(), 0, &mut flag),
            GetString => (api.GetString)(c, null(), 0, &mut string),
            SetReal => (api.SetReal)(c, &input, 1, &real),
            SetInteger => (api.SetInteger)(c, null(), 0, &integer),
            SetBoolean => (api.SetBoolean)(c, null(), 0, &flag),
            SetString => (api.SetString)(c, null(), 0, &string),
            GetFMUstate => (api.GetFMUstate)(c, &mut state),
            SetFMUstate => (api.SetFMUstate)(c, state),
            FreeFMUstate => (api.FreeFMUstate)(c, &mut state),
            SerializedFMUstateSize => (api.SerializedFMUstateSize)(c, state, &mut size),
            SerializeFMUstate => (api.SerializeFMUstate)(c, state, bytes.as_mut_ptr().cast(), bytes.len()),
            DeSerializeFMUstate => (api.DeSerializeFMUstate)(c, bytes.as_ptr().cast(), bytes.len(), &mut state),
            GetDirectionalDerivative => (api.GetDirectionalDerivative)(c, &output, 1, &input, 1, &1.0, &mut real),
            SetRealInputDerivatives => (api.SetRealInputDerivatives)(c, &input, 1, &one, &real),
            GetRealOutputDerivatives => (api.GetRealOutputDerivatives)(c, &output, 1, &one, &mut real),
            DoStep => (api.DoStep)(c, 0.0, 1e-3, 1),
            CancelStep => (api.CancelStep)(c),
            GetStatus => (api.GetStatus)(c, 0, &mut integer),
            GetRealStatus => (api.GetRealStatus)(c, 2, &mut real),
            GetIntegerStatus => (api.GetIntegerStatus)(c, 0, &mut integer),
            GetBooleanStatus => (api.GetBooleanStatus)(c, 3, &mut flag),
            GetStringStatus => (api.GetStringStatus)(c, 1, &mut string),
            EnterEventMode => (api.EnterEventMode)(c),
            NewDiscreteStates => (api.NewDiscreteStates)(c, &mut info),
            EnterContinuousTimeMode => (api.EnterContinuousTimeMode)(c),
            CompletedIntegratorStep => (api.CompletedIntegratorStep)(c, 1, &mut flag, &mut integer),
            SetTime => (api.SetTime)(c, 0.0),
            SetContinuousStates => (api.SetContinuousStates)(c, &real, 1),
            GetDerivatives => (api.GetDerivatives)(c, &mut real, 1),
            GetEventIndicators => (api.GetEventIndicators)(c, &mut real, 1),
            GetContinuousStates => (api.GetContinuousStates)(c, &mut real, 1),
            GetNominalsOfContinuousStates => (api.GetNominalsOfContinuousStates)(c, &mut real, 1),
        }
    })
}
