//! Parameters at the ends of their ranges, alone and together by chance: a run of numbers, or one line that says why not.

use crate::brief;
use crate::forged::{H, START};
use crate::host::Slave;
use crate::invalid_arguments::look;
use crate::scenes::MECHANISMS;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use slidercrank::fmi::v2::Status;
use slidercrank::scene::PARAMETERS;
use slidercrank::scene::parameter::{Kind, Parameter};

/// The ends of a parameter's range.
fn ends(parameter: &Parameter) -> Vec<f64> {
    match parameter.kind {
        Kind::Real { min, max, .. } => vec![min, max],
        Kind::Integer { min, max, .. } => vec![f64::from(min), f64::from(max)],
        Kind::Boolean { .. } => vec![0.0, 1.0],
        Kind::Enumeration { items, .. } => items.iter().map(|(_, item)| f64::from(*item)).collect(),
    }
}

fn set(slave: &Slave, parameter: &Parameter, value: f64) {
    let status = match parameter.kind {
        Kind::Real { .. } => slave.set(parameter.name, value),
        Kind::Boolean { .. } => slave.set_boolean(parameter.name, value as i32),
        Kind::Integer { .. } | Kind::Enumeration { .. } => slave.set_integer(parameter.name, value as i32),
    };
    assert_eq!(status, Status::Ok, "{} = {value}: {:?}", parameter.name, slave.log.take());
}

/// Runs a mechanism with these values; whether it can run.
fn run(mechanism: usize, values: &[(usize, f64)]) -> bool {
    let what = || {
        let named = values.iter().map(|(place, value)| format!("{} = {value:e}", PARAMETERS[*place].name));
        format!("{}: {}", MECHANISMS[mechanism].name, named.collect::<Vec<_>>().join(", "))
    };
    let slave = MECHANISMS[mechanism].initializing_from(START);
    values.iter().for_each(|(place, value)| set(&slave, &PARAMETERS[*place], *value));
    let status = slave.exit();
    let lines = slave.log.take();
    assert!(lines.len() == usize::from(status == Status::Error) && status != Status::Fatal, "{}: {lines:?}", what());
    if status != Status::Ok {
        return false;
    }
    let mut point = START;
    for _ in 0..3 {
        look(&slave, &what());
        assert_eq!(slave.set("slider.load", 100.0), Status::Ok);
        let status = slave.step(point, H);
        let lines = slave.log.take();
        assert!(matches!(status, Status::Ok | Status::Discard), "{}: {lines:?}", what());
        if status != Status::Ok {
            break;
        }
        point += H;
    }
    let saved = slave.save();
    let picture = |slave: &Slave| slave.bytes_of(slave.save());
    let before = picture(&slave);
    assert_eq!(slave.set_state(saved), Status::Ok, "{}: {:?}", what(), slave.log.take());
    assert!(picture(&slave) == before, "{}", what());
    true
}

#[test]
fn each_parameter_at_each_end_of_its_range() {
    let (mut ran, mut told) = (0, 0);
    for mechanism in 0..if brief() { 1 } else { MECHANISMS.len() } {
        for (place, parameter) in PARAMETERS.iter().enumerate() {
            for end in ends(parameter) {
                *if run(mechanism, &[(place, end)]) { &mut ran } else { &mut told } += 1;
            }
        }
    }
    println!("{ran} ran, {told} told");
    assert!(ran > told && told > 0, "{ran} ran, {told} told");
}

#[test]
fn many_parameters_at_the_ends_of_their_ranges() {
    let cases = if brief() { 5 } else { 1_000 };
    let config = Config { cases, rng_seed: RngSeed::Fixed(0xE0D5), failure_persistence: None, ..Config::default() };
    let value =
        (0..PARAMETERS.len()).prop_flat_map(|place| (Just(place), prop::sample::select(ends(&PARAMETERS[place]))));
    let hosts = (0..MECHANISMS.len(), prop::collection::vec(value, 1..12));
    let outcome = TestRunner::new(config).run(&hosts, |(mechanism, values)| {
        run(mechanism, &values);
        Ok(())
    });
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
}
