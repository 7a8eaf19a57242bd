//! A solution to measure others against, and how far to trust it: two methods of different orders, both as tight as they
//! go. What they differ by is the reference's own error, and where they part the motion has decorrelated.

use super::Subject;
use super::ladder::Rung;
use super::ruler::Ruler;
use crate::run::{Ending, Look, march};
use crate::trajectory::Trajectory;
use anyhow::{Result, bail, ensure};
use slidercrank::scene::Method;
use std::time::{Duration, Instant};

/// The reference, and what it is checked by.
const METHODS: [Method; 2] = [Method::Dop853, Method::Verner7];
/// Below this, rounding takes the place of what a shorter step gains.
const TOLERANCE: f64 = 1e-12;
/// The two agree to this within the window: a twentieth of the finest error that the tables ask for.
pub const AGREEMENT: f64 = 5e-8;
/// [s] Between grid points, for windows up to [`MOST_POINTS`] of them.
const GRID: f64 = 1e-5;
const MOST_POINTS: f64 = 40_000.0;
/// Turns of the crank that are looked at, after so many looks at half as long a time.
const TURNS: f64 = 2.0;
const HALVINGS: i32 = 5;
/// Grid points that make a window.
const LEAST_POINTS: usize = 20;

/// What a scene's runs are measured against.
pub struct Reference {
    /// Its outputs on the grid, over the window and beyond.
    pub trajectory: Trajectory,
    /// [s] Up to here the motion is known.
    pub window: f64,
    /// [s] Between grid points.
    pub grid: f64,
    /// Of the reference in the window, by the same measure as of any other run.
    pub error: f64,
}

impl Reference {
    /// Runs the scene twice and looks how long the two agree. Takes about `budget` at most.
    pub fn of(subject: &Subject, ruler: &Ruler, budget: Duration) -> Result<Self> {
        let usual = subject.turn().map_or(subject.stop(), |turn| (TURNS * turn).min(subject.stop()));
        let longest = subject.lengths.window.unwrap_or(usual);
        let grid = GRID * (longest / (GRID * MOST_POINTS)).ceil();
        let clock = Instant::now();
        for halving in (0..=HALVINGS).rev() {
            let end = longest * 0.5f64.powi(halving);
            let mut runs = Vec::new();
            for method in METHODS {
                let experiment = subject.experiment(method, Rung::Tolerance(TOLERANCE), end, grid);
                let run = march(subject.fmu, &experiment, Look::Everywhere, budget)?;
                if let Ending::Failed(why) = run.ending {
                    bail!("no reference: {} at {TOLERANCE:e}: {why}", method.name());
                }
                runs.push(run.trajectory);
            }
            let errors = ruler.errors(&runs[1], &runs[0])?;
            let agreed = errors.iter().take_while(|(_, error)| *error <= AGREEMENT).count();
            let known = errors[agreed.max(1) - 1].0;
            let parted = known < end - grid;
            // The next look takes twice as long as this one.
            if parted || halving == 0 || 3 * clock.elapsed() > budget {
                ensure!(agreed > LEAST_POINTS, "no reference: two that should agree part at {known} s");
                let window = round_down(known, grid);
                let within = errors.iter().filter(|(time, _)| *time <= window + 0.5 * grid);
                let error = within.map(|(_, error)| *error).fold(0.0, f64::max);
                return Ok(Self { trajectory: runs.swap_remove(0), window, grid, error });
            }
        }
        bail!("no reference")
    }
}

/// A time of two digits, so that it can be told, on the grid.
fn round_down(time: f64, grid: f64) -> f64 {
    let unit = 10f64.powf(time.log10().floor() - 1.0).max(grid);
    // A millionth of a unit is what remains of a quotient that was meant to be whole.
    let rounded = (time / unit + 1e-6).floor() * unit;
    (rounded / grid).round() / (1.0 / grid).round()
}

#[cfg(test)]
mod tests {
    use super::round_down;

    #[test]
    fn windows_have_two_digits() {
        for (time, wanted) in [(0.02437, 0.024), (0.00412, 0.0041), (0.0600, 0.06), (0.000234, 0.00023)] {
            assert_eq!(round_down(time, 1e-5), wanted);
        }
    }
}
