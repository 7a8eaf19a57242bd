//! The functions for estimators: a step's Jacobian, and phases that are set.

use host::log::Line;
use host::{Slave, vr};
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::abi::estimation::bodies::{
    slidercrank_phase_names, slidercrank_set_phase, slidercrank_step_jacobian,
};
use slidercrank::fmi::v2::abi::types::FMI2_MODEL_EXCHANGE;
use std::ptr::{null, null_mut};

/// What no call writes.
const UNTOUCHED: f64 = -7.0;
/// The outputs that are read.
const OUTPUTS: [&str; 2] = ["slider.x", "slider.v"];
/// [s] Length of a step with impacts.
const STEP: f64 = 5e-4;

/// The arrays of a call.
#[derive(Clone, Debug, PartialEq)]
struct Step {
    status: Status,
    phase: Vec<f64>,
    next: Vec<f64>,
    outputs: Vec<f64>,
    phase_by_phase: Vec<f64>,
    phase_by_others: Vec<f64>,
    outputs_by_phase: Vec<f64>,
    outputs_by_others: Vec<f64>,
}

impl Step {
    fn is_untouched(&self) -> bool {
        let Self { phase, next, outputs, .. } = self;
        let matrices = [&self.phase_by_phase, &self.phase_by_others, &self.outputs_by_phase, &self.outputs_by_others];
        [phase, next, outputs].into_iter().chain(matrices).flatten().all(|value| *value == UNTOUCHED)
    }
}

fn phase_count(slave: &Slave) -> Result<usize, Status> {
    let mut count = usize::MAX;
    // SAFETY: live component, one place; the other pointers are not followed.
    let status = unsafe {
        slidercrank_step_jacobian(
            slave.c,
            STEP,
            null(),
            0,
            null(),
            0,
            &raw mut count,
            null_mut(),
            null_mut(),
            null_mut(),
            null_mut(),
            null_mut(),
            null_mut(),
            null_mut(),
        )
    };
    if status == Status::Ok { Ok(count) } else { Err(status) }
}

/// A call with arrays for a phase of `count` numbers.
fn call(slave: &Slave, step: f64, others: &[u32], outputs: &[u32], mut count: usize, derivatives: bool) -> Step {
    let of = |length: usize| vec![UNTOUCHED; length];
    let mut found = Step {
        status: Status::Ok,
        phase: of(count),
        next: of(count),
        outputs: of(outputs.len()),
        phase_by_phase: of(count * count),
        phase_by_others: of(count * others.len()),
        outputs_by_phase: of(outputs.len() * count),
        outputs_by_others: of(outputs.len() * others.len()),
    };
    // SAFETY: live component, arrays of the lengths said.
    found.status = unsafe {
        slidercrank_step_jacobian(
            slave.c,
            step,
            others.as_ptr(),
            others.len(),
            outputs.as_ptr(),
            outputs.len(),
            &raw mut count,
            found.phase.as_mut_ptr(),
            found.next.as_mut_ptr(),
            found.outputs.as_mut_ptr(),
            if derivatives { found.phase_by_phase.as_mut_ptr() } else { null_mut() },
            found.phase_by_others.as_mut_ptr(),
            found.outputs_by_phase.as_mut_ptr(),
            found.outputs_by_others.as_mut_ptr(),
        )
    };
    found
}

fn step_jacobian(slave: &Slave, step: f64, others: &[&str]) -> Step {
    let others: Vec<u32> = others.iter().map(|name| vr(name)).collect();
    let count = phase_count(slave).expect("a number");
    let found = call(slave, step, &others, &OUTPUTS.map(vr), count, true);
    assert_eq!(found.status, Status::Ok, "{:?}", slave.log.take());
    found
}

fn phase(slave: &Slave) -> Vec<f64> {
    let found = call(slave, 1e-9, &[], &[], phase_count(slave).expect("a number"), false);
    assert_eq!(found.status, Status::Ok, "{:?}", slave.log.take());
    found.phase
}

fn set_phase(slave: &Slave, phase: &[f64], parameters: &[u32], values: &[f64]) -> Status {
    assert_eq!(parameters.len(), values.len());
    // SAFETY: live component, arrays of the lengths said.
    unsafe {
        slidercrank_set_phase(
            slave.c,
            phase.as_ptr(),
            phase.len(),
            parameters.as_ptr(),
            parameters.len(),
            values.as_ptr(),
        )
    }
}

fn names(slave: &Slave) -> Vec<String> {
    let mut size = 0;
    // SAFETY: live component, one place.
    assert_eq!(unsafe { slidercrank_phase_names(slave.c, null_mut(), &raw mut size) }, Status::Ok);
    let mut bytes = vec![1_u8; size];
    // SAFETY: live component, a buffer of the length said.
    assert_eq!(unsafe { slidercrank_phase_names(slave.c, bytes.as_mut_ptr().cast(), &raw mut size) }, Status::Ok);
    assert_eq!(bytes.pop(), Some(0), "a zero byte at the end");
    String::from_utf8(bytes).expect("text").lines().map(str::to_owned).collect()
}

/// A worn slider pin at a tolerance for differences, placed at 3 ms or, if it is to be `closed`, when its contact next is;
/// the communication point.
fn worn(closed: bool) -> (Slave, f64) {
    let slave = Slave::initializing();
    slave.wear();
    assert_eq!(slave.set("solver.tolerance", 1e-11), Status::Ok);
    assert_eq!(slave.set_all(&["crank.torque", "slider.load"].map(vr), &[3.0, -20.0]), Status::Ok);
    assert_eq!(slave.exit(), Status::Ok);
    let mut point = slave.steps(0.0, 3e-3, 1);
    while closed && slave.get_boolean("joint.C.contact") == 0 {
        point = slave.steps(point, 1e-6, 1);
    }
    assert_eq!(set_phase(&slave, &phase(&slave), &[], &[]), Status::Ok);
    (slave, point)
}

#[test]
fn a_phase_s_numbers_have_the_names_of_states_and_contacts() {
    let (slave, _) = worn(false);
    let names = names(&slave);
    assert_eq!(names.len(), phase_count(&slave).expect("a number"));
    assert_eq!(names.last().map(String::as_str), Some("joint.C.approach"));
    assert!(names[..names.len() - 1].iter().all(|name| name.starts_with("state.")), "{names:?}");
    let (mut size, mut byte) = (1, 1_i8);
    // SAFETY: live component, a buffer of the length said.
    let status = unsafe { slidercrank_phase_names(slave.c, (&raw mut byte).cast(), &raw mut size) };
    assert_eq!((status, byte, size), (Status::Error, 1, 1), "a short buffer");
}

#[test]
fn a_step_jacobian_is_that_of_steps() {
    check_differences(false);
}

#[test]
fn approach_speeds_have_an_influence() {
    check_differences(true);
}

/// Compares a step with an impact, from an open or a closed contact, with steps from phases and parameters that differ a
/// little: differences of order 4, of which the best length counts.
fn check_differences(closed: bool) {
    let (slave, point) = worn(closed);
    let (saved, events) = (slave.save(), slave.get_integer("solver.events"));
    let parameters = ["joint.C.clearance", "rod.length", "crank.torque", "slider.load"];
    let exact = step_jacobian(&slave, STEP, &parameters);
    let count = exact.phase.len();
    assert_eq!(exact.phase[count - 1] > 0.0, closed);
    // What differences move, and in which units results are compared.
    let largest = |(before, after): (&f64, &f64)| before.abs().max(after.abs()).max(1e-4);
    let units: Vec<f64> = exact.phase.iter().zip(&exact.next).map(largest).collect();
    let sizes: Vec<f64> = units.iter().copied().chain(exact.outputs.iter().map(|value| value.abs())).collect();
    // Where a step leads from a phase and a parameter that differ a little.
    let leads = |column: usize, change: f64| -> Vec<f64> {
        assert_eq!(slave.set_state(saved), Status::Ok);
        let mut phase = exact.phase.clone();
        match column.checked_sub(count).map(|place| parameters[place]) {
            None => {
                phase[column] += change;
                assert_eq!(set_phase(&slave, &phase, &[], &[]), Status::Ok);
            }
            Some(name) if name.contains("length") || name.contains("clearance") => {
                let value = slave.get(name) + change;
                assert_eq!(set_phase(&slave, &phase, &[vr(name)], &[value]), Status::Ok);
            }
            Some(name) => assert_eq!(slave.set(name, slave.get(name) + change), Status::Ok),
        }
        slave.steps(point, STEP, 1);
        let outputs = OUTPUTS.map(|name| slave.get(name));
        self::phase(&slave).into_iter().chain(outputs).collect()
    };
    let of_parameters: Vec<f64> = parameters.iter().map(|name| slave.get(name).abs()).collect();
    for (column, unit) in units.iter().copied().chain(of_parameters).enumerate() {
        let (of_phase, of_outputs, width, place) = match column.checked_sub(count) {
            None => (&exact.phase_by_phase, &exact.outputs_by_phase, count, column),
            Some(place) => (&exact.phase_by_others, &exact.outputs_by_others, parameters.len(), place),
        };
        let slopes: Vec<f64> = of_phase.iter().chain(of_outputs).skip(place).step_by(width).copied().collect();
        let largest = slopes.iter().zip(&sizes).map(|(slope, size)| (slope * unit / size).abs()).fold(0.0, f64::max);
        if column == count - 1 && !closed {
            assert_eq!(largest, 0.0, "an open contact remembers nothing");
            continue;
        }
        assert!(largest > 0.0, "column {column}");
        let miss = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7].into_iter().map(|share| {
            let step = share * unit;
            let difference = |times: f64| -> Vec<f64> {
                let (more, less) = (leads(column, times * step), leads(column, -times * step));
                more.iter().zip(&less).map(|(more, less)| (more - less) / (2.0 * times * step)).collect()
            };
            let (near, far) = (difference(1.0), difference(2.0));
            let errors =
                near.iter().zip(&far).zip(&slopes).zip(&sizes).map(|(((near, far), slope), size)| {
                    ((4.0 * near - far) / 3.0 - slope).abs() * unit / size / largest
                });
            errors.fold(0.0, f64::max)
        });
        let miss = miss.fold(f64::INFINITY, f64::min);
        println!("column {column}: {miss:e}");
        assert!(miss < 1e-6, "column {column}: {miss:e} of {largest:e}");
    }
    assert!(slave.get_integer("solver.events") > events, "an impact");
}

#[test]
fn a_jacobian_begins_within_a_step_as_well_as_at_its_end() {
    let slave = Slave::initializing();
    slave.wear();
    assert_eq!(slave.set("solver.tolerance", 1e-11), Status::Ok);
    assert_eq!(slave.exit(), Status::Ok);
    let mut point = 0.0;
    for _ in 0..6 {
        point = slave.steps(point, STEP, 1);
        let within = step_jacobian(&slave, STEP, &["joint.C.clearance"]);
        assert_eq!(set_phase(&slave, &within.phase, &[], &[]), Status::Ok);
        let at_end = step_jacobian(&slave, STEP, &["joint.C.clearance"]);
        assert_eq!(within.phase, at_end.phase);
        for (one, other) in [
            (&within.phase_by_phase, &at_end.phase_by_phase),
            (&within.phase_by_others, &at_end.phase_by_others),
            (&within.outputs_by_phase, &at_end.outputs_by_phase),
        ] {
            let largest = other.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            for (one, other) in one.iter().zip(other) {
                assert!((one - other).abs() <= 1e-6 * largest, "at {point} s: {one} is not {other}, of {largest}");
            }
        }
    }
}

#[test]
fn from_a_phase_that_was_set_the_step_is_that_of_the_instance() {
    let (slave, point) = worn(false);
    let told = step_jacobian(&slave, STEP, &[]);
    let plain = call(&slave, STEP, &[], &OUTPUTS.map(vr), told.phase.len(), false);
    assert_eq!((&plain.phase, &plain.next, &plain.outputs), (&told.phase, &told.next, &told.outputs));
    assert!(plain.phase_by_phase.iter().all(|value| *value == UNTOUCHED), "no derivatives were asked for");
    slave.steps(point, STEP, 1);
    assert_eq!(told.outputs, OUTPUTS.map(|name| slave.get(name)));
    assert_eq!(told.next, phase(&slave));
}

#[test]
fn a_step_jacobian_changes_no_bit_of_the_instance() {
    let (asked, plain) = (Slave::running(), Slave::running());
    let mut point = 0.0;
    for i in 0..40 {
        for slave in [&asked, &plain] {
            assert_eq!(slave.set("crank.torque", f64::from(i % 4)), Status::Ok);
            assert_eq!(slave.set_rate("slider.load", 1, -10.0 * f64::from(i)), Status::Ok);
        }
        // Reading outputs passes the inputs on.
        assert_eq!(asked.picture(), plain.picture());
        let before = asked.save();
        step_jacobian(&asked, 2e-4, &["joint.C.clearance", "slider.load"]);
        assert!(asked.bytes_of(before) == asked.bytes_of(asked.save()), "the saved state at {point} s");
        asked.steps(point, 1e-4, 1);
        point = plain.steps(point, 1e-4, 1);
        assert_eq!(asked.picture(), plain.picture());
    }
    assert!(plain.get_integer("solver.events") > 2, "impacts");
}

/// The one line of a refusal.
fn refusal(slave: &Slave, status: Status) -> String {
    assert_eq!(status, Status::Error);
    let Line { text, .. } = slave.log.only();
    text
}

#[test]
fn a_refused_step_jacobian_writes_nothing() {
    let (slave, _) = worn(false);
    let count = phase_count(&slave).expect("a number");
    let (clearance, position) = (vr("joint.C.clearance"), vr("slider.x"));
    let picture = slave.picture();
    for (step, others, outputs, room, word) in [
        (f64::NAN, vec![clearance], vec![position], count, "NaN is not a finite number"),
        (0.0, vec![clearance], vec![position], count, "is not above 0"),
        (STEP, vec![99_999], vec![position], count, "no variable has value reference 99999"),
        (STEP, vec![clearance], vec![99_999], count, "no variable has value reference 99999"),
        (STEP, vec![position], vec![position], count, "slider.x is not a real parameter or input"),
        (STEP, vec![vr("joint.C.model")], vec![], count, "joint.C.model is not a real parameter or input"),
        (STEP, vec![clearance, clearance], vec![], count, "joint.C.clearance is named twice"),
        (STEP, vec![clearance], vec![clearance], count, "joint.C.clearance is not a real output"),
        (STEP, vec![], vec![vr("joint.C.impact.speed")], count, "joint.C.impact.speed is not determined by the state"),
        (STEP, vec![], vec![vr("joint.B.wear.work")], count, "joint.B.wear.work is not determined by the state"),
        (STEP, vec![], vec![], count - 1, "numbers of a phase, where there are"),
    ] {
        let found = call(&slave, step, &others, &outputs, room, true);
        let text = refusal(&slave, found.status);
        assert!(text.starts_with("slidercrank_step_jacobian") && text.contains(word), "{text}");
        assert!(found.is_untouched(), "{text}");
    }
    // SAFETY: a NULL component and a NULL place are refused.
    unsafe {
        for c in [null_mut(), slave.c] {
            let (no, none, nowhere) = (null(), null(), null_mut());
            let status = slidercrank_step_jacobian(
                c,
                STEP,
                no,
                0,
                none,
                0,
                null_mut(),
                nowhere,
                nowhere,
                nowhere,
                nowhere,
                nowhere,
                nowhere,
                nowhere,
            );
            assert_eq!(status, Status::Error);
        }
        let (mut count, mut phase) = (count, vec![UNTOUCHED; count]);
        let (place, nowhere) = (phase.as_mut_ptr(), null_mut());
        let status = slidercrank_step_jacobian(
            slave.c,
            STEP,
            null(),
            0,
            null(),
            0,
            &raw mut count,
            place,
            nowhere,
            nowhere,
            nowhere,
            nowhere,
            nowhere,
            nowhere,
        );
        assert_eq!((status, phase[0]), (Status::Error, UNTOUCHED));
        assert_eq!(slidercrank_phase_names(slave.c, null_mut(), null_mut()), Status::Error);
    }
    let lines = slave.log.take();
    assert!(lines.iter().any(|line| line.text.contains("'nextPhase' is NULL")), "{lines:?}");
    assert_eq!(slave.picture(), picture);
}

#[test]
fn both_are_refused_where_steps_are() {
    let slave = Slave::initializing();
    slave.wear();
    assert_eq!(phase_count(&slave), Err(Status::Error));
    let text = slave.log.only().text;
    assert!(text.contains("slidercrank_step_jacobian") && text.contains("initialization mode"), "{text}");
    assert!(refusal(&slave, set_phase(&slave, &[], &[], &[])).contains("initialization mode"));
    let exchange = Slave::of_type(slave.api, "exchange", FMI2_MODEL_EXCHANGE, true);
    assert_eq!(phase_count(&exchange), Err(Status::Error));
    assert!(exchange.log.only().text.contains("co-simulation"));
}

#[test]
fn rigid_contacts_have_steps_and_no_jacobian() {
    let slave = Slave::initializing();
    slave.wear();
    assert_eq!(slave.set_integer("solver.method", MOREAU), Status::Ok);
    assert_eq!(slave.exit(), Status::Ok);
    slave.steps(0.0, 1e-3, 1);
    let count = phase_count(&slave).expect("a number");
    let found = call(&slave, STEP, &[], &[], count, true);
    assert!(refusal(&slave, found.status).contains("moreau") && found.is_untouched());
    let plain = call(&slave, STEP, &[], &OUTPUTS.map(vr), count, false);
    assert_eq!(plain.status, Status::Ok);
    assert!(plain.next.iter().all(|value| value.is_finite()) && plain.next != plain.phase);
}

/// `solver.method = moreau`.
const MOREAU: i32 = slidercrank::scene::Method::Moreau as i32;

#[test]
fn grazing_is_an_error_that_names_joint_and_time() {
    let slave = Slave::initializing();
    assert_eq!(slave.set_integer("joint.C.model", 2), Status::Ok);
    // From the middle of its clearance of 0.5 mm the slider at 1 m/s turns back at the bearing, under 1000 m/s².
    let load = -1000.0 * slave.get("slider.mass");
    assert_eq!(slave.set("slider.load", load), Status::Ok);
    assert_eq!(slave.exit(), Status::Ok);
    let mut numbers = phase(&slave);
    let of = |name: &str| names(&slave).iter().position(|other| other == name).expect(name);
    numbers[of("state.slider.vx")] = 1.0;
    assert_eq!(set_phase(&slave, &numbers, &[], &[]), Status::Ok);
    let count = numbers.len();
    let found = call(&slave, 2e-3, &[], &OUTPUTS.map(vr), count, true);
    let text = refusal(&slave, found.status);
    assert!(text.contains("joint C's contact grazes") && text.contains("at t = 0.00"), "{text}");
    assert!(found.is_untouched(), "no number is returned");
    assert_eq!(call(&slave, 0.5e-3, &[], &[], count, true).status, Status::Ok, "before it all is well");
}

#[test]
fn a_phase_that_is_refused_changes_nothing() {
    let (slave, point) = worn(false);
    let numbers = phase(&slave);
    let (clearance, length) = (vr("joint.C.clearance"), vr("rod.length"));
    let (picture, saved) = (slave.picture(), slave.bytes_of(slave.save()));
    let mut infinite = numbers.clone();
    infinite[0] = f64::INFINITY;
    let mut far = numbers.clone();
    far[0] = 1e300;
    for (phase, parameters, values, word) in [
        (&infinite, vec![], vec![], "= inf is not a finite number"),
        (&far, vec![], vec![], "no motion goes on from these numbers, of which state.slider.x = 1e300 is the largest"),
        (&numbers[1..].to_vec(), vec![], vec![], "numbers of a phase, where there are"),
        (&numbers, vec![length, clearance], vec![0.13, -1.0], "joint.C.clearance = -1 is out of range"),
        (&numbers, vec![length, clearance], vec![0.13, f64::NAN], "joint.C.clearance = NaN is not a finite number"),
        (&numbers, vec![vr("joint.C.model")], vec![1.0], "joint.C.model is not a real parameter"),
        (&numbers, vec![vr("slider.load")], vec![1.0], "slider.load is not a real parameter"),
        (&numbers, vec![length, length], vec![0.13, 0.13], "rod.length is named twice"),
    ] {
        let text = refusal(&slave, set_phase(&slave, phase, &parameters, &values));
        assert!(text.starts_with("slidercrank_set_phase") && text.contains(word), "{text}");
    }
    assert_eq!((slave.picture(), slave.bytes_of(slave.save())), (picture, saved));
    assert_eq!(set_phase(&slave, &numbers, &[clearance], &[2e-4]), Status::Ok);
    assert_eq!(slave.get("joint.C.clearance"), 2e-4);
    slave.steps(point, STEP, 1);
}

#[test]
fn a_contact_that_was_set_against_its_penetration_follows_it() {
    let (slave, point) = worn(false);
    let mut numbers = phase(&slave);
    let depth = slave.get("joint.C.penetration");
    let place = numbers.len() - 1;
    let contact = || slave.get_boolean("joint.C.contact") != 0;
    assert_eq!(contact(), numbers[place] > 0.0);
    // Closed across a gap, open within the bearing: by the clearance.
    let clearance = slave.get("joint.C.clearance");
    numbers[place] = 1.0;
    assert_eq!(set_phase(&slave, &numbers, &[vr("joint.C.clearance")], &[2.0 * clearance]), Status::Ok);
    assert!(slave.get("joint.C.penetration") < 0.0 && !contact());
    numbers[place] = -1.0;
    let near = clearance + depth - 1e-6;
    assert_eq!(set_phase(&slave, &numbers, &[vr("joint.C.clearance")], &[near]), Status::Ok);
    assert!(slave.get("joint.C.penetration") > 0.0 && contact());
    slave.steps(point, STEP, 1);
}

#[test]
fn a_parameter_may_be_set_after_a_step_that_is_long_for_it() {
    let slave = Slave::initializing();
    assert_eq!(slave.set_integer("joint.C.model", 2), Status::Ok);
    assert_eq!(slave.set_integer("drive.mode", 2), Status::Ok);
    assert_eq!(slave.set("crank.speed_start", 1.0), Status::Ok);
    assert_eq!(slave.exit(), Status::Ok);
    let (mut point, speed) = (0.0, vr("crank.speed_start"));
    // The integrator's steps at this speed are longer than any at the other.
    for _ in 0..5 {
        point = slave.steps(point, 1e-3, 1);
        assert_eq!(set_phase(&slave, &phase(&slave), &[speed], &[500.0]), Status::Ok, "{:?}", slave.log.take());
        assert_eq!(set_phase(&slave, &phase(&slave), &[speed], &[1.0]), Status::Ok, "{:?}", slave.log.take());
    }
}
