//! Times, step sizes and tolerances.

use super::{Argument, Fault, Value, bad, good};
use crate::invoke::Word;
use crate::stage::STOP;
use slidercrank::fmi::v2::Status;

/// No times.
pub const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// A sound number, others that are sound, and others that are refused by this name.
fn number(sound: &[f64], refused: &[f64], name: &str) -> Argument {
    let sound = sound.iter().map(|&number| good(Word::Real(number)));
    let refused = NOT_FINITE.iter().chain(refused).map(|&number| bad(Word::Real(number), name));
    sound.chain(refused).collect::<Vec<_>>().into()
}

/// Tolerance and times of an experiment.
pub fn experiment(flag: &Argument) -> Vec<Argument> {
    let mut tolerance = number(&[1e-6], &[0.0, -0.0, -1e-6, f64::MIN], "tolerance");
    for beyond in [f64::MAX, f64::MIN_POSITIVE, 5e-324] {
        let fault = Fault { status: Status::Warning, words: vec!["tolerance".into()] };
        tolerance.values.push(Value { word: Word::Real(beyond), fault: Some(fault) });
    }
    let start = number(&[0.0, -0.0, 1.0, -1e308, 5e-324], &[], "startTime");
    let stop = number(&[STOP, 1e308, f64::MAX], &[-1.5e308, f64::MIN], "stopTime");
    vec![flag.clone(), tolerance.counted_by(1), start, flag.clone(), stop.counted_by(4)]
}

/// A time; an integrator's trial may lie anywhere.
pub fn time() -> Argument {
    number(&[0.0, -1.0, STOP, 1e300, 5e-324], &[], "time")
}

/// Communication point and size of a step, for an instance that is at `now` [s].
pub fn communication(now: f64) -> Vec<Argument> {
    let elsewhere = [now + 1.0, now - 1.0, now + 1e-6, -1e300, 1e300, f64::MAX, f64::MIN];
    let point = number(&[now, now.next_up()], &elsewhere, "currentCommunicationPoint");
    let mut size = number(
        &[1e-3, 1e-9, f64::EPSILON, f64::MIN_POSITIVE, 5e-324],
        &[0.0, -0.0, -1e-3, -5e-324, f64::MIN],
        "communicationStepSize",
    );
    size.values.extend([STOP, 1e300, f64::MAX].map(|beyond| bad(Word::Real(beyond), "stopTime")));
    vec![point, size]
}
