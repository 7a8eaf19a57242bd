//! Communication points, stop time, and steps that fail.

use host::Slave;
use slidercrank::fmi::v2::Status;

/// The next number above.
fn up(x: f64) -> f64 {
    f64::from_bits(x.to_bits() + 1)
}

/// Initialized without stop or with one.
fn from_to(start: f64, stop: Option<f64>) -> Slave {
    let slave = Slave::new();
    let setup = slave.setup_raw(0, 0.0, start, i32::from(stop.is_some()), stop.unwrap_or(0.0));
    assert_eq!(setup, Status::Ok);
    assert_eq!(slave.set("crank.speed_start", 100.0), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    slave
}

#[test]
fn communication_points_may_differ_by_rounding() {
    let slave = from_to(0.0, None);
    let (h, n) = (1.0 / 60.0, 600);
    let mut sum = 0.0;
    for i in 0..n {
        // One importer multiplies, the other adds up; this one does both by turns.
        let point = if i % 2 == 0 { f64::from(i) * h } else { sum };
        assert_eq!(slave.step(point, h), Status::Ok, "{:?}", slave.log.take());
        sum += h;
    }
    assert!((slave.last_time() - 10.0).abs() < 1e-9);
    assert_eq!(slave.step(up(up(slave.last_time())), up(h)), Status::Ok);
}

#[test]
fn time_is_the_importers() {
    let slave = from_to(0.0, None);
    let h = 0.009_999_999_999_999_3;
    let point = slave.steps(0.0, h, 1000);
    assert_eq!(slave.last_time().to_bits(), point.to_bits());
}

/// Every output of a worn pin after steps of 1/32768 s from `start` [s], and after one that turned back.
fn worn_pin_from(start: f64) -> String {
    const STEP: f64 = 1.0 / 32768.0;
    let slave = Slave::new();
    assert_eq!(slave.setup_raw(0, 0.0, start, 0, 0.0), Status::Ok);
    assert_eq!(slave.set("crank.speed_start", 500.0), Status::Ok);
    assert_eq!(slave.set_integer("joint.C.model", 2), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    for step in 0..200 {
        assert_eq!(slave.set("slider.load", if step < 100 { 0.0 } else { -300.0 }), Status::Ok);
        assert_eq!(slave.step(start + f64::from(step) * STEP, STEP), Status::Ok, "{:?}", slave.log.take());
    }
    assert_eq!(slave.last_time().to_bits(), (start + 200.0 * STEP).to_bits());
    format!("{:?}", slave.picture())
}

#[test]
fn a_run_has_the_same_bits_from_any_start_time() {
    let wanted = worn_pin_from(0.0);
    // 1.7e9 s is now, counted from 1970.
    for start in [3.0, -1024.5, 1e6, 1.7e9] {
        assert_eq!(worn_pin_from(start), wanted, "from {start} s");
    }
}

#[test]
fn a_step_that_cannot_go_on_names_the_importers_time() {
    let slave = Slave::new();
    assert_eq!(slave.setup_raw(0, 0.0, 1000.0, 0, 0.0), Status::Ok);
    assert_eq!(slave.set("crank.speed_start", 500.0), Status::Ok);
    assert_eq!(slave.set_integer("joint.C.model", 2), Status::Ok);
    assert_eq!(slave.set_integer("solver.max_evaluations", 2000), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    assert_eq!(slave.step(1000.0, 10.0), Status::Discard);
    let text = slave.log.only().text;
    assert!(text.contains("at t = 1000."), "{text}");
    assert!((1000.0..1010.0).contains(&slave.last_time()), "{}", slave.last_time());
}

#[test]
fn another_communication_point_is_refused_and_changes_nothing() {
    let slave = from_to(1.0, None);
    let point = slave.steps(1.0, 1e-3, 3);
    let before = slave.picture();
    for elsewhere in [1.0, point - 1e-3, point + 1e-3, point + 1e-6, -point, 0.0] {
        assert_eq!(slave.step(elsewhere, 1e-3), Status::Error);
        let text = slave.log.only().text;
        assert!(text.contains("currentCommunicationPoint") && text.contains(&format!("{point:?}")), "{text}");
    }
    assert_eq!(slave.picture(), before);
    slave.steps(point, 1e-3, 1);
}

#[test]
fn a_defined_stop_time_bounds_the_last_step_up_to_rounding() {
    let slave = from_to(0.0, Some(1.0));
    let point = slave.steps(0.0, 0.1, 9);
    assert_eq!(slave.step(point, 0.2), Status::Error);
    assert!(slave.log.only().text.contains("stopTime"));
    assert_eq!(slave.step(point, up(0.1)), Status::Ok);
    assert_eq!(slave.step(slave.last_time(), 1e-3), Status::Error);
    assert!(slave.log.only().text.contains("stopTime"));
    assert_eq!(slave.terminate(), Status::Ok);
}

#[test]
fn an_undefined_stop_time_means_nothing() {
    let slave = Slave::new();
    assert_eq!(slave.setup_raw(0, 0.0, 0.0, 0, 1.0), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    slave.steps(0.0, 0.5, 10);
}

#[test]
fn a_step_below_the_rounding_of_time_is_a_step() {
    let slave = from_to(1000.0, None);
    assert_eq!(slave.step(1000.0, 1e-20), Status::Ok);
    assert_eq!(slave.last_time(), 1000.0);
    slave.steps(1000.0, 1e-3, 2);
}

#[test]
fn a_failed_step_is_told_undone_and_redone() {
    let slave = Slave::running();
    let point = slave.steps(0.0, 1e-3, 5);
    let saved = slave.save();
    let before = slave.picture();
    // More than a floating-point number can hold once it is divided by a mass.
    assert_eq!(slave.set("slider.load", 1e308), Status::Ok);
    assert_eq!(slave.step(point, 1e-3), Status::Discard);
    let line = slave.log.only();
    assert_eq!((line.status, line.category.as_str()), (2, "logStatusDiscard"));
    assert!(slave.last_time() >= point && slave.last_time() < point + 1e-3);
    let (mut status, mut terminated) = (-1, -1);
    // SAFETY: live component, one place each.
    unsafe {
        assert_eq!((slave.api.GetStatus)(slave.c, 0, &mut status), Status::Ok);
        assert_eq!((slave.api.GetBooleanStatus)(slave.c, 3, &mut terminated), Status::Ok);
    }
    assert_eq!((status, terminated), (2, 0));
    assert_eq!(slave.step(point, 1e-3), Status::Error);
    slave.log.take();
    assert!(slave.try_get("crank.angle").is_ok());
    assert_eq!(slave.set_state(saved), Status::Ok);
    assert_eq!(slave.picture(), before);
    slave.steps(point, 1e-3, 5);
    let reference = Slave::running();
    reference.steps(0.0, 1e-3, 10);
    assert_eq!(slave.picture(), reference.picture());
}

#[test]
fn a_step_that_takes_too_much_work_ends_on_its_way() {
    let slave = Slave::new();
    slave.wear();
    assert_eq!(slave.set_integer("solver.max_evaluations", 2000), Status::Ok);
    assert_eq!(slave.setup_raw(0, 0.0, 0.0, 0, 0.0), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    let saved = slave.save();
    assert_eq!(slave.step(0.0, 0.1), Status::Discard);
    let (text, reached) = (slave.log.only().text, slave.last_time());
    assert!(text.contains("solver.max_evaluations") && reached > 0.0 && reached < 0.1, "{text}");
    let evaluations = slave.get_integer("solver.evaluations");
    assert!((2000..4000).contains(&evaluations), "{evaluations}");
    assert_eq!(slave.set_state(saved), Status::Ok);
    slave.steps(0.0, 1e-4, 10);
}

#[test]
fn a_failed_step_can_be_followed_by_a_reset() {
    let slave = Slave::running();
    assert_eq!(slave.set("slider.load", 1e308), Status::Ok);
    assert_eq!(slave.step(0.0, 1e-3), Status::Discard);
    assert_eq!(slave.reset(), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    slave.steps(0.0, 1e-3, 2);
}

#[test]
fn how_an_interval_is_split_does_not_matter_to_the_bit() {
    let (fine, coarse) = (Slave::running(), Slave::running());
    // Powers of two, so that both importers' points are the same numbers.
    fine.steps(0.0, 1.0 / 16384.0, 256);
    coarse.steps(0.0, 1.0 / 256.0, 4);
    // The largest approach speed is that of the last interval, which is therefore the same.
    fine.steps(1.0 / 64.0, 1.0 / 16384.0, 1);
    coarse.steps(1.0 / 64.0, 1.0 / 16384.0, 1);
    assert_eq!(fine.picture(), coarse.picture());
}
