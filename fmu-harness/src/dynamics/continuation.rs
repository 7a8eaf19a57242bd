//! Branches of periodic motions, followed in a parameter by pseudo-arclength through folds (H. B. Keller, in
//! Applications of Bifurcation Theory, Academic Press 1977, 359; Yu. A. Kuznetsov, Elements of Applied Bifurcation
//! Theory, Springer 2004, 10), and the points at which they change.

use super::orbit::{Orbit, Return, ReturnMap, size};
use anyhow::{Context, Result, anyhow, bail};
use nalgebra::{Complex, DMatrix, DVector};
use std::fmt;

/// [noticeable differences] A change of all unknowns that counts as much as the whole range of the parameter.
const UNIT: f64 = 1000.0;
/// Lengths of steps: the first, the shortest, the longest, and the longest share of the parameter's range. The whole range
/// has length 1.
const FIRST: f64 = 0.01;
const SHORTEST: f64 = 1e-5;
const LONGEST: f64 = 0.2;
const WIDEST: f64 = 0.05;
/// Most points of a branch.
const MOST: usize = 1000;
/// Most iterations of a corrector, and how many are few.
const ITERATIONS: usize = 8;
const FEW: usize = 3;
/// Largest miss and error of length.
const CLOSED: f64 = 1e-7;
/// Share of the range within which the doubled branch begins.
const NEAR: f64 = 0.02;
/// Most steps of false position towards a bifurcation, most halvings towards grazing, and the test that is 0.
const REFINEMENTS: usize = 12;
const HALVINGS: usize = 40;
const LOCATED: f64 = 1e-9;
/// Lengths by which a branch is left for the doubled one; the first at which it is reached counts.
const ASIDE: [f64; 5] = [3e-3, 1e-3, 1e-2, 3e-2, 1e-4];
/// A multiplier whose imaginary part is less than this share of it is real.
const REAL: f64 = 1e-6;
/// A step past a doubling is halved down to this length.
const CLOSE: f64 = 2e-3;
/// [noticeable differences] Halves of a period that differ less are the same.
const ALIKE: f64 = 1e-3;

/// How a branch of periodic motions changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bifurcation {
    /// The branch turns back: a multiplier passes 1.
    Fold,
    /// A multiplier passes −1: a motion of twice the period begins.
    PeriodDoubling,
    /// A pair of complex multipliers leaves or enters the unit circle.
    NeimarkSacker,
    /// A touch begins or ceases to exist.
    Grazing,
}

impl Bifurcation {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::PeriodDoubling => "period doubling",
            Self::NeimarkSacker => "Neimark-Sacker",
            Self::Grazing => "grazing",
        }
    }
}

impl fmt::Display for Bifurcation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A bifurcation on a branch.
#[derive(Clone, Debug)]
pub struct Found {
    /// What happens.
    pub kind: Bifurcation,
    /// The motion there, or the nearest one before it.
    pub orbit: Orbit,
}

/// A branch of periodic motions.
#[derive(Clone, Debug)]
pub struct Branch {
    /// Turns of one period.
    pub turns: usize,
    /// Its motions, in order.
    pub orbits: Vec<Orbit>,
    /// Its bifurcations, in order.
    pub found: Vec<Found>,
    /// Why it ends.
    pub end: String,
    /// Value of the parameter at which it meets a branch of half its period, if that is its end.
    pub meets: Option<f64>,
}

/// A parameter's range in which branches are followed.
pub struct Continuation<'a> {
    /// The map.
    pub map: &'a dyn ReturnMap,
    /// Ends of the range.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// How often a branch is left for one of twice the period.
    pub doublings: usize,
}

/// A point of a branch with its direction.
struct Point {
    at: Return,
    /// Change of the unknowns and of the parameter along the branch; its length is 1.
    along: DVector<f64>,
}

impl Continuation<'_> {
    /// The branch through `start`, a periodic motion, in the direction of `to`, and those of twice its period. Where the branch
    /// ends in a motion of half its period, the branch of that motion is followed in both directions.
    ///
    /// # Errors
    /// If the first step fails.
    pub fn follow(&self, start: Return, mut tick: impl FnMut(f64)) -> Result<Vec<Branch>> {
        let along = self.along(&start, None)?;
        let mut branches = vec![self.branch(Point { at: start, along }, &[], &mut tick)];
        let mut longer = 0;
        while branches[longer].meets.is_some() {
            let Some([there, back]) = self.halved(&mut branches[longer], &mut tick) else { break };
            longer = branches.len();
            branches.extend([there, back]);
        }
        let mut first = 0;
        for _ in 0..self.doublings {
            let doublings = doublings(&branches[first..]);
            first = branches.len();
            for orbit in &doublings {
                // The branch from one of two neighbouring doublings often ends at the other.
                let ends_here = |branch: &Branch| branch.meets == Some(orbit.value);
                if branches.iter().any(ends_here) {
                    continue;
                }
                branches.push(match self.doubled(orbit) {
                    Ok(point) => self.branch(point, &doublings, &mut tick),
                    Err(error) => Branch {
                        turns: 2 * orbit.turns,
                        orbits: vec![],
                        found: vec![],
                        end: format!("the branch from {} = {:.6e} is not reached: {error:#}", self.name(), orbit.value),
                        meets: None,
                    },
                });
            }
        }
        Ok(branches)
    }

    fn name(&self) -> &str {
        self.map.name()
    }

    /// Change of the parameter whose length is 1.
    fn range(&self) -> f64 {
        (self.to - self.from).abs()
    }

    /// The branch of half the period that another one meets at its end, towards where that one does not exist and back; `None`
    /// if it is not found. Places the end of the longer one at the doubling.
    fn halved(&self, longer: &mut Branch, tick: &mut impl FnMut(f64)) -> Option<[Branch; 2]> {
        let last = longer.orbits.last()?;
        let states: Vec<usize> = (0..last.phase.states.len()).collect();
        let middle = 0.5 * last.apart.rows(0, states.len());
        let phase = self.map.moved(&last.phase, &states, &middle);
        let at = self.map.solve(last.value, &phase, last.turns / 2).ok()?;
        let towards = longer.orbits.iter().rev().nth(1).map_or(self.to - self.from, |before| last.value - before.value);
        let along = self.along(&at, None).ok()?;
        let along = if (self.to - self.from) * towards < 0.0 { -along } else { along };
        let back = Point { at: at.clone(), along: -&along };
        let [there, back] = [Point { at, along }, back].map(|start| self.branch(start, &[], tick));
        let doublings = doublings(std::slice::from_ref(&there));
        let value = self.met(last, &doublings);
        (longer.end, longer.meets) = (self.meeting(longer.turns, value), Some(value));
        Some([there, back])
    }

    /// Why a branch of so many turns ends at this value.
    fn meeting(&self, turns: usize, value: f64) -> String {
        let half = if turns == 2 { "1 turn".into() } else { format!("{} turns", turns / 2) };
        format!("it meets a branch of {half} at {} = {value:.6e}", self.name())
    }

    /// Follows a branch from one of its points until it leaves the range or ends in motions of half its period, if it has left
    /// such a branch, at one of `doublings`.
    fn branch(&self, start: Point, doublings: &[Orbit], tick: &mut impl FnMut(f64)) -> Branch {
        let least = if doublings.is_empty() { ALIKE } else { start.at.orbit.apart.norm() };
        // Past its doubling a branch goes on in motions of half its period, or through its own ones half a period later.
        let halves = start.at.orbit.turns.is_multiple_of(2);
        let passes =
            |one: &Orbit, other: &Orbit| halves && (other.apart.norm() < least || one.apart.dot(&other.apart) < 0.0);
        let mut branch = Branch {
            turns: start.at.orbit.turns,
            orbits: vec![start.at.orbit.clone()],
            found: vec![],
            end: String::new(),
            meets: None,
        };
        let (mut point, mut length) = (start, FIRST);
        let (low, high) = (self.from.min(self.to), self.from.max(self.to));
        while branch.orbits.len() < MOST {
            match self.step(&point, length) {
                Ok((next, _)) if passes(&point.at.orbit, &next.at.orbit) => {
                    if length < CLOSE {
                        let value = self.met(&point.at.orbit, doublings);
                        (branch.end, branch.meets) = (self.meeting(branch.turns, value), Some(value));
                        return branch;
                    }
                    length *= 0.5;
                }
                Ok((next, iterations)) => {
                    let found = self.between(&point, &next, length);
                    branch.found.extend(found);
                    branch.orbits.push(next.at.orbit.clone());
                    tick(next.at.orbit.value);
                    point = next;
                    if !(low..=high).contains(&point.at.orbit.value) {
                        branch.end = format!("{} leaves the range", self.name());
                        return branch;
                    }
                    if iterations <= FEW {
                        length = (1.5 * length).min(LONGEST);
                    }
                    if let Some(share) = point.along.as_slice().last() {
                        length = length.min(WIDEST / share.abs());
                    }
                }
                Err(error) => {
                    length *= 0.5;
                    if length < SHORTEST {
                        branch.end = format!("{error:#}");
                        return branch;
                    }
                }
            }
        }
        branch.end = format!("it has {MOST} points");
        branch
    }

    /// The parameter at the doubling near which a branch has its last motion; that of this motion if none is near.
    fn met(&self, last: &Orbit, doublings: &[Orbit]) -> f64 {
        let near = doublings.iter().filter(|orbit| (orbit.value - last.value).abs() < NEAR * self.range());
        let distance = |orbit: &&Orbit| {
            let pairs = orbit.phase.states.iter().zip(&last.phase.states).zip(self.map.scales());
            pairs.map(|((a, b), scale)| ((a - b) / scale).powi(2)).sum::<f64>()
        };
        near.min_by(|a, b| distance(a).total_cmp(&distance(b))).map_or(last.value, |orbit| orbit.value)
    }

    /// The direction of a branch at a point: the kernel of (DP − 1 | ∂P/∂p), oriented like the direction `before` or
    /// towards the end of the range.
    fn along(&self, at: &Return, before: Option<&DVector<f64>>) -> Result<DVector<f64>> {
        let n = at.unknowns.len();
        let svd = self.bordered(at).svd(false, true);
        let rows = svd.v_t.context("a decomposition")?;
        let smallest = svd.singular_values.imin();
        let kernel = rows.row(smallest).transpose();
        let kernel = &kernel / self.length(&kernel);
        let sign = match before {
            Some(before) if before.len() == kernel.len() => self.product(before, &kernel),
            _ => kernel[n] * (self.to - self.from),
        };
        Ok(if sign < 0.0 { -kernel } else { kernel })
    }

    /// (DP − 1 | ∂P/∂p) over a row of zeros.
    fn bordered(&self, at: &Return) -> DMatrix<f64> {
        let n = at.unknowns.len();
        let mut matrix = DMatrix::zeros(n + 1, n + 1);
        matrix.view_mut((0, 0), (n, n)).copy_from(&(&at.by_unknowns - DMatrix::identity(n, n)));
        matrix.view_mut((0, n), (n, 1)).copy_from(&(&at.by_parameter * self.range()));
        matrix
    }

    /// Product of two directions: the weighted mean over the unknowns, and the parameter.
    fn product(&self, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
        let n = a.len() - 1;
        a.rows(0, n).dot(&b.rows(0, n)) * weight(n) + a[n] * b[n]
    }

    fn length(&self, a: &DVector<f64>) -> f64 {
        self.product(a, a).sqrt()
    }

    /// The point of the branch at this length from `point`, and the number of iterations.
    fn step(&self, point: &Point, length: f64) -> Result<(Point, usize)> {
        let n = point.at.unknowns.len();
        let start = &point.at.orbit;
        let mut change = &point.along * length;
        for iteration in 1..=ITERATIONS {
            let value = start.value + change[n] * self.range();
            let phase = self.map.moved(&start.phase, &point.at.unknowns, &change.rows(0, n).into_owned());
            let at = self.map.apply(value, &phase, start.turns)?;
            if at.unknowns != point.at.unknowns {
                bail!("other contacts last over the period");
            }
            let error = self.product(&point.along, &change) - length;
            if size(&at.miss) <= CLOSED && error.abs() <= CLOSED {
                let along = self.along(&at, Some(&point.along))?;
                return Ok((Point { at, along }, iteration));
            }
            let mut matrix = self.bordered(&at);
            for column in 0..n {
                matrix[(n, column)] = point.along[column] * weight(n);
            }
            matrix[(n, n)] = point.along[n];
            let mut right = DVector::zeros(n + 1);
            right.rows_mut(0, n).copy_from(&-&at.miss);
            right[n] = -error;
            change += matrix.lu().solve(&right).context("the branch has no direction")?;
        }
        bail!("the corrector does not converge at {} = {:.6e}", self.name(), start.value)
    }

    /// The bifurcations between two points of a branch.
    fn between(&self, before: &Point, after: &Point, length: f64) -> Vec<Found> {
        let [one, other] = [&before.at.orbit, &after.at.orbit];
        if one.events != other.events {
            return vec![Found { kind: Bifurcation::Grazing, orbit: self.grazing(before, length) }];
        }
        let mut found = vec![];
        let n = before.along.len() - 1;
        if after.along.len() == n + 1 && before.along[n] * after.along[n] < 0.0 {
            found.push((Bifurcation::Fold, before.along[n], after.along[n]));
        }
        for (kind, test) in
            [(Bifurcation::PeriodDoubling, flip as fn(&Orbit) -> f64), (Bifurcation::NeimarkSacker, pair)]
        {
            let (a, b) = (test(one), test(other));
            if a * b < 0.0 {
                found.push((kind, a, b));
            }
        }
        found
            .into_iter()
            .map(|(kind, a, b)| Found { kind, orbit: self.located(kind, before, [a, b], length) })
            .filter(|found| found.kind != Bifurcation::NeimarkSacker || has_pair(&found.orbit))
            .collect()
    }

    /// The last motion within `length` of a point that has the same touches, found by halving.
    fn grazing(&self, before: &Point, length: f64) -> Orbit {
        let (mut low, mut high) = (0.0, length);
        let mut last = before.at.orbit.clone();
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            // At grazing itself there is no derivative.
            match self.step(before, middle) {
                Ok((point, _)) if point.at.orbit.events == last.events => (low, last) = (middle, point.at.orbit),
                _ => high = middle,
            }
            if high - low < LOCATED * length {
                break;
            }
        }
        last
    }

    /// The motion at a bifurcation within `length` of a point, by false position with the value at the end that stays halved
    /// (M. Dowell, P. Jarratt, BIT 11 (1971) 168); the nearest motion if it is not reached. `ends` are the values of the test
    /// at both ends.
    fn located(&self, kind: Bifurcation, before: &Point, ends: [f64; 2], length: f64) -> Orbit {
        let n = before.along.len() - 1;
        let (mut low, mut high) = ((0.0, ends[0]), (length, ends[1]));
        let mut best = (f64::INFINITY, before.at.orbit.clone());
        let mut rose = None;
        for _ in 0..REFINEMENTS {
            let share = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
            let Ok((point, _)) = self.step(before, share) else { break };
            let test = match kind {
                Bifurcation::Fold => point.along[n],
                Bifurcation::PeriodDoubling => flip(&point.at.orbit),
                _ => pair(&point.at.orbit),
            };
            if test.abs() < best.0 {
                best = (test.abs(), point.at.orbit);
            }
            if test.abs() < LOCATED {
                break;
            }
            let rises = test * low.1 > 0.0;
            let halved = if rose == Some(rises) { 0.5 } else { 1.0 };
            if rises {
                (low, high.1) = ((share, test), high.1 * halved);
            } else {
                (high, low.1) = ((share, test), low.1 * halved);
            }
            rose = Some(rises);
        }
        best.1
    }

    /// A point of the branch of twice the period that begins at a motion with a multiplier of −1.
    fn doubled(&self, orbit: &Orbit) -> Result<Point> {
        let at = self.map.apply(orbit.value, &orbit.phase, orbit.turns)?;
        let n = at.unknowns.len();
        let svd = (&at.by_unknowns + DMatrix::identity(n, n)).svd(false, true);
        let rows = svd.v_t.context("a decomposition")?;
        let aside = rows.row(svd.singular_values.imin()).transpose();
        let mut along = DVector::zeros(n + 1);
        along.rows_mut(0, n).copy_from(&aside);
        let along = &along / self.length(&along);
        let twice = self.map.apply(orbit.value, &orbit.phase, 2 * orbit.turns)?;
        let start = Point { at: twice, along };
        let mut failure = None;
        for length in ASIDE {
            match self.step(&start, length) {
                Ok((point, _)) if (point.at.orbit.value - orbit.value).abs() < NEAR * self.range() => return Ok(point),
                Ok(_) => failure = Some(anyhow!("the corrector finds another branch")),
                Err(error) => failure = Some(error),
            }
        }
        Err(failure.context("a length")?)
    }
}

/// The motions of these branches at which the period doubles.
fn doublings(branches: &[Branch]) -> Vec<Orbit> {
    let found = branches.iter().flat_map(|branch| &branch.found);
    found.filter(|found| found.kind == Bifurcation::PeriodDoubling).map(|found| found.orbit.clone()).collect()
}

/// Weight of the square of each of `n` unknowns in a length.
fn weight(n: usize) -> f64 {
    1.0 / (n.max(1) as f64 * UNIT * UNIT)
}

/// Π(1 + μ), which changes its sign where one real multiplier passes −1.
fn flip(orbit: &Orbit) -> f64 {
    orbit.multipliers.iter().map(|multiplier| multiplier + 1.0).product::<Complex<f64>>().re
}

/// Π(μ·ν − 1) over all pairs of multipliers, which changes its sign where a pair on the unit circle passes it, and where
/// the product of two real ones passes 1 (Kuznetsov, 10.2).
fn pair(orbit: &Orbit) -> f64 {
    pairs(orbit).map(|[one, other]| one * other - 1.0).product::<Complex<f64>>().re
}

/// Whether the pair whose product is nearest to 1 is complex.
fn has_pair(orbit: &Orbit) -> bool {
    let miss = |[one, other]: &[Complex<f64>; 2]| (one * other - 1.0).norm();
    pairs(orbit).min_by(|a, b| miss(a).total_cmp(&miss(b))).is_some_and(|[one, _]| !is_real(&one))
}

/// All pairs of multipliers.
fn pairs(orbit: &Orbit) -> impl Iterator<Item = [Complex<f64>; 2]> {
    let all = &orbit.multipliers;
    (0..all.len()).flat_map(move |i| all[..i].iter().map(move |other| [all[i], *other]))
}

fn is_real(multiplier: &Complex<f64>) -> bool {
    multiplier.im.abs() <= REAL * multiplier.norm()
}
