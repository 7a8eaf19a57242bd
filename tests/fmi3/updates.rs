//! Intermediate updates: values at every accepted step, inputs from there on, early return.

use crate::importer::{Callback, Handle, Options, Slave, vr};
use slidercrank::fmi::slave::Interface;
use slidercrank::fmi::slave::log::Silent;
use slidercrank::fmi::v3::abi::functions::bodies::*;
use slidercrank::fmi::v3::instance::{Request, StepRequest};
use slidercrank::fmi::v3::lifecycle::State;
use slidercrank::fmi::v3::step::Stage;
use slidercrank::fmi::v3::{Error, Instance, Status};
use std::cell::RefCell;
use std::rc::Rc;

/// An instance whose updates do this.
fn with(
    intermediate: &[&str],
    early_return: bool,
    update: impl FnMut(&Handle, f64, bool) -> Option<f64> + 'static,
) -> Slave {
    let update = Some(Box::new(update) as Callback);
    Slave::running(Options { event_mode: false, early_return, logging: true, intermediate, update })
}

#[test]
fn values_are_told_at_every_accepted_step() {
    let seen = Rc::new(RefCell::new(vec![]));
    let keep = Rc::clone(&seen);
    let slave = with(&["crank.angle", "slider.x"], false, move |slave, time, can_return_early| {
        assert!(!can_return_early);
        keep.borrow_mut().push((time, slave.get("slider.x")));
        None
    });
    let told = slave.step(0.0, 0.01);
    assert!(!told.early && told.time == 0.01);
    let seen = seen.take();
    assert!(seen.is_sorted_by(|a, b| a.0 < b.0) && seen.iter().all(|(time, _)| (0.0..0.01).contains(time)));
    // The last step reaches beyond the communication point.
    let steps = slave.integer("solver.steps");
    assert!((steps - 1..=steps).contains(&(seen.len() as i32)), "{} of {steps}", seen.len());
    // What was seen is the trajectory.
    let other = Slave::running(Options::default());
    let mut point = 0.0;
    for (time, x) in seen {
        let told = other.step(point, time - point);
        point = told.time;
        assert!((other.get("slider.x") - x).abs() < 1e-12, "at {time}");
    }
}

#[test]
fn inputs_set_in_an_update_count_from_there_on() {
    // A load that falls with time, known at steps only: the mean error is below that of a load that is held all along.
    let load = |time: f64| -2e5 * time;
    let run = |slave: Slave, held: bool| {
        for point in 0..10_i32 {
            let time = f64::from(point) * 1e-3;
            if !held {
                assert_eq!(slave.set("slider.load", load(time)), Status::Ok);
            }
            slave.step(time, 1e-3);
        }
        slave.get("slider.v")
    };
    let updated = with(&["slider.load"], false, move |slave, time, _| {
        assert_eq!(slave.set("slider.load", load(time)), Status::Ok);
        None
    });
    let updated = run(updated, false);
    let held = run(Slave::running(Options::default()), false);
    let free = run(Slave::running(Options::default()), true);
    assert!(updated != held && held != free && updated != free);
}

#[test]
fn only_the_variables_named_are_touched_and_parameters_never() {
    let lines = Rc::new(RefCell::new(0));
    let count = Rc::clone(&lines);
    let slave = with(&["slider.x", "slider.load"], true, move |slave, time, _| {
        if *count.borrow() == 0 {
            assert_eq!(slave.try_get("slider.v"), Err(Status::Error));
            assert_eq!(slave.set("crank.torque", 1.0), Status::Error);
            assert_eq!(slave.set("slider.x", 1.0), Status::Error);
            assert_eq!(slave.set("slider.mass", 1.0), Status::Error);
            assert_eq!(slave.try_step(time, 1e-3), Err(Status::Error));
            for refused in [slave.reset(), slave.terminate(), slave.enter_event_mode(), slave.exit()] {
                assert_eq!(refused, Status::Error);
            }
            assert!(slave.try_save().is_err());
            // Freed within its own step, the instance would be gone when the step goes on.
            // SAFETY: refused.
            unsafe { fmi3FreeInstance(slave.0) };
            assert!(slave.rate("slider.x").is_ok());
            assert_eq!(slave.set("slider.load", -1.0), Status::Ok);
            *count.borrow_mut() += 1;
        }
        None
    });
    slave.step(0.0, 2e-3);
    assert_eq!(*lines.borrow(), 1);
    assert_eq!(slave.lines().len(), 11);
    assert_eq!(slave.get("slider.load"), -1.0);
}

#[test]
fn a_step_returns_when_the_importer_wants_it() {
    let wanted = Rc::new(RefCell::new(None));
    let asked = Rc::clone(&wanted);
    let slave = with(&[], true, move |_, time, can_return_early| {
        assert!(can_return_early);
        asked.borrow().map(|after: f64| time + after)
    });
    assert!(!slave.step(0.0, 1e-3).early);
    // At once.
    wanted.replace(Some(0.0));
    let told = slave.step(1e-3, 1e-3);
    assert!(told.early && !told.event && (1e-3..2e-3).contains(&told.time), "{told:?}");
    // A little later; and never beyond the communication point.
    wanted.replace(Some(1e-9));
    let next = slave.step(told.time, 1e-3);
    assert!(next.early && next.time > told.time, "{next:?}");
    wanted.replace(Some(f64::INFINITY));
    let last = slave.step(next.time, 1e-3);
    assert!(!last.early && last.time == next.time + 1e-3, "{last:?}");
    // A time before now, or none, means now.
    for odd in [-1.0, f64::NAN, f64::NEG_INFINITY] {
        wanted.replace(Some(odd));
        let (from, told) = (last.time, slave.step(slave.time(), 1e-3));
        assert!(told.early && told.time > from, "{told:?}");
    }
}

#[test]
fn without_early_return_a_request_is_not_heard() {
    let slave = with(&[], false, |_, time, _| Some(time));
    let told = slave.step(0.0, 1e-3);
    assert!(!told.early && told.time == 1e-3);
}

#[test]
fn a_callback_and_its_variables_go_together() {
    let guid = host::guid();
    let refused = |options: Options| {
        let lines = Slave::try_new(options, &guid).err().expect("refused");
        assert!(lines.len() == 1 && lines[0].status == Status::Error as i32, "{lines:?}");
        lines[0].text.clone()
    };
    let text = refused(Options { intermediate: &["slider.x"], ..Options::default() });
    assert!(text.contains("intermediateUpdate is NULL"), "{text}");
    let update = || Some(Box::new(|_: &Handle, _, _| None) as Callback);
    for odd in ["slider.mass", "joint.C.contact", "drive.mode"] {
        let text = refused(Options { intermediate: &[odd], update: update(), ..Options::default() });
        assert!(text.contains("requiredIntermediateVariables"), "{text}");
    }
}

#[test]
fn a_step_has_the_same_bound_on_its_work_with_updates_as_without() {
    for updates in [false, true] {
        let update = updates.then(|| Box::new(|_: &Handle, _, _| None) as Callback);
        let slave = Slave::worn_pin(Options { logging: true, update, ..Options::default() });
        assert_eq!(slave.set_integer("solver.max_evaluations", 20_000), Status::Ok);
        slave.ready(false);
        assert_eq!(slave.try_step(0.0, 1e3), Err(Status::Error));
        assert!(slave.line().text.contains("solver.max_evaluations"));
    }
}

/// What no importer can bring about: a fault of the library while the callback runs.
#[test]
fn an_instance_that_is_given_up_within_a_step_is_neither_freed_there_nor_goes_on() {
    let token = host::guid();
    let steps = StepRequest { has_callback: true, ..StepRequest::default() };
    let (name, token, interface) = (Some(c"x"), Some(token.as_c_str()), Interface::CoSimulation);
    let request = Request { interface, name, token, logging_on: false, steps };
    let mut instance = Instance::instantiate(&request, Box::new(Silent), None).expect("an instance");
    instance.set_float64(&[vr("crank.speed_start")], &[500.0]).expect("a start value");
    instance.enter_initialization_mode(None, 0.0, None).expect("a start");
    instance.exit_initialization_mode().expect("a mechanism");
    instance.begin_step(0.0, 0.1).expect("a step");
    assert!(matches!(instance.go_on(), Ok(Stage::Update(_))));
    instance.give_up();
    assert!(instance.check_free().is_err());
    instance.end_update(None);
    assert_eq!(instance.go_on(), Err(Error::CallOrder(State::Fatal)));
    assert_eq!(instance.check_free(), Ok(()));
}
