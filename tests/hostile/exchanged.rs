//! An importer that integrates: by Euler's method, which leads from any state to another.

use crate::face::Answer;
use crate::scenes::packaged;
use slidercrank::fmi::slave::states::exchange;
use slidercrank::fmi::v2::Status;
use slidercrank::scene::slot;
use slidercrank::simulation::contacts;

/// [s] A longer step is divided, …
const LONGEST: f64 = 1e-6;
/// … but not into more parts than these.
const PARTS: f64 = 200.0;
/// Place of the mechanism with bristles, which Euler's method follows by very short steps alone.
pub const BRISTLES: usize = 4;

/// The functions of model exchange, of either version. An array comes with as many entries as the slave wants.
pub trait Exchanged {
    fn set_time(&self, time: f64) -> Result<(), Status>;
    fn read_states(&self, states: &mut [f64]) -> Result<(), Status>;
    fn write_states(&self, states: &[f64]) -> Result<(), Status>;
    fn read_derivatives(&self, derivatives: &mut [f64]) -> Result<(), Status>;
    fn read_indicators(&self, indicators: &mut [f64]) -> Result<(), Status>;
    fn read_nominals(&self, nominals: &mut [f64]) -> Result<(), Status>;
    /// Whether the importer is to enter event mode.
    fn completed(&self) -> Result<bool, Status>;
    fn enter_event_mode(&self) -> Result<(), Status>;
    /// Whether another update is needed, and whether the run is over.
    fn update(&self) -> Result<[bool; 2], Status>;
    fn enter_continuous_time_mode(&self) -> Result<(), Status>;
}

/// Numbers of continuous states and of event indicators.
pub fn counts() -> (usize, usize) {
    let exchange = exchange(&slot::read().expect("a readable slot").0).expect("a mechanism with equations of motion");
    (exchange.states.len(), exchange.indicators.len())
}

/// Factor of the steps that a run of the packaged mechanism takes, whose contacts are stiffer than its drive.
pub fn pace() -> f64 {
    match packaged() {
        BRISTLES => 1e-5,
        _ if !contacts(&slot::read().expect("a readable slot").0).is_empty() => 0.1,
        _ => 1.0,
    }
}

/// Handles an event, from event mode on.
pub fn handle_event(host: &impl Exchanged) -> Result<(), Status> {
    for _ in 0..10 {
        let [again, over] = host.update()?;
        if over {
            return Err(Status::Discard);
        }
        if !again {
            return host.enter_continuous_time_mode();
        }
    }
    panic!("an event without end")
}

/// From `point` by `size`.
pub fn step(host: &impl Exchanged, point: f64, size: f64) -> Result<(), Status> {
    let parts = (size / LONGEST).ceil().clamp(1.0, PARTS);
    for part in 0..parts as usize {
        let from = point + size * (part as f64 / parts);
        euler(host, from, point + size * ((part + 1) as f64 / parts))?;
    }
    Ok(())
}

fn euler(host: &impl Exchanged, from: f64, to: f64) -> Result<(), Status> {
    let (states, indicators) = counts();
    let (mut at, mut rates, mut before, mut after) =
        (vec![0.0; states], vec![0.0; states], vec![0.0; indicators], vec![0.0; indicators]);
    host.set_time(from)?;
    host.read_states(&mut at)?;
    host.read_derivatives(&mut rates)?;
    host.read_indicators(&mut before)?;
    at.iter_mut().zip(&rates).for_each(|(state, rate)| *state += (to - from) * rate);
    if !at.iter().all(|state| state.is_finite()) {
        return Err(Status::Discard);
    }
    host.set_time(to)?;
    host.write_states(&at)?;
    host.read_indicators(&mut after)?;
    let crossed = before.iter().zip(&after).any(|(before, after)| (*before > 0.0) != (*after > 0.0));
    if host.completed()? || crossed {
        host.enter_event_mode()?;
        handle_event(host)?;
    }
    Ok(())
}

/// Shows every number that is told besides variables.
pub fn show_numbers(host: &impl Exchanged, show: &mut dyn FnMut(&str, Answer)) {
    let (states, indicators) = counts();
    // One that is no number stands for all.
    let worst = |values: Vec<f64>| values.into_iter().find(|value| !value.is_finite()).unwrap_or(0.0);
    let mut all = |name: &str, count: usize, read: &dyn Fn(&mut [f64]) -> Result<(), Status>| {
        let mut values = vec![f64::NAN; count];
        let outcome = read(&mut values);
        show(name, outcome.map(|()| worst(values)));
    };
    all("state", states, &|values| host.read_states(values));
    all("derivative of", states, &|values| host.read_derivatives(values));
    all("event indicator", indicators, &|values| host.read_indicators(values));
    all("nominal", states, &|values| host.read_nominals(values));
}

/// As a status.
pub fn status(outcome: Result<(), Status>) -> Status {
    outcome.err().unwrap_or(Status::Ok)
}
