//! Every function that takes value references, in every state, with every variable there is.

use crate::stage::{STATES, Stage};
use host::{Slave, vr};
use slidercrank::fmi::slave::variables::{Access, VARIABLES, Variable};
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::lifecycle::Call::{self, *};
use slidercrank::fmi::v2::lifecycle::{State, Touch};
use slidercrank::scene::parameter::{Kind, Parameter};

/// What a variable is to the functions that reach it.
struct Nature {
    /// The type of `fmi2Get…` and `fmi2Set…`.
    get: Call,
    set: Call,
    reading: Touch,
    writing: Touch,
    /// Its start value, or any.
    value: f64,
}

fn nature(variable: &Variable) -> Nature {
    let output = |get, set| Nature { get, set, reading: Touch::GetOutput, writing: Touch::SetOutput, value: 1.0 };
    let parameter =
        |get, set, value| Nature { get, set, reading: Touch::GetParameter, writing: Touch::SetParameter, value };
    match variable.access {
        Access::Input { start, .. } => {
            Nature { get: GetReal, set: SetReal, reading: Touch::GetInput, writing: Touch::SetInput, value: start }
        }
        Access::RealOutput(_) | Access::State(_) | Access::Derivative(_) => output(GetReal, SetReal),
        Access::IntegerOutput(_) => output(GetInteger, SetInteger),
        Access::BooleanOutput(_) => output(GetBoolean, SetBoolean),
        Access::Parameter(parameter_of) => {
            let Parameter { kind, .. } = parameter_of;
            let value = parameter_of.start();
            match kind {
                Kind::Real { .. } => parameter(GetReal, SetReal, value),
                Kind::Integer { .. } | Kind::Enumeration { .. } => parameter(GetInteger, SetInteger, value),
                Kind::Boolean { .. } => parameter(GetBoolean, SetBoolean, value),
            }
        }
    }
}

/// Calls a function with one reference; its answer, unless it takes two kinds of them.
fn touch(slave: &Slave, call: Call, reference: u32, value: f64) -> Status {
    let (api, c) = (slave.api, slave.c);
    let (mut real, mut integer, mut text) = (value, value as i32, std::ptr::null());
    // SAFETY: live component, arrays of one entry.
    unsafe {
        match call {
            GetReal => (api.GetReal)(c, &reference, 1, &mut real),
            GetInteger => (api.GetInteger)(c, &reference, 1, &mut integer),
            GetBoolean => (api.GetBoolean)(c, &reference, 1, &mut integer),
            GetString => (api.GetString)(c, &reference, 1, &mut text),
            SetReal => (api.SetReal)(c, &reference, 1, &real),
            SetInteger => (api.SetInteger)(c, &reference, 1, &integer),
            SetBoolean => (api.SetBoolean)(c, &reference, 1, &integer),
            SetString => (api.SetString)(c, &reference, 1, &text),
            SetRealInputDerivatives => (api.SetRealInputDerivatives)(c, &reference, 1, &1, &real),
            GetRealOutputDerivatives => (api.GetRealOutputDerivatives)(c, &reference, 1, &1, &mut real),
            other => panic!("{}", other.name()),
        }
    }
}

const CALLS: [Call; 10] = [
    GetReal,
    GetInteger,
    GetBoolean,
    GetString,
    SetReal,
    SetInteger,
    SetBoolean,
    SetString,
    SetRealInputDerivatives,
    GetRealOutputDerivatives,
];

fn possible(call: Call, variable: &Variable, stage: &Stage) -> bool {
    let Nature { get, set, reading, writing, .. } = nature(variable);
    call.allowed(stage.state)
        && match call {
            SetRealInputDerivatives => matches!(variable.access, Access::Input { .. }),
            GetRealOutputDerivatives => matches!(variable.access, Access::RealOutput(_)),
            _ => (call == get && reading.allowed(stage.state)) || (call == set && writing.allowed(stage.state)),
        }
}

/// One line that names the variable, or the state in which the call has no place at all; or none.
fn judge(call: Call, variable: &Variable, stage: &Stage, status: Status, wanted: bool) {
    let (lines, state) = (stage.slave.log.take(), stage.state);
    let what = format!("{} of {} in '{state}': {lines:?}", call.name(), variable.name);
    assert_eq!(status, if wanted { Status::Ok } else { Status::Error }, "{what}");
    assert_eq!(lines.len(), usize::from(!wanted), "{what}");
    for line in lines {
        let named = line.text.contains(variable.name) || line.text.contains(&format!("'{state}'"));
        let named = named || line.text.contains("of co-simulation");
        assert!(line.text.starts_with(call.name()) && named, "{what}");
    }
}

#[test]
fn every_function_takes_the_variables_of_its_kind_and_names_the_others() {
    for state in STATES {
        let stage = Stage::reach(state, std::ptr::null_mut());
        for call in CALLS {
            for (variable, reference) in VARIABLES.iter().zip(0..) {
                let status = touch(&stage.slave, call, reference, nature(variable).value);
                judge(call, variable, &stage, status, possible(call, variable, &stage));
            }
        }
    }
}

#[test]
fn sensitivities_are_of_real_outputs_to_real_inputs_and_start_values() {
    for state in STATES {
        let stage = Stage::reach(state, std::ptr::null_mut());
        let (api, c) = (stage.slave.api, stage.slave.c);
        let (output, input) = (vr("slider.x"), vr("slider.load"));
        for (variable, reference) in VARIABLES.iter().zip(0..) {
            let derivative = |unknown: &u32, known: &u32| {
                // SAFETY: live component, arrays of one entry.
                unsafe { (api.GetDirectionalDerivative)(c, unknown, 1, known, 1, &1.0, &mut 0.0) }
            };
            let allowed = GetDirectionalDerivative.allowed(state);
            let of_output = allowed && matches!(variable.access, Access::RealOutput(_));
            judge(GetDirectionalDerivative, variable, &stage, derivative(&reference, &input), of_output);
            let known = match variable.access {
                Access::Input { .. } => allowed,
                Access::Parameter(Parameter { kind: Kind::Real { .. }, .. }) => state == State::InitializationMode,
                _ => false,
            };
            judge(GetDirectionalDerivative, variable, &stage, derivative(&output, &reference), known);
        }
    }
}
