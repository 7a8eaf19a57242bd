//! The slave without any version of FMI around it.

use host::{self, vr};
use slidercrank::fmi::slave::error::VariableError;
use slidercrank::fmi::slave::states::phase_names;
use slidercrank::fmi::slave::{Error, Permission, Slave, ValueType};
use slidercrank::model_description::exchange::{FIRST_DERIVATIVE, FIRST_STATE};
use slidercrank::scene::{JointModel, slot};
use slidercrank::simulation::CONTACTS;

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

/// Variables of states have the numbers of the packaged scene.
#[test]
fn states_and_indicators_are_those_of_the_packaged_scene_whatever_joints_it_has_got() {
    let mut packaged = slot::read().expect("a readable slot").0;
    packaged.joint.c.model = JointModel::Clearance;
    let of = |name: &str| phase_names(&packaged).iter().position(|own| own == name).expect("a state") as u32;
    for joints in [&[][..], &["joint.B.model"], &["joint.A.model", "joint.T.model"]] {
        let mut slave = Slave::new(packaged.clone(), None);
        for joint in joints {
            slave.set(ValueType::Integer, EVERYTHING, &[vr(joint)], &[2], f64::from).expect("a legal value");
        }
        set(&mut slave, "crank.speed_start", 500.0).expect("a legal value");
        slave.initialize().expect("a legal scene");
        let read_from = |slave: &mut Slave, first: u32, name: &str| {
            let mut value = [f64::NAN];
            let reference = [first + of(name)];
            slave.get(ValueType::Real, EVERYTHING, &reference, &mut value, |value| value).map(|()| value[0])
        };
        let read = |slave: &mut Slave, name: &str| read_from(slave, FIRST_STATE, name);
        for _ in 0..40 {
            step(&mut slave);
            // The gap over the clearance, positive while the contact is open.
            let gap = -get(&mut slave, "joint.C.penetration") / get(&mut slave, "joint.C.clearance");
            let indicator = slave.indicator(0).expect("joint C's contact");
            assert!((indicator - gap).abs() < 1e-6, "{indicator} for {gap} with {joints:?}");
            let mut closed = [f64::NAN];
            let contact = [vr("joint.C.contact")];
            slave.get(ValueType::Boolean, EVERYTHING, &contact, &mut closed, |value| value).expect("an output");
            assert_eq!(closed[0] != 0.0, indicator <= 0.0, "with {joints:?}");
        }
        for name in ["crank.angle", "rod.angle", "crank.speed", "rod.speed"] {
            let (state, output) = (read(&mut slave, &format!("state.{name}")), get(&mut slave, name));
            assert_eq!(state.expect("a state"), output, "{name} with {joints:?}");
        }
        let (place, output) = (read(&mut slave, "state.slider.x").expect("a state"), get(&mut slave, "slider.x"));
        assert!((place - output).abs() < 1e-12, "{place} with {joints:?}");
        let (speed, output) = (read(&mut slave, "state.slider.vx").expect("a state"), get(&mut slave, "slider.v"));
        assert!((speed - output).abs() <= 1e-12 * output.abs(), "{speed} with {joints:?}");
        let rate = read_from(&mut slave, FIRST_DERIVATIVE, "state.crank.speed").expect("a derivative");
        assert_eq!(rate, get(&mut slave, "crank.acceleration"), "with {joints:?}");
        assert!(matches!(slave.indicator(1), Err(Error::Variable(VariableError::Absent(_)))));
    }
}

#[test]
fn what_parameters_have_taken_away_is_absent_but_its_clock_is_known() {
    let mut packaged = slot::read().expect("a readable slot").0;
    packaged.joint.c.model = JointModel::Clearance;
    let slider = phase_names(&packaged).iter().position(|name| name == "state.slider.x").expect("a state") as u32;
    let mut slave = Slave::new(packaged, None);
    slave.set(ValueType::Integer, EVERYTHING, &[vr("joint.C.model")], &[1], f64::from).expect("a legal value");
    slave.initialize().expect("a legal scene");
    step(&mut slave);
    let mut value = [f64::NAN];
    let outcome = slave.get(ValueType::Real, EVERYTHING, &[FIRST_STATE + slider], &mut value, |value| value);
    assert!(matches!(outcome, Err(Error::Variable(VariableError::Absent(_)))));
    assert!(matches!(slave.indicator(0), Err(Error::Variable(VariableError::Absent(_)))));
    assert!(slave.has_clock(2) && !slave.has_clock(1));
    assert_eq!(slave.contacts().expect("contacts").changes, [false; CONTACTS]);
}
