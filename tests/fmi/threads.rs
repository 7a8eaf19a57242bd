//! Several instances: interleaved, made here and freed there.

use host::Slave;
use slidercrank::fmi::v2::Status;
use std::thread;

const H: f64 = 1e-4;

/// A slave whose speed depends on `i`.
fn nth(i: u32) -> Slave {
    let slave = Slave::initializing();
    slave.wear();
    assert_eq!(slave.set("crank.speed_start", 100.0 + f64::from(i)), Status::Ok);
    assert_eq!(slave.exit(), Status::Ok);
    slave
}

fn alone(i: u32) -> Vec<u64> {
    let slave = nth(i);
    slave.steps(0.0, H, 60);
    slave.picture()
}

#[test]
fn two_interleaved_instances_equal_two_runs_alone() {
    let slaves = [nth(1), nth(2)];
    let mut point = 0.0;
    for _ in 0..60 {
        let ends = slaves.each_ref().map(|slave| slave.steps(point, H, 1));
        point = ends[0];
    }
    assert_eq!(slaves.map(|slave| slave.picture()), [alone(1), alone(2)]);
}

#[test]
fn an_instance_may_move_between_threads() {
    let slave = nth(3);
    let slave = thread::spawn(move || {
        slave.steps(0.0, H, 30);
        slave
    });
    let slave = slave.join().expect("a run");
    let point = (0..30).fold(0.0, |point, _| point + H);
    let picture = thread::spawn(move || {
        slave.steps(point, H, 30);
        slave.picture()
    });
    assert_eq!(picture.join().expect("a run"), alone(3));
}
