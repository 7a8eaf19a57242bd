//! Model exchange through the C functions, with the mechanism that the linked library is packaged with: an ideal one.

use host::exchange::STATES;
use host::{Slave, vr};
use slidercrank::fmi::v2::Status;
use slidercrank::model_description::exchange::{FIRST_DERIVATIVE, FIRST_STATE};

/// In event mode at time `start`.
fn started(start: f64) -> Slave {
    let slave = Slave::exchanging();
    assert_eq!(slave.setup_raw(0, 0.0, start, 0, 0.0), Status::Ok);
    assert_eq!(slave.set("crank.speed_start", 100.0), Status::Ok);
    assert_eq!(slave.set("crank.angle_start", 0.5), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    slave
}

/// In continuous-time mode at time 0.
fn running() -> Slave {
    let slave = started(0.0);
    assert_eq!(slave.enter_continuous_time_mode(), Status::Ok);
    slave
}

fn real(slave: &Slave, reference: u32) -> f64 {
    let mut value = f64::NAN;
    // SAFETY: live component, arrays of one entry.
    let status = unsafe { (slave.api.GetReal)(slave.c, &reference, 1, &mut value) };
    assert_eq!(status, Status::Ok, "{:?}", slave.log.take());
    value
}

fn derivative(slave: &Slave, unknown: u32, known: u32) -> f64 {
    let mut value = f64::NAN;
    // SAFETY: live component, arrays of one entry.
    let status = unsafe { (slave.api.GetDirectionalDerivative)(slave.c, &unknown, 1, &known, 1, &1.0, &mut value) };
    assert_eq!(status, Status::Ok, "{:?}", slave.log.take());
    value
}

#[test]
fn an_event_needs_no_second_iteration_and_tells_no_time() {
    let slave = started(0.0);
    let info = slave.new_discrete_states();
    assert_eq!(
        [
            info.new_discrete_states_needed,
            info.terminate_simulation,
            info.nominals_of_continuous_states_changed,
            info.values_of_continuous_states_changed,
            info.next_event_time_defined
        ],
        [0; 5]
    );
    assert_eq!(slave.enter_continuous_time_mode(), Status::Ok);
    assert_eq!(slave.completed_step(), [0, 0]);
    assert_eq!((slave.enter_event_mode(), slave.terminate()), (Status::Ok, Status::Ok));
    assert_eq!(slave.states(STATES), [0.5, 100.0]);
}

#[test]
fn states_and_their_derivatives_are_variables_too() {
    let slave = running();
    assert_eq!(slave.set_states(&[1.25, -30.0]), Status::Ok);
    assert_eq!([real(&slave, FIRST_STATE), real(&slave, FIRST_STATE + 1)], [1.25, -30.0]);
    assert_eq!([slave.get("crank.angle"), slave.get("crank.speed")], [1.25, -30.0]);
    let derivatives = slave.derivatives(STATES);
    assert_eq!(derivatives, [real(&slave, FIRST_DERIVATIVE), real(&slave, FIRST_DERIVATIVE + 1)]);
    assert_eq!(derivatives, [-30.0, slave.get("crank.acceleration")]);
    let set = |reference: u32, value: f64| {
        // SAFETY: live component, arrays of one entry.
        unsafe { (slave.api.SetReal)(slave.c, &reference, 1, &value) }
    };
    assert_eq!([set(FIRST_STATE + 1, -40.0), set(FIRST_DERIVATIVE, 1.0)], [Status::Ok, Status::Error]);
    assert_eq!((slave.states(STATES), slave.get("crank.speed")), (vec![1.25, -40.0], -40.0));
    slave.log.take();
    assert_eq!(slave.indicators(1), [1.0], "no rod of this length comes across the guide");
    // One more than there are is none.
    let mut value = 0.0;
    // SAFETY: live component, arrays of one entry.
    let status = unsafe { (slave.api.GetReal)(slave.c, &(FIRST_STATE + 2), 1, &mut value) };
    assert_eq!((status, slave.log.only().text.contains("continuous state 3")), (Status::Error, true));
}

#[test]
fn co_simulation_tells_states_and_derivatives_as_well() {
    let slave = Slave::running();
    slave.steps(0.0, 1e-4, 7);
    // The packaged scene has two states, which are the second and the fifth of one with a worn slider pin.
    for (state, output) in [(0, "crank.angle"), (1, "crank.speed")] {
        assert_eq!(real(&slave, FIRST_STATE + state), slave.get(output), "{output}");
    }
    assert_eq!(real(&slave, FIRST_DERIVATIVE + 1), slave.get("crank.acceleration"));
    let mut value = 0.0;
    // SAFETY: live component, arrays of one entry.
    let status = unsafe { (slave.api.GetReal)(slave.c, &(FIRST_STATE + 2), 1, &mut value) };
    assert_eq!((status, slave.log.only().text.contains("continuous state 3")), (Status::Error, true));
}

/// An importer's integrator calls the library that it has loaded.
#[test]
fn the_portable_library_says_that_it_computes() {
    let slave = running();
    assert_eq!(slave.get_boolean("solver.portable_used"), 1);
}

#[test]
fn time_is_the_importers() {
    let slave = started(1.0e3);
    assert_eq!(slave.set("drive.mode", 2.0), Status::Error, "an enumeration is no real");
    slave.log.take();
    assert_eq!(slave.enter_continuous_time_mode(), Status::Ok);
    // An integrator goes forward and back.
    for time in [1.0e3 + 0.5, 1.0e3, 1.0e3 + 0.25] {
        assert_eq!(slave.set_time(time), Status::Ok);
    }
    assert_eq!(slave.set_time(f64::NAN), Status::Error);
}

#[test]
fn what_would_change_the_states_is_refused_by_name() {
    let slave = Slave::exchanging();
    for (name, value) in [
        ("joint.C.model", 2),
        ("drive.mode", 2),
        ("rod.flexible.bending_modes", 1),
        ("rod.flexible.axial_modes", 1),
        ("solver.method", 8),
    ] {
        assert_eq!(slave.set_integer(name, value), Status::Error);
        let line = slave.log.only().text;
        assert!(line.contains(name) && line.contains("modelDescription.xml"), "{line}");
        assert_eq!(slave.set_integer(name, slave.get_integer(name)), Status::Ok);
    }
    assert_eq!(slave.set_boolean("energy.audit", 1), Status::Error);
    assert!(slave.log.only().text.contains("energy.audit"));
    // A law of a joint without play has no bristles.
    assert_eq!(slave.set_integer("joint.A.friction.law", 5), Status::Ok);
    assert_eq!(slave.set("rod.length", 0.2), Status::Ok);
}

#[test]
fn functions_of_the_other_kind_are_refused_as_such() {
    let (exchanging, stepping) = (running(), Slave::running());
    assert_eq!(exchanging.step(0.0, 1e-3), Status::Error);
    assert!(exchanging.log.only().text.contains("of co-simulation, and this instance is for model exchange"));
    assert_eq!(stepping.set_time(0.0), Status::Error);
    assert!(stepping.log.only().text.contains("of model exchange, and this instance is for co-simulation"));
    let [theirs, ours] = [&stepping, &exchanging].map(|slave| slave.bytes_of(slave.save()));
    for (slave, bytes) in [(&exchanging, theirs), (&stepping, ours)] {
        assert_eq!(slave.deserialize(&bytes), Err(Status::Error));
        assert!(slave.log.only().text.contains("the other kind of interface"));
    }
}

#[test]
fn derivatives_along_states_and_inputs_are_those_of_the_equations() {
    let slave = running();
    assert_eq!(slave.set("crank.torque", 3.0), Status::Ok);
    let (speed, rate) = (FIRST_STATE + 1, FIRST_DERIVATIVE + 1);
    assert_eq!(derivative(&slave, FIRST_DERIVATIVE, speed), 1.0);
    // Acceleration by torque is one over the crank's reduced inertia, in the equations as in the outputs.
    let by_torque = derivative(&slave, rate, vr("crank.torque"));
    let of_output = derivative(&slave, vr("crank.acceleration"), vr("crank.torque"));
    assert!(by_torque > 0.0 && (by_torque - of_output).abs() <= 1e-9 * by_torque, "{by_torque} {of_output}");
    // v = x'(angle)·speed.
    let (by_speed, ratio) = (derivative(&slave, vr("slider.v"), speed), slave.get("slider.v") / 100.0);
    assert!((by_speed - ratio).abs() <= 1e-9, "{by_speed} {ratio}");
    let by_angle = derivative(&slave, vr("slider.x"), FIRST_STATE);
    assert!((by_angle - ratio).abs() <= 1e-7, "{by_angle} {ratio}");
}

#[test]
fn a_saved_state_brings_time_states_and_mode_back_in_another_instance() {
    let slave = running();
    assert_eq!((slave.set_time(0.125), slave.set_states(&[0.75, 90.0])), (Status::Ok, Status::Ok));
    assert_eq!(slave.set("slider.load", -12.0), Status::Ok);
    let (bytes, picture) = (slave.bytes_of(slave.save()), slave.picture());
    assert_eq!((slave.set_time(1.0), slave.set_states(&[2.0, 1.0])), (Status::Ok, Status::Ok));
    let other = Slave::exchanging();
    for slave in [&slave, &other] {
        let state = slave.deserialize(&bytes).expect("sound bytes");
        assert_eq!(slave.set_state(state), Status::Ok);
        assert_eq!((slave.states(STATES), slave.picture()), (vec![0.75, 90.0], picture.clone()));
        assert_eq!(slave.completed_step(), [0, 0]);
    }
    assert!(bytes.len() < 8192, "{} bytes", bytes.len());
}
