//! Reference solutions. Two methods of different orders run at the tightest useful tolerance. Their difference is the
//! reference's own error; when they diverge, the motion has decorrelated.

use super::Subject;
use super::ladder::Rung;
use super::ruler::Ruler;
use crate::run::{Ending, Look, march};
use crate::trajectory::Trajectory;
use anyhow::{Result, bail, ensure};
use slidercrank::scene::Method;
use std::time::{Duration, Instant};

/// The methods of the reference and of its check.
const METHODS: [Method; 2] = [Method::Dop853, Method::Verner7];
/// Tightest useful tolerance. With a smaller one rounding errors dominate.
const TOLERANCE: f64 = 1e-12;
/// Largest difference of the two solutions within the window: a twentieth of the smallest error in the tables.
pub const AGREEMENT: f64 = 5e-8;
/// [s] Distance of grid points, for windows of up to [`MOST_POINTS`] points.
const GRID: f64 = 1e-5;
const MOST_POINTS: f64 = 40_000.0;
/// Number of crank turns of the longest window, and the number of shorter windows, each half as long as the next.
const TURNS: f64 = 2.0;
const HALVINGS: i32 = 5;
/// Minimum number of grid points of a window.
const LEAST_POINTS: usize = 20;

/// The reference solution of a scene.
pub struct Reference {
    /// Its outputs on the grid, over the window and beyond.
    pub trajectory: Trajectory,
    /// [s] Time up to which the motion is known.
    pub window: f64,
    /// [s] Distance of grid points.
    pub grid: f64,
    /// Error of the reference in the window, measured like the error of any run.
    pub error: f64,
}

impl Reference {
    /// Runs the scene twice and determines how long the solutions agree. Takes at most about `budget`.
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
                    bail!("there is no reference: {} at {TOLERANCE:e}: {why}", method.name());
                }
                runs.push(run.trajectory);
            }
            let errors = ruler.errors(&runs[1], &runs[0])?;
            let agreed = errors.iter().take_while(|(_, error)| *error <= AGREEMENT).count();
            let known = errors[agreed.max(1) - 1].0;
            let parted = known < end - grid;
            // The next window takes twice as long.
            if parted || halving == 0 || 3 * clock.elapsed() > budget {
                ensure!(agreed > LEAST_POINTS, "there is no reference: two solutions differ already at {known} s");
                let window = round_down(known, grid);
                let within = errors.iter().filter(|(time, _)| *time <= window + 0.5 * grid);
                let error = within.map(|(_, error)| *error).fold(0.0, f64::max);
                return Ok(Self { trajectory: runs.swap_remove(0), window, grid, error });
            }
        }
        bail!("no reference")
    }
}

/// A grid time rounded to two digits, for printing.
fn round_down(time: f64, grid: f64) -> f64 {
    let unit = 10f64.powf(time.log10().floor() - 1.0).max(grid);
    // A remainder of a millionth is the rounding error of an integer quotient.
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
