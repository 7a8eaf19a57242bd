//! Runs that end for good: the rod comes to stand across the guide.

use host::Slave;
use slidercrank::fmi::v2::Status;

const SPEED: f64 = 100.0;

/// With a crank longer than its rod, in initialization mode, under a speed drive or a torque.
fn short(driven: bool, stop: Option<f64>) -> Slave {
    let slave = Slave::new();
    let defined = i32::from(stop.is_some());
    assert_eq!(slave.setup_raw(0, 0.0, 0.0, defined, stop.unwrap_or_default()), Status::Ok);
    assert_eq!(slave.set_integer("drive.mode", if driven { 2 } else { 1 }), Status::Ok);
    assert_eq!(slave.set("crank.speed_start", SPEED), Status::Ok);
    assert_eq!(slave.set("crank.length", 0.2), Status::Ok);
    assert_eq!(slave.enter(), Status::Ok);
    slave
}

fn terminated(slave: &Slave) -> i32 {
    let mut value = -1;
    // SAFETY: a live component, one place.
    let status = unsafe { (slave.api.GetBooleanStatus)(slave.c, 3, &mut value) };
    assert_eq!(status, Status::Ok);
    value
}

/// [s] When sin θ = l/r, as far as the rod may turn.
fn end() -> f64 {
    (0.12_f64 / 0.2).asin() / SPEED
}

#[test]
fn a_speed_that_leads_to_a_dead_end_is_refused_before_the_first_step() {
    let slave = short(true, None);
    assert_eq!(slave.exit(), Status::Error);
    let text = slave.log.only().text;
    assert!(text.contains("rod.length = 0.12 is not allowed: above 0.2 m for the crank to turn"), "{text}");
    let told: f64 = text.split("at t = ").nth(1).and_then(|rest| rest.split(' ').next()?.parse().ok()).expect("a time");
    assert!((told - end()).abs() < 1e-5, "{text}");
    // The importer may correct it: by a rod, by play, by a crank that stands, by a torque.
    for (correct, back) in
        [(("rod.length", 0.3), ("rod.length", 0.12)), (("crank.speed_start", 0.0), ("crank.speed_start", SPEED))]
    {
        assert_eq!(slave.set(correct.0, correct.1), Status::Ok);
        assert!(slave.try_get("slider.x").is_ok());
        assert_eq!(slave.set(back.0, back.1), Status::Ok);
        assert_eq!(slave.try_get("slider.x"), Err(Status::Error));
    }
    for (name, value) in [("joint.C.model", 2), ("drive.mode", 1), ("rod.flexible.bending_modes", 1)] {
        let before = slave.get_integer(name);
        assert_eq!(slave.set_integer(name, value), Status::Ok);
        assert!(slave.try_get("slider.x").is_ok(), "{name}");
        assert_eq!(slave.set_integer(name, before), Status::Ok);
    }
    // A guide that is too far off is the same.
    assert_eq!((slave.set("crank.length", 0.05), slave.set("guide.offset", 0.08)), (Status::Ok, Status::Ok));
    slave.log.take();
    assert_eq!(slave.exit(), Status::Error);
    assert!(slave.log.only().text.contains("above 0.13 m"));
    assert_eq!(slave.set("guide.offset", 0.06), Status::Ok);
    assert_eq!(slave.exit(), Status::Ok);
    slave.steps(0.0, 1e-3, 100);
}

#[test]
fn an_experiment_that_stops_before_is_run() {
    let slave = short(true, Some(0.9 * end()));
    assert_eq!(slave.exit(), Status::Ok, "{:?}", slave.log.take());
    slave.steps(0.0, 0.1 * end(), 9);
    let slave = short(true, Some(1.1 * end()));
    assert_eq!(slave.exit(), Status::Error);
    slave.log.take();
}

#[test]
fn a_run_that_has_come_to_a_dead_end_wants_to_be_terminated() {
    let slave = short(false, None);
    assert_eq!(slave.exit(), Status::Ok);
    let mut before = slave.save();
    assert_eq!(terminated(&slave), 0);
    assert_eq!(slave.step(0.0, 1.0), Status::Discard);
    assert!(slave.log.only().text.contains("the rod stands across the guide"));
    assert_eq!(terminated(&slave), 1);
    assert!(slave.last_time() > 0.0 && slave.last_time() < 0.1);
    // A saved state keeps it, another one and a reset do not.
    let bytes = slave.bytes_of(slave.save());
    assert_eq!(slave.set_state(before), Status::Ok);
    assert_eq!(terminated(&slave), 0);
    let other = Slave::new();
    let ended = other.deserialize(&bytes).expect("a state");
    assert_eq!(other.set_state(ended), Status::Ok);
    assert_eq!(terminated(&other), 1);
    assert_eq!(other.reset(), Status::Ok);
    assert_eq!((other.enter(), other.exit()), (Status::Ok, Status::Ok));
    assert_eq!(terminated(&other), 0);
    assert_eq!(slave.free(&mut before), Status::Ok);
}
