//! Periodic motions of a map that depends on one parameter: found by Newton's method with the map's exact Jacobian, with
//! their Floquet multipliers (T. S. Parker, L. O. Chua, Practical Numerical Algorithms for Chaotic Systems, Springer
//! 1989, 5).

use super::section::Visit;
use anyhow::{Context, Result, bail};
use nalgebra::{Complex, DMatrix, DVector};
use slidercrank::simulation::Phase;

/// Most iterations of Newton's method, and most halvings of one of its steps.
const MAX_ITERATIONS: usize = 25;
const MAX_HALVINGS: usize = 8;
/// Largest distance from the section's point after a period, in noticeable differences.
const CLOSED: f64 = 1e-7;
/// [noticeable differences] Newton's method from a point of a motion that is found moves it by less to the same motion.
const SAME: f64 = 1e-4;

/// A periodic motion.
#[derive(Clone, Debug)]
pub struct Orbit {
    /// Value of the parameter.
    pub value: f64,
    /// Where it passes the section.
    pub phase: Phase,
    /// Returns to the section in one period, which are turns of the crank.
    pub turns: usize,
    /// Floquet multipliers, the largest first.
    pub multipliers: Vec<Complex<f64>>,
    /// Its state after half of its returns less that at its start, in noticeable differences: 0 where the period is half as
    /// long.
    pub apart: DVector<f64>,
    /// Its passages through the section, of a mechanism.
    pub visits: Vec<Visit>,
    /// Touches and partings in one period.
    pub events: i64,
}

impl Orbit {
    /// Whether neighbouring motions come nearer.
    pub fn is_stable(&self) -> bool {
        self.multipliers.iter().all(|multiplier| multiplier.norm() < 1.0)
    }

    /// The multiplier of largest modulus; 0 without any.
    pub fn largest(&self) -> Complex<f64> {
        self.multipliers.first().copied().unwrap_or_default()
    }
}

/// A map at one point.
#[derive(Clone)]
pub struct Return {
    /// Image minus point, in noticeable differences, of the unknowns.
    pub miss: DVector<f64>,
    /// Derivatives of the image by the unknowns.
    pub by_unknowns: DMatrix<f64>,
    /// Derivatives of the image by the parameter.
    pub by_parameter: DVector<f64>,
    /// Places of the unknowns among the numbers of phase space: states, then approach speeds of all contacts.
    pub unknowns: Vec<usize>,
    /// The orbit, if the point returned.
    pub orbit: Orbit,
}

/// A map of a section onto itself that depends on one parameter.
pub trait ReturnMap {
    /// The parameter's name.
    fn name(&self) -> &str;

    /// Noticeable differences of all numbers of phase space: states, then approach speeds.
    fn scales(&self) -> &[f64];

    /// The map of `turns` returns at `phase`.
    ///
    /// # Errors
    /// If the motion does not return, or has no derivatives.
    fn apply(&self, value: f64, phase: &Phase, turns: usize) -> Result<Return>;

    /// The periodic motion near `phase` at a value of the parameter.
    ///
    /// # Errors
    /// If Newton's method does not find it.
    fn solve(&self, value: f64, phase: &Phase, turns: usize) -> Result<Return> {
        let mut at = self.apply(value, phase, turns)?;
        for _ in 0..MAX_ITERATIONS {
            if size(&at.miss) <= CLOSED {
                return Ok(at);
            }
            let n = at.unknowns.len();
            let matrix = DMatrix::identity(n, n) - &at.by_unknowns;
            let change = matrix.lu().solve(&at.miss).context("the Poincaré map has a multiplier of 1")?;
            at = shorter(self, &at, &change)?;
        }
        bail!("Newton's method does not converge: a period misses by {:.1e} noticeable differences", size(&at.miss))
    }

    /// The same motion with its shortest period: a motion that was still settling may have seemed to repeat later.
    fn shortest(&self, at: Return) -> Return {
        let Orbit { value, phase, turns, .. } = &at.orbit;
        let far = |other: &Phase| {
            let pairs = other.states.iter().zip(&phase.states).zip(self.scales());
            pairs.map(|((one, other), scale)| (one - other).abs() / scale).fold(0.0, f64::max)
        };
        let divisors = (1..*turns).filter(|part| turns.is_multiple_of(*part));
        let same = |part| self.solve(*value, phase, part).ok().filter(|shorter| far(&shorter.orbit.phase) < SAME);
        let shorter = divisors.filter_map(same).next();
        shorter.unwrap_or(at)
    }

    /// A point whose unknowns differ by `change` [noticeable differences].
    fn moved(&self, phase: &Phase, unknowns: &[usize], change: &DVector<f64>) -> Phase {
        let mut moved = phase.clone();
        let states = phase.states.len();
        for (&place, change) in unknowns.iter().zip(change.iter()) {
            let change = change * self.scales()[place];
            match place.checked_sub(states) {
                None => moved.states[place] += change,
                Some(contact) => {
                    let speed = moved.approach[contact].get_or_insert(0.0);
                    *speed = (*speed + change).max(f64::MIN_POSITIVE);
                }
            }
        }
        moved
    }
}

/// The return after the longest of ever shorter shares of a `change` of the unknowns after which the miss is smaller.
fn shorter<M: ReturnMap + ?Sized>(map: &M, at: &Return, change: &DVector<f64>) -> Result<Return> {
    let Orbit { value, phase, turns, .. } = &at.orbit;
    let (mut share, mut failure) = (1.0, None);
    for _ in 0..=MAX_HALVINGS {
        match map.apply(*value, &map.moved(phase, &at.unknowns, &(change * share)), *turns) {
            Ok(next) if size(&next.miss) < size(&at.miss) && next.unknowns == at.unknowns => return Ok(next),
            Ok(_) => {}
            Err(error) => failure = Some(error),
        }
        share *= 0.5;
    }
    Err(failure.unwrap_or_else(|| anyhow::anyhow!("Newton's method does not converge: no step comes nearer")))
}

/// Eigenvalues of a map's Jacobian, the largest first.
pub fn multipliers(by_unknowns: &DMatrix<f64>) -> Vec<Complex<f64>> {
    let mut multipliers: Vec<Complex<f64>> = by_unknowns.complex_eigenvalues().iter().copied().collect();
    multipliers.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
    multipliers
}

/// Largest of some numbers.
pub fn size(numbers: &DVector<f64>) -> f64 {
    numbers.iter().fold(0.0, |largest: f64, number| largest.max(number.abs()))
}
