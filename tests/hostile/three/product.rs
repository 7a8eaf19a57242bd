//! The product of all functions, states and arguments, for FMI 3.0.

use super::stage::{STATES, Stage, Use};
use crate::brief;
use crate::importer::{Options, Slave};
use crate::product::walk;
use slidercrank::fmi::v3::Status;

fn products(of: impl Fn(Use) -> bool, theirs: &Slave) {
    let state = theirs.save();
    let cases: usize = STATES.iter().filter(|(usage, _)| of(*usage)).map(|&at| walk(|| Stage::reach(at, state))).sum();
    println!("{cases} calls");
    assert!(cases > if brief() { 1_000 } else { 5_000 }, "{cases}");
    assert_eq!(theirs.set_state(state), Status::Ok);
}

#[test]
fn whatever_is_not_possible_is_refused_in_one_line_and_changes_nothing() {
    products(|usage| usage != Use::Exchange, &Slave::new(Options::default()));
}

#[test]
fn so_it_is_in_model_exchange() {
    products(|usage| usage == Use::Exchange, &Slave::exchanging());
}
