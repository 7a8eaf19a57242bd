//! Parameters at the ends of their ranges, alone and together by chance: a run of numbers, or one line that says why not.

use crate::face::Face;
use crate::forged::{H, START};
use crate::scenes::{MECHANISMS, hosted};
use crate::{brief, tried};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use slidercrank::fmi::slave::Interface;
use slidercrank::fmi::v2::Status;
use slidercrank::scene::PARAMETERS;
use slidercrank::scene::parameter::{Kind, Parameter};

/// Most evaluations in one step.
const LIMIT: &str = "solver.max_evaluations";
/// Where each mechanism is tried with each value. The default of 2e7 lets the few steps that never end by themselves take
/// most of the time, and they meet nothing else on the way.
const LONG: f64 = 200_000.0;
/// On the other faces. A step that stops at events may be followed by any number of others, each as long as the limit lets
/// it be.
const SHORT: f64 = 10_000.0;

/// The ends of a parameter's range.
fn ends(parameter: &Parameter) -> Vec<f64> {
    match parameter.kind {
        Kind::Real { min, max, .. } => vec![min, max],
        Kind::Integer { min, max, .. } => vec![f64::from(min), f64::from(max)],
        Kind::Boolean { .. } => vec![0.0, 1.0],
        Kind::Enumeration { items, .. } => items.iter().map(|(_, item)| f64::from(*item)).collect(),
    }
}

/// Sets a parameter, unless the importer integrates and would need other states.
fn set<F: Face>(slave: &F, parameter: &Parameter, value: f64) -> bool {
    let status = slave.set(parameter.name, value);
    if status == Status::Ok {
        return true;
    }
    let line = slave.only();
    let exchange = F::INTERFACE == Interface::ModelExchange && line.text.contains("modelDescription.xml");
    assert!(exchange && status == Status::Error, "{} = {value}: {line:?}", parameter.name);
    false
}

/// Runs a mechanism with these values; whether it can run.
fn run<F: Face>(mechanism: usize, values: &[(usize, f64)]) -> bool {
    let what = || {
        let named = values.iter().map(|(place, value)| format!("{} = {value:e}", PARAMETERS[*place].name));
        format!("{}: {}", MECHANISMS[mechanism].name, named.collect::<Vec<_>>().join(", "))
    };
    let slave: F = MECHANISMS[mechanism].initializing_from(START);
    if !values.iter().all(|(place, value)| set(&slave, &PARAMETERS[*place], *value)) {
        return false;
    }
    if !values.iter().any(|(place, _)| PARAMETERS[*place].name == LIMIT) {
        assert_eq!(slave.set(LIMIT, if F::ONE_IN > 1 { SHORT } else { LONG }), Status::Ok);
    }
    let status = slave.begin();
    let lines = slave.lines();
    assert!(lines.len() == usize::from(status == Status::Error) && status != Status::Fatal, "{}: {lines:?}", what());
    if status != Status::Ok {
        return false;
    }
    let mut point = START;
    for _ in 0..3 {
        slave.look(&what());
        assert_eq!(slave.set("slider.load", 100.0), Status::Ok);
        let status = slave.step(point, H);
        let lines = slave.lines();
        assert!([Status::Ok, Status::Discard, F::FAILED].contains(&status), "{}: {lines:?}", what());
        if status != Status::Ok {
            break;
        }
        point += H;
    }
    let (saved, before) = (slave.save(), slave.memory());
    assert_eq!(slave.restore(saved), Status::Ok, "{}: {:?}", what(), slave.lines());
    assert!(slave.memory() == before, "{}", what());
    true
}

fn each_parameter_at_each_end_of_its_range<F: Face>() {
    let (mut ran, mut told) = (0, 0);
    for mechanism in hosted::<F>() {
        for (place, parameter) in PARAMETERS.iter().enumerate() {
            for end in ends(parameter) {
                *if run::<F>(mechanism, &[(place, end)]) { &mut ran } else { &mut told } += 1;
            }
        }
    }
    println!("{ran} ran, {told} told");
    assert!(ran > told && told > 0, "{ran} ran, {told} told");
}

fn many_parameters_at_the_ends_of_their_ranges<F: Face>() {
    let cases = if brief() { 5 } else { tried(1_000 / F::ONE_IN as u32) };
    let config = Config { cases, rng_seed: RngSeed::Fixed(0xE0D5), failure_persistence: None, ..Config::default() };
    let value =
        (0..PARAMETERS.len()).prop_flat_map(|place| (Just(place), prop::sample::select(ends(&PARAMETERS[place]))));
    let hosts = (prop::sample::select(hosted::<F>()), prop::collection::vec(value, 1..12));
    let outcome = TestRunner::new(config).run(&hosts, |(mechanism, values)| {
        run::<F>(mechanism, &values);
        Ok(())
    });
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
}

on_each_face! {
    each_parameter_at_each_end_of_its_range
    many_parameters_at_the_ends_of_their_ranges
}
