//! Gragg, Bulirsch and Stoer: modified midpoint rules with 2, 4, 6, … substeps, extrapolated to
//! substeps of length 0 (Hairer, Nørsett, Wanner, Solving ODEs I, II.9).

use crate::coordinates::{CONTACTS, COORDINATES};
use nalgebra::SVector;

pub const SIZE: usize = 2 * COORDINATES + CONTACTS + 6;
/// Coordinates, velocities, bristles, account.
pub type State = SVector<f64, SIZE>;

/// More columns would amplify round-off: the weights of the ninth row already add up to 150.
const COLUMNS: usize = 9;
/// Share of it that the independent round-off of the substeps leaves, rounded up.
const AMPLIFIED: f64 = 50.0;
/// Two neighbours may agree by chance; not three times.
const LEAST_COLUMNS: usize = 4;

/// A step that was tried.
pub struct Trial {
    /// State at the end minus state at the start. Small, and so of small round-off.
    pub change: State,
    /// Columns that it took.
    pub columns: usize,
    /// Rough states inside the step: share of the step, change.
    pub samples: Vec<(f64, State)>,
}

impl Trial {
    /// Length of the next step over the length of this one.
    pub fn growth(&self) -> f64 {
        match self.columns {
            ..=5 => 2.0,
            6 => 1.4,
            7 => 1.0,
            _ => 0.7,
        }
    }
}

/// A step of `length` from `start` at `time`; `None` where it does not converge to within
/// `tolerance` of each component.
pub fn step(
    rate: &impl Fn(f64, &State) -> State,
    time: f64,
    start: &State,
    length: f64,
    tolerance: &State,
) -> Option<Trial> {
    let first = rate(time, start);
    let tolerance = tolerance + AMPLIFIED * length * (rate(time, &nudged(start)) - first).abs();
    let mut row: Vec<State> = Vec::with_capacity(COLUMNS);
    for column in 0..COLUMNS {
        let substeps = 2 * (column + 1);
        let samples = midpoint(rate, time, start, &first, length, substeps);
        // Aitken and Neville in the square of the substep.
        let mut better = vec![samples[substeps - 1].1];
        for back in 1..=column {
            let ratio = ((column + 1) as f64 / (column + 1 - back) as f64).powi(2);
            let last: State = better[back - 1];
            better.push(last + (last - row[back - 1]) / (ratio - 1.0));
        }
        let columns = column + 1;
        let change = better[column];
        let settled = column > 0
            && (better[column] - better[column - 1]).iter().zip(tolerance.iter()).all(|(d, t)| d.abs() <= *t);
        if columns >= LEAST_COLUMNS && settled {
            return Some(Trial { change, columns, samples });
        }
        row = better;
    }
    None
}

/// The state within its own round-off: what this does to the rates, no step can do without.
fn nudged(state: &State) -> State {
    // Signs alternate between bodies, so that eccentricities feel it.
    State::from_fn(|row, _| state[row] * (1.0 + if row % 2 == 0 { f64::EPSILON } else { -f64::EPSILON }))
}

/// The modified midpoint rule: changes after 1/n, 2/n, …, 1 of the step.
fn midpoint(
    rate: &impl Fn(f64, &State) -> State,
    time: f64,
    start: &State,
    first: &State,
    length: f64,
    substeps: usize,
) -> Vec<(f64, State)> {
    let substep = length / substeps as f64;
    let mut samples = Vec::with_capacity(substeps);
    let (mut before, mut here) = (State::zeros(), substep * first);
    for k in 1..substeps {
        samples.push((k as f64 / substeps as f64, here));
        let after = before + 2.0 * substep * rate(time + k as f64 * substep, &(start + here));
        (before, here) = (here, after);
    }
    samples.push((1.0, here));
    samples
}
