//! Event mode: `fmi3DoStep` returns at every closing and opening of a contact, with both sides readable.

use crate::importer::{Handle, Options, Slave};
use slidercrank::fmi::v3::Status;
use slidercrank::model_description::clocks::FIRST_CLOCK;
use slidercrank::model_description::exchange::FIRST_INDICATOR;
use std::f64::consts::TAU;

const SPEED: f64 = 5000.0 * TAU / 60.0;
const STEP: f64 = 1e-4;
/// Place of the slider pin's contact.
const SLIDER_PIN: u32 = 2;

/// The published benchmark: speed drive at 5000 rpm, play of 0.5 mm in the slider pin.
fn benchmark(options: Options) -> Slave {
    let slave = Slave::new(options);
    assert_eq!(slave.enter_with(Some(1e-10), 0.0, None), Status::Ok);
    assert_eq!(slave.set_enumeration("drive.mode", 2), Status::Ok);
    assert_eq!(slave.set_enumeration("joint.C.model", 2), Status::Ok);
    assert_eq!(slave.set("crank.speed_start", SPEED), Status::Ok);
    slave.ready(true);
    slave
}

/// [m/s] How fast the journal approaches the bearing of the slider pin.
fn approach(slave: &Handle) -> f64 {
    let get = |name: &str| slave.get(name);
    let (crank, rod) = (get("crank.angle"), get("rod.angle"));
    let (r, l) = (0.05 * get("crank.speed"), 0.12 * get("rod.speed"));
    let journal = [-r * crank.sin() - l * rod.sin() - get("slider.v"), r * crank.cos() + l * rod.cos()];
    let place = [get("joint.C.eccentricity.x"), get("joint.C.eccentricity.y")];
    (place[0] * journal[0] + place[1] * journal[1]) / place[0].hypot(place[1])
}

#[test]
fn the_first_touch_of_the_worn_pin_is_where_it_was_published() {
    let slave = benchmark(Options::EVENTS);
    let mut time = 0.0;
    let told = loop {
        let told = slave.step(time, STEP);
        time = told.time;
        if told.event {
            break told;
        }
        assert!(!told.early && time < 1e-3);
    };
    assert!(told.early && !told.terminate);
    let degrees = (SPEED * told.time).to_degrees();
    assert!((degrees - 6.8186).abs() < 5e-5, "{degrees}");
    // Left limit: just not in contact.
    let before = (slave.picture(), slave.boolean("joint.C.contact"), slave.integer("solver.events"));
    assert!(!before.1 && before.2 == 0);
    let speed = approach(&slave);
    assert!((speed.abs() - 4.38578).abs() < 5e-6, "{speed}");
    assert!(slave.get("joint.C.penetration").abs() < 1e-12);
    assert_eq!(slave.enter_event_mode(), Status::Ok);
    // The contact's clock is active until the update, and no other joint has one.
    assert_eq!(slave.try_clocks(&[FIRST_CLOCK + SLIDER_PIN]), Ok(vec![true]));
    assert_eq!(slave.try_clocks(&[FIRST_CLOCK + SLIDER_PIN, FIRST_CLOCK]), Err(Status::Error));
    assert!(slave.line().text.contains("no contact of this clock"));
    // Nothing jumps before the update.
    assert_eq!(before, (slave.picture(), slave.boolean("joint.C.contact"), slave.integer("solver.events")));
    assert_eq!(slave.update_discrete_states(), Status::Ok);
    assert_eq!(slave.try_clocks(&[FIRST_CLOCK + SLIDER_PIN]), Ok(vec![false]));
    // Right limit: in contact at the same instant; what has no jump has the same bits.
    assert!(slave.boolean("joint.C.contact") && slave.integer("solver.events") == 1);
    assert_eq!(slave.get("crank.angle").to_bits(), (SPEED * told.time).to_bits());
    assert_eq!(approach(&slave).to_bits(), speed.to_bits());
    assert_eq!(slave.enter_step_mode(), Status::Ok);
}

#[test]
fn every_event_is_told_once_and_every_one_changes_a_contact() {
    let slave = benchmark(Options::EVENTS);
    let (mut time, mut contact, mut events) = (0.0, false, 0);
    while time < 0.012 {
        let told = slave.step(time, STEP);
        assert!(told.time > time || told.event);
        time = told.time;
        assert_eq!(slave.boolean("joint.C.contact"), contact, "no change without an event");
        if told.event {
            events += 1;
            assert_eq!(slave.enter_event_mode(), Status::Ok);
            slave.handle_event();
            assert_ne!(slave.boolean("joint.C.contact"), contact);
            contact = !contact;
        }
        assert_eq!(slave.integer("solver.events"), events);
    }
    assert!(events >= 20, "{events}");
}

#[test]
fn an_event_has_to_be_handled_before_the_next_step() {
    let slave = benchmark(Options::EVENTS);
    let told = slave.step(0.0, 1e-3);
    assert!(told.event);
    assert_eq!(slave.try_step(told.time, 1e-3), Err(Status::Error));
    let text = slave.line().text;
    assert!(text.contains("fmi3DoStep") && text.contains("event to be handled"), "{text}");
    assert_eq!(slave.enter_event_mode(), Status::Ok);
    // Step mode handles what was not updated.
    assert_eq!(slave.enter_step_mode(), Status::Ok);
    assert!(slave.boolean("joint.C.contact"));
}

#[test]
fn event_mode_is_for_those_who_use_it() {
    let slave = Slave::running(Options { logging: true, ..Options::default() });
    assert_eq!(slave.enter_event_mode(), Status::Error);
    assert!(slave.line().text.contains("eventModeUsed"));
    let told = slave.step(0.0, 0.05);
    assert!(!told.event && !told.early && told.time == 0.05 && slave.integer("solver.events") > 10);
}

#[test]
fn inputs_may_jump_in_event_mode() {
    let runs = [true, false].map(|event_mode| {
        let slave = Slave::running(Options { event_mode, early_return: event_mode, ..Options::default() });
        slave.run(0.0, STEP, 20.0 * STEP);
        if event_mode {
            assert_eq!(slave.enter_event_mode(), Status::Ok);
        }
        assert_eq!(slave.set("slider.load", -300.0), Status::Ok);
        if event_mode {
            slave.handle_event();
        }
        slave.run(20.0 * STEP, STEP, 40.0 * STEP);
        slave.picture()
    });
    assert_eq!(runs[0], runs[1]);
}

#[test]
fn rates_and_sensitivities_are_those_of_the_side_shown() {
    let slave = Slave::worn_pin(Options::EVENTS);
    // A linear spring: its force grows at once.
    assert_eq!((slave.set("joint.C.exponent", 1.0), slave.set("joint.C.stiffness", 1e8)), (Status::Ok, Status::Ok));
    slave.ready(true);
    let told = slave.step(0.0, 0.01);
    assert!(told.event);
    let before = slave.rate("joint.C.force.x").expect("a rate");
    assert_eq!(slave.enter_event_mode(), Status::Ok);
    slave.handle_event();
    let after = slave.rate("joint.C.force.x").expect("a rate");
    assert_ne!(before.to_bits(), after.to_bits(), "a force begins to grow at a touch");
}

#[test]
fn the_clock_of_each_contact_tells_which_one_closes_or_opens() {
    let slave = Slave::new(Options::EVENTS);
    assert_eq!(slave.enter(), Status::Ok);
    for joint in ["A", "B", "C", "T"] {
        assert_eq!(slave.set_enumeration(&format!("joint.{joint}.model"), 2), Status::Ok);
    }
    assert_eq!(slave.set("crank.speed_start", 500.0), Status::Ok);
    let all: Vec<u32> = (FIRST_CLOCK..).take(7).collect();
    assert_eq!(slave.try_clocks(&all), Ok(vec![false; 7]), "in initialization mode");
    slave.ready(true);
    assert_eq!(slave.try_clocks(&all), Err(Status::Error), "in step mode");
    slave.lines();
    let closed = |slave: &Slave| {
        let pins = ["A", "B", "C"].map(|pin| slave.boolean(&format!("joint.{pin}.contact")));
        (pins, slave.integer("joint.T.contacts"))
    };
    let (mut time, mut ticks) = (0.0, [0; 7]);
    while time < 0.01 {
        let told = slave.step(time, STEP);
        time = told.time;
        let (depths, touching) = slave.corners();
        assert_eq!(slave.integer("joint.T.contacts"), touching.iter().filter(|touches| **touches).count() as i32);
        assert_eq!(slave.get("joint.T.penetration"), depths.into_iter().fold(f64::NEG_INFINITY, f64::max));
        assert!(depths.iter().zip(touching).all(|(depth, touches)| depth.abs() < 1e-10 || (*depth > 0.0) == touches));
        if !told.event {
            continue;
        }
        let (pins, corners) = closed(&slave);
        assert_eq!(slave.enter_event_mode(), Status::Ok);
        let active = slave.try_clocks(&all).expect("clocks");
        assert!(active.contains(&true));
        slave.handle_event();
        let after = closed(&slave);
        for pin in 0..3 {
            assert_eq!(active[pin], pins[pin] != after.0[pin], "pin {pin} at {time}");
        }
        let changed: Vec<bool> =
            touching.iter().zip(slave.corners().1).map(|(before, after)| *before != after).collect();
        assert_eq!(active[3..], changed);
        let corner_ticks = active[3..].iter().filter(|active| **active).count();
        assert!(corner_ticks as i32 >= (after.1 - corners).abs());
        assert_eq!(corner_ticks % 2, (after.1 - corners).unsigned_abs() as usize % 2);
        ticks.iter_mut().zip(active).for_each(|(ticks, active)| *ticks += i32::from(active));
    }
    assert!(ticks[..3].iter().all(|ticks| *ticks > 0) && ticks[3..].iter().sum::<i32>() > 0, "{ticks:?}");
    assert_eq!(ticks.iter().sum::<i32>(), slave.integer("solver.events"));
}

#[test]
fn an_event_indicator_is_read_as_long_as_the_scene_has_it() {
    let slave = Slave::new(Options::EVENTS);
    assert_eq!(slave.enter(), Status::Ok);
    assert_eq!(slave.try_get_reference(FIRST_INDICATOR), Ok(1.0), "no rod of this length comes across the guide");
    assert_eq!(slave.set_enumeration("joint.C.model", 2), Status::Ok);
    assert_eq!(slave.try_get_reference(FIRST_INDICATOR), Err(Status::Error), "a worn pin has no change point");
    assert!(slave.line().text.contains("no event indicator of this number"));
}
