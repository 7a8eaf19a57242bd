//! Model exchange of FMI 3.0: what it tells is what that of FMI 2.0 tells, to the bit.

use crate::importer::{Handle, Options, Slave, vr};
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::*;
use slidercrank::model_description::exchange::{FIRST_DERIVATIVE, FIRST_INDICATOR, FIRST_STATE};

const STATES: usize = 2;

impl Handle {
    fn set_states(&self, states: &[f64]) -> Status {
        // SAFETY: live instance, an array of the length said.
        unsafe { fmi3SetContinuousStates(self.0, states.as_ptr(), states.len()) }
    }

    /// States, their derivatives and nominal values, and the event indicator.
    fn equations(&self) -> Vec<f64> {
        let mut all = [f64::NAN; 3 * STATES + 1];
        let (states, rest) = all.split_at_mut(STATES);
        let (derivatives, rest) = rest.split_at_mut(STATES);
        let (nominals, indicators) = rest.split_at_mut(STATES);
        // SAFETY: live instance, arrays of the lengths said.
        unsafe {
            assert_eq!(fmi3GetContinuousStates(self.0, states.as_mut_ptr(), STATES), Status::Ok);
            assert_eq!(fmi3GetContinuousStateDerivatives(self.0, derivatives.as_mut_ptr(), STATES), Status::Ok);
            assert_eq!(fmi3GetNominalsOfContinuousStates(self.0, nominals.as_mut_ptr(), STATES), Status::Ok);
            assert_eq!(fmi3GetEventIndicators(self.0, indicators.as_mut_ptr(), 1), Status::Ok);
        }
        all.into()
    }

    fn completed_step(&self) -> [u8; 2] {
        let mut answers = [7; 2];
        let [enter, terminate] = &mut answers;
        // SAFETY: live instance, two places.
        assert_eq!(unsafe { fmi3CompletedIntegratorStep(self.0, 1, enter, terminate) }, Status::Ok);
        answers
    }

    /// A product with the Jacobian of all derivatives and one output by all states and inputs, or with its transpose.
    fn product(&self, adjoint: bool, seed: &[f64], answers: usize) -> Vec<f64> {
        let mut answer = vec![f64::NAN; answers];
        let of = if adjoint { fmi3GetAdjointDerivative } else { fmi3GetDirectionalDerivative };
        // SAFETY: live instance, arrays of the lengths said.
        let status = unsafe {
            let (unknowns, knowns) = (unknowns(), knowns());
            let (n_unknowns, n_knowns) = (unknowns.len(), knowns.len());
            let (unknowns, knowns) = (unknowns.as_ptr(), knowns.as_ptr());
            of(self.0, unknowns, n_unknowns, knowns, n_knowns, seed.as_ptr(), seed.len(), answer.as_mut_ptr(), answers)
        };
        assert_eq!(status, Status::Ok);
        answer
    }
}

fn unknowns() -> [u32; 3] {
    [FIRST_DERIVATIVE, FIRST_DERIVATIVE + 1, vr("slider.v")]
}

fn knowns() -> [u32; 4] {
    [FIRST_STATE, FIRST_STATE + 1, vr("crank.torque"), vr("slider.load")]
}

/// In event mode after the start.
fn started() -> Slave {
    let slave = Slave::exchanging();
    assert_eq!(slave.enter(), Status::Ok);
    assert_eq!((slave.set("crank.speed_start", 100.0), slave.set("crank.angle_start", 0.5)), (Status::Ok, Status::Ok));
    assert_eq!(slave.exit(), Status::Ok);
    slave
}

/// In continuous-time mode.
fn running() -> Slave {
    let slave = started();
    assert_eq!((slave.update_discrete_states(), slave.enter_continuous_time_mode()), (Status::Ok, Status::Ok));
    slave
}

/// The same in FMI 2.0.
fn running_in_fmi2() -> host::Slave {
    let slave = host::Slave::exchanging();
    assert_eq!(slave.setup_raw(0, 0.0, 0.0, 0, 0.0), Status::Ok);
    assert_eq!(slave.set("crank.speed_start", 100.0), Status::Ok);
    assert_eq!(slave.set("crank.angle_start", 0.5), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    slave.new_discrete_states();
    assert_eq!(slave.enter_continuous_time_mode(), Status::Ok);
    slave
}

#[test]
fn the_equations_are_those_of_fmi2() {
    let (three, two) = (running(), running_in_fmi2());
    for (time, states, torque) in [(0.0, [0.5, 100.0], 0.0), (0.125, [1.25, -30.0], 3.0), (0.0625, [7.0, 1e3], -2.0)] {
        assert_eq!((three.set_time(time), two.set_time(time)), (Status::Ok, Status::Ok));
        assert_eq!((three.set("crank.torque", torque), two.set("crank.torque", torque)), (Status::Ok, Status::Ok));
        assert_eq!((three.set_states(&states), two.set_states(&states)), (Status::Ok, Status::Ok));
        let expected = [two.states(STATES), two.derivatives(STATES), two.nominals(STATES), two.indicators(1)].concat();
        assert_eq!(three.equations(), expected);
        assert_eq!(three.picture(), two.picture());
        assert_eq!((three.completed_step(), three.time()), ([0, 0], time));
    }
}

#[test]
fn states_derivatives_and_indicators_are_variables() {
    let slave = running();
    assert_eq!(slave.set_states(&[1.25, -30.0]), Status::Ok);
    let equations = slave.equations();
    let references = [FIRST_STATE, FIRST_STATE + 1, FIRST_DERIVATIVE, FIRST_DERIVATIVE + 1, FIRST_INDICATOR];
    let values = references.map(|reference| slave.try_get_reference(reference).expect("a value"));
    assert_eq!(values[..4], equations[..4]);
    assert_eq!(values[4], equations[6]);
    let set = |reference: u32| {
        // SAFETY: live instance, arrays of one entry.
        unsafe { fmi3SetFloat64(slave.0, &reference, 1, &-40.0, 1) }
    };
    assert_eq!([FIRST_STATE + 1, FIRST_DERIVATIVE].map(set), [Status::Ok, Status::Error]);
    assert_eq!(slave.get("crank.speed"), -40.0);
}

#[test]
fn events_are_handled_from_the_start_and_time_moves_between_them_alone() {
    let slave = started();
    assert_eq!(slave.set_time(0.5), Status::Error);
    assert!(slave.line().text.contains("event mode"));
    assert_eq!(slave.enter_step_mode(), Status::Error);
    assert!(slave.line().text.contains("of co-simulation, and this instance is for model exchange"));
    assert_eq!((slave.update_discrete_states(), slave.enter_continuous_time_mode()), (Status::Ok, Status::Ok));
    for time in [0.5, 0.0, 0.25] {
        assert_eq!(slave.set_time(time), Status::Ok);
    }
    assert_eq!((slave.enter_event_mode(), slave.terminate()), (Status::Ok, Status::Ok));
    assert_eq!(slave.equations()[..STATES], [0.5, 100.0]);
}

#[test]
fn the_adjoint_is_the_transpose_along_states_and_inputs() {
    let slave = running();
    assert_eq!(slave.set("crank.torque", 3.0), Status::Ok);
    let unit = |place: usize, count: usize| (0..count).map(|at| f64::from(u8::from(at == place))).collect::<Vec<_>>();
    let columns: Vec<Vec<f64>> = (0..4).map(|known| slave.product(false, &unit(known, 4), 3)).collect();
    assert_eq!(columns[1][0], 1.0, "the angle's derivative is the speed");
    assert!(columns[2][1] > 0.0, "torque accelerates");
    for unknown in 0..3 {
        let row = slave.product(true, &unit(unknown, 3), 4);
        assert_eq!(row, columns.iter().map(|column| column[unknown]).collect::<Vec<_>>());
    }
}

#[test]
fn what_would_change_the_states_is_refused_by_name() {
    let slave = Slave::exchanging();
    for (name, value) in [("joint.C.model", 2), ("drive.mode", 2), ("solver.method", 8)] {
        assert_eq!(slave.set_enumeration(name, value), Status::Error);
        let text = slave.line().text;
        assert!(text.contains(name) && text.contains("modelDescription.xml"), "{text}");
    }
}

#[test]
fn a_saved_state_goes_on_in_another_instance_of_the_same_kind_only() {
    let slave = running();
    assert_eq!((slave.set_time(0.125), slave.set_states(&[0.75, 90.0])), (Status::Ok, Status::Ok));
    let (bytes, equations) = (slave.bytes_of(slave.save()), slave.equations());
    let other = Slave::exchanging();
    let state = other.deserialize(&bytes).expect("sound bytes");
    assert_eq!(other.set_state(state), Status::Ok);
    assert_eq!((other.equations(), other.time()), (equations, 0.125));
    let stepping = Slave::running(Options { logging: true, ..Options::default() });
    assert_eq!(stepping.deserialize(&bytes), Err(Status::Error));
    assert!(stepping.line().text.contains("the other kind of interface"));
    assert_eq!(other.deserialize(&stepping.bytes_of(stepping.save())), Err(Status::Error));
}

#[test]
fn in_initialization_mode_the_adjoint_is_the_transpose_along_start_values() {
    let slave = Slave::exchanging();
    assert_eq!(slave.enter(), Status::Ok);
    assert_eq!((slave.set("crank.speed_start", 100.0), slave.set("crank.angle_start", 0.5)), (Status::Ok, Status::Ok));
    let unknowns = [FIRST_STATE + 1, FIRST_DERIVATIVE, FIRST_DERIVATIVE + 1, vr("slider.v")];
    let knowns = ["crank.speed_start", "rod.mass", "crank.torque"].map(vr);
    let column = |known: u32| {
        let mut column = [f64::NAN; 4];
        // SAFETY: live instance, arrays of the lengths said.
        let status = unsafe {
            fmi3GetDirectionalDerivative(slave.0, unknowns.as_ptr(), 4, &known, 1, &1.0, 1, column.as_mut_ptr(), 4)
        };
        assert_eq!(status, Status::Ok, "{:?}", slave.lines());
        column
    };
    let columns = knowns.map(column);
    assert!(columns[0][..2].iter().all(|one| (one - 1.0).abs() < 1e-10) && columns[1][2] != 0.0, "{columns:?}");
    for unknown in 0..4 {
        let (mut seed, mut row) = ([0.0; 4], [f64::NAN; 3]);
        seed[unknown] = 1.0;
        // SAFETY: live instance, arrays of the lengths said.
        let status = unsafe {
            let (of, by, seed) = (unknowns.as_ptr(), knowns.as_ptr(), seed.as_ptr());
            fmi3GetAdjointDerivative(slave.0, of, 4, by, 3, seed, 4, row.as_mut_ptr(), 3)
        };
        assert_eq!((status, row), (Status::Ok, columns.map(|column| column[unknown])));
    }
}

#[test]
fn seeds_that_are_no_numbers_and_sums_beyond_all_numbers_are_told() {
    let slave = running();
    let adjoint = |seed: f64| {
        let (unknown, known, mut answer) = (FIRST_DERIVATIVE + 1, vr("crank.torque"), 7.0);
        // SAFETY: live instance, arrays of one entry.
        let status = unsafe { fmi3GetAdjointDerivative(slave.0, &unknown, 1, &known, 1, &seed, 1, &mut answer, 1) };
        (status, answer)
    };
    for seed in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(adjoint(seed), (Status::Error, 7.0));
        assert!(slave.line().text.contains("is not a finite number"));
    }
    assert_eq!(adjoint(f64::MAX), (Status::Discard, 7.0));
    assert!(slave.line().text.contains("crank.torque = inf is not a finite number"));
}
