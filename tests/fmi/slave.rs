//! The slave without any version of FMI around it.

use host::{self, vr};
use slidercrank::fmi::slave::error::VariableError;
use slidercrank::fmi::slave::{Error, Permission, Slave, ValueType};
use slidercrank::scene::slot;

const H: f64 = 1e-4;
const STEPS: usize = 30;
const EVERYTHING: Permission = Permission { inputs: true, outputs: true, parameters: true, state: "any" };

fn set(slave: &mut Slave, name: &str, value: f64) -> Result<(), Error> {
    slave.set(ValueType::Real, EVERYTHING, &[vr(name)], &[value], |value| value)
}

fn get(slave: &mut Slave, name: &str) -> f64 {
    let mut value = [f64::NAN];
    let outcome = slave.get(ValueType::Real, EVERYTHING, &[vr(name)], &mut value, |value| value);
    outcome.map(|()| value[0]).expect("an output")
}

/// What [`host::Slave::running`] is.
fn running() -> Slave {
    let mut slave = Slave::new(slot::read().expect("a readable slot").0, None);
    slave.set(ValueType::Integer, EVERYTHING, &[vr("joint.C.model")], &[2], f64::from).expect("a legal value");
    set(&mut slave, "crank.speed_start", 500.0).expect("a legal value");
    slave.initialize().expect("a legal scene");
    slave
}

fn step(slave: &mut Slave) {
    let end = slave.step_end(slave.time(), H).expect("a step");
    slave.advance_to(end).expect("a run");
}

#[test]
fn it_runs_by_itself_as_it_does_in_an_fmu() {
    let (mut slave, fmu) = (running(), host::Slave::running());
    (0..STEPS).for_each(|_| step(&mut slave));
    fmu.steps(0.0, H, STEPS);
    for output in ["slider.x", "slider.a", "crank.angle"] {
        assert_eq!(get(&mut slave, output).to_bits(), fmu.get(output).to_bits(), "{output}");
    }
}

#[test]
fn it_goes_on_from_what_was_saved() {
    let mut slave = running();
    step(&mut slave);
    let (settings, snapshot) = slave.save();
    step(&mut slave);
    let there = get(&mut slave, "slider.x");
    slave.reset();
    assert_eq!(slave.time(), 0.0);
    slave.restore(&settings, snapshot.as_ref()).expect("its own state");
    step(&mut slave);
    assert_eq!(get(&mut slave, "slider.x").to_bits(), there.to_bits());
}

#[test]
fn no_permission_lets_an_output_be_written() {
    let mut slave = running();
    let refused = VariableError::Moment { name: "slider.x", write: true, causality: "output", state: "any" };
    assert_eq!(set(&mut slave, "slider.x", 0.0), Err(refused.into()));
    let nothing = Permission { inputs: false, outputs: false, parameters: false, state: "none" };
    for name in ["slider.x", "slider.load", "crank.speed_start"] {
        let outcome = slave.get(ValueType::Real, nothing, &[vr(name)], &mut [0.0], |value| value);
        assert!(matches!(outcome, Err(Error::Variable(VariableError::Moment { write: false, .. }))), "{name}");
    }
}
