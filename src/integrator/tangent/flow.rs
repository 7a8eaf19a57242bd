//! The variational equation in a part of an accepted step.
//!
//! Collocation at Radau's nodes has order 7 and is L-stable: one method serves smooth and stiff motions, and what decays
//! within a part is gone at its end, whether the part resolves it or not. The stages are found by fixed-point iteration, and
//! by elimination where that does not contract or where there are many directions. A part is halved until the coefficients
//! of its Legendre polynomials, extrapolated geometrically, promise the tolerance.
//!
//! Rates of positions are velocities, so that only the other rows of the Jacobian, those of forced states, are
//! multiplied, and only their stages are unknowns: with v at the start and the lengths L_i of the part in time at the
//! nodes, the slopes of positions are L_i·(v + Σ_j a_ij·K_j).
//!
//! Contact forces begin and end like a power of the penetration with an odd half in the exponent, so that the Jacobian
//! has a square root there. Where a step begins or ends with an event, time runs as the square of the variable of
//! integration: √t is then a polynomial.

use super::legendre::{Legendre, NODES, SHARES, WEIGHTS};
use super::variational::{Companion, Variational};
use crate::integrator::dense_output::{Correction, Step};
use crate::integrator::linear::solve_rows;
use crate::integrator::{Discontinuities, Jacobian, MAX_STATES, StateLayout, root};
use crate::math::{self, add_multiple};
use nalgebra::DMatrix;
use std::array::from_fn;

/// Most halvings of a part.
const MAX_HALVINGS: u32 = 12;
/// Halving a part gains at least this, …
const LEAST_GAIN: f64 = 0.25;
/// … but for so many times.
const MAX_STALLS: u32 = 4;
/// Most iterations before the stages are found by elimination.
const MAX_ITERATIONS: usize = 60;
/// Most directions whose stages are found by iteration: it takes its time for each, a factorisation once for all.
const MAX_ITERATED: usize = 2;
/// Largest contraction of an iteration that goes on.
const SLOWEST: f64 = 0.8;
/// Error of an iteration, as a share of the tolerance.
const CONVERGED: f64 = 1e-2;
/// Share of a step within which a corner is found.
const RESOLUTION: f64 = 1e-12;
/// Error of an iteration that stands for rounding.
const ROUNDING: f64 = 1e-14;

/// A part of a step, in the variable of integration.
#[derive(Clone, Copy)]
struct Part {
    start: f64,
    end: f64,
    /// Number of halvings that made it.
    halvings: u32,
    /// Error of the part before the last of them.
    error: f64,
    /// Number of them that gained nothing.
    stalls: u32,
}

/// Where the motion has a square root of time: at neither end of a step, or there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roots {
    /// A contact has closed or opened at the start.
    pub start: bool,
    /// A contact closes or opens at the end.
    pub end: bool,
}

impl Roots {
    /// Share of the step and its derivative at the variable of integration `u`, both from 0 to 1.
    fn share(self, u: f64) -> (f64, f64) {
        match self {
            Self { start: false, end: false } => (u, 1.0),
            Self { start: true, end: false } => (u * u, 2.0 * u),
            Self { start: false, end: true } => (u * (2.0 - u), 2.0 * (1.0 - u)),
            Self { start: true, end: true } => (u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u)),
        }
    }

    /// The variable of integration at this share of the step.
    fn variable(self, share: f64) -> f64 {
        match self {
            Self { start: false, end: false } => share,
            Self { start: true, end: false } => share.sqrt(),
            Self { start: false, end: true } => share / (1.0 + (1.0 - share).sqrt()),
            Self { start: true, end: true } => {
                // Newton on a monotonic cubic, from the side on which it is convex.
                let mut u = if share < 0.5 { (share / 2.0).sqrt() } else { 1.0 - ((1.0 - share) / 2.0).sqrt() };
                for _ in 0..60 {
                    let (value, slope) = self.share(u);
                    if slope <= 0.0 || value == share {
                        break;
                    }
                    u = (u - (value - share) / slope).clamp(0.0, 1.0);
                }
                u
            }
        }
    }
}

/// Tables and memory for integrating variational equations. Matrices stand by columns; those of directions have as many
/// rows as there are states.
#[derive(Clone, Debug)]
pub struct Flow {
    legendre: Legendre,
    jacobian: Jacobian,
    correction: Correction,
    /// Length of a part in time at the nodes, per variable of integration.
    lengths: [f64; NODES],
    /// J and F at the nodes, times these lengths: the rows of the forced states.
    turning: [Vec<f64>; NODES],
    pushing: [Vec<f64>; NODES],
    /// Directions at the start of a part, by rows, positions moved on to a node.
    moved: Vec<f64>,
    /// Equations for the stages of forced states, by rows, one node after the other: see [`solve_rows`].
    equations: Vec<f64>,
    /// Slopes at the nodes.
    stages: [Vec<f64>; NODES],
    /// Directions at the start of a part.
    before: Vec<f64>,
    /// Directions at a node, and their slopes.
    inner: Vec<f64>,
    found: Vec<f64>,
    /// Reciprocals of the scales of the states; 0 without a scale.
    weights: Vec<f64>,
    /// The columns that are not 0 and do not stay so; the matrices have these alone.
    moving: Vec<usize>,
    /// The size of each of them below which it counts as none.
    least: Vec<f64>,
}

/// A step to integrate along, and the direction of each column in parameters.
#[derive(Clone, Copy)]
pub struct Path<'a, D> {
    /// The system.
    pub system: &'a dyn Variational<Discrete = D>,
    /// Its discrete state in the step.
    pub discrete: &'a D,
    /// The step.
    pub step: Step<'a>,
    /// Writes the state at a time [s] in the step by the method's own polynomial. Returns whether there is one.
    pub inside: &'a dyn Fn(f64, &mut [f64]) -> bool,
    /// Square roots at its ends.
    pub roots: Roots,
    /// Parameters in rows, directions in columns.
    pub parameters: &'a DMatrix<f64>,
    /// Size of each direction below which it counts as none, states in units of their scales.
    pub least: &'a [f64],
    /// Tolerance relative to each direction.
    pub tolerance: f64,
}

impl Flow {
    /// Memory for a system with the states of `layout`, with these `scales`, and for `columns` directions.
    pub fn new(layout: StateLayout, scales: &[f64], columns: usize) -> Self {
        let StateLayout { positions, states, .. } = layout;
        let weight = |scale: &f64| if *scale > 0.0 { 1.0 / scale } else { 0.0 };
        let (forced, zeros) = (states - positions, || vec![0.0; states * columns]);
        Self {
            legendre: Legendre::new(),
            jacobian: Jacobian::by_states(states),
            correction: Correction::new(states),
            lengths: [0.0; NODES],
            turning: from_fn(|_| vec![0.0; forced * states]),
            pushing: from_fn(|_| vec![0.0; forced * columns]),
            moved: zeros(),
            equations: vec![0.0; NODES * forced * (NODES * forced + columns)],
            stages: from_fn(|_| zeros()),
            before: zeros(),
            inner: zeros(),
            found: zeros(),
            weights: scales.iter().take(states).map(weight).collect(),
            moving: vec![],
            least: vec![],
        }
    }

    /// Restricts the matrices to the columns that move in a step.
    fn select<D: Copy>(&mut self, path: &Path<'_, D>, tangents: &DMatrix<f64>) {
        let moves = |column: usize| {
            let numbers = tangents.column(column);
            let shares = path.parameters.column(column);
            numbers.iter().chain(shares.iter()).any(|number| *number != 0.0)
        };
        self.moving = (0..tangents.ncols()).filter(|&column| moves(column)).collect();
        self.least = self.moving.iter().map(|&column| path.least[column]).collect();
        let StateLayout { positions, states, .. } = path.step.layout;
        let length = self.moving.len() * states;
        for matrix in
            [&mut self.before, &mut self.inner, &mut self.found, &mut self.moved].into_iter().chain(&mut self.stages)
        {
            matrix.resize(length, 0.0);
        }
        for matrix in &mut self.pushing {
            matrix.resize(length - self.moving.len() * positions, 0.0);
        }
    }

    /// Advances the directions in the columns of `tangents` over the shares `from` to `to` of a step. States stand in
    /// its first rows, memories below.
    pub fn advance<D: Copy>(&mut self, path: &Path<'_, D>, [from, to]: [f64; 2], tangents: &mut DMatrix<f64>) {
        let Path { step, tolerance, .. } = *path;
        // A prescribed motion without play has no states.
        if step.h == 0.0 || from >= to || step.layout.states == 0 {
            return;
        }
        self.select(path, tangents);
        self.correct(path);
        let (start, end) = (path.roots.variable(from), path.roots.variable(to));
        let mut ends = vec![end];
        ends.extend(self.corners(path, [from, to]).into_iter().rev().map(|share| path.roots.variable(share)));
        // The part that comes first in time is last.
        let begins = ends.iter().skip(1).chain([&start]);
        let whole = |(&start, &end)| Part { start, end, halvings: 0, error: f64::INFINITY, stalls: 0 };
        let mut parts: Vec<Part> = begins.zip(&ends).map(whole).collect();
        while let Some(part) = parts.pop() {
            let error = self.attempt(path, [part.start, part.end], tangents);
            // Where halving gains nothing, the Jacobian is not smooth, or the error is rounding.
            let stalls = part.stalls + u32::from(error > LEAST_GAIN * part.error);
            if error > tolerance && part.halvings < MAX_HALVINGS && stalls < MAX_STALLS {
                let middle = 0.5 * (part.start + part.end);
                let half = Part { start: middle, halvings: part.halvings + 1, error, stalls, ..part };
                parts.extend([half, Part { start: part.start, end: middle, ..half }]);
                continue;
            }
            for (place, weight) in WEIGHTS.iter().enumerate() {
                add_multiple(&mut self.before, *weight, &self.stages[place]);
            }
            let n = step.layout.states;
            for (&column, states) in self.moving.iter().zip(self.before.chunks_exact(n)) {
                tangents.column_mut(column).iter_mut().zip(states).for_each(|(place, value)| *place = *value);
            }
        }
    }

    /// Finds the correction of the step, where the method has no polynomial of its own.
    fn correct<D: Copy>(&mut self, path: &Path<'_, D>) {
        let Path { system, discrete, step, inside, tolerance, .. } = *path;
        self.correction.forget();
        let mut y = [0.0; MAX_STATES];
        if !inside(step.t + 0.5 * step.h, &mut y[..step.layout.states]) {
            // The dense output's slack is too much for its second derivatives.
            self.correction.find(&step, system.system(), discrete, 1e-3 * tolerance);
        }
    }

    /// Writes the state at a share of the step. Rates in a stiff step do not correct its interpolant, since they multiply the
    /// error of the state: the method's own polynomial is used.
    fn write_state<D>(&self, path: &Path<'_, D>, share: f64, y: &mut [f64]) {
        let Path { step, inside, .. } = *path;
        if !inside(step.t + share * step.h, y) {
            step.state(share, self.correction.coefficients(), y);
        }
    }

    /// Shares of the step at which the slope of a rate jumps, in order. Steps end near such points, not at them.
    fn corners<D: Copy>(&self, path: &Path<'_, D>, [from, to]: [f64; 2]) -> Vec<f64> {
        let Path { system, discrete, step, .. } = *path;
        let at = |share: f64| {
            let mut y = [0.0; MAX_STATES];
            let y = &mut y[..step.layout.states];
            self.write_state(path, share, y);
            let mut functions = Discontinuities::NONE;
            system.system().discontinuities(discrete, step.t + share * step.h, y, &mut functions);
            functions
        };
        let (first, last) = (at(from), at(to));
        let ends = first.values().iter().zip(last.values()).enumerate();
        let mut corners: Vec<f64> = ends
            .filter(|(_, (first, last))| **first * **last < 0.0)
            .map(|(place, (first, last))| {
                let sign = first.signum();
                let value = |share: f64| sign * at(share).values()[place];
                root::falling(from, to, sign * first, sign * last, RESOLUTION, value)
            })
            .collect();
        corners.sort_by(f64::total_cmp);
        corners
    }

    /// Computes the stages of a part; returns its error relative to the tangents.
    fn attempt<D: Copy>(&mut self, path: &Path<'_, D>, [start, end]: [f64; 2], tangents: &DMatrix<f64>) -> f64 {
        let n = path.step.layout.states;
        for (states, &column) in self.before.chunks_exact_mut(n).zip(&self.moving) {
            states.iter_mut().zip(&tangents.column(column)).for_each(|(place, value)| *place = *value);
        }
        for node in 0..NODES {
            self.evaluate(path, node, start, end, tangents);
        }
        if self.moving.len() > MAX_ITERATED || !self.iterate(path) {
            self.eliminate(path.step.layout);
        }
        self.error()
    }

    /// J and F at one node.
    fn evaluate<D: Copy>(&mut self, path: &Path<'_, D>, node: usize, start: f64, end: f64, tangents: &DMatrix<f64>) {
        let Path { system, discrete, step, roots, parameters, .. } = *path;
        let StateLayout { positions: p, states: n, .. } = step.layout;
        let (share, slope) = roots.share(start + (end - start) * SHARES[node]);
        let length = (end - start) * slope * step.h;
        self.lengths[node] = length;
        let (mut y, t) = ([0.0; MAX_STATES], step.t + share * step.h);
        let y = &mut y[..n];
        self.write_state(path, share, y);
        system.system().jacobian(discrete, t, y, &mut self.jacobian);
        for i in p..n {
            for (j, slope) in self.jacobian.row(i).iter().enumerate() {
                self.turning[node][j * (n - p) + i - p] = length * slope;
            }
        }
        let push = &mut self.pushing[node];
        push.fill(0.0);
        let mut slopes = [0.0; MAX_STATES];
        let slopes = &mut slopes[..n];
        let mut along = |slopes: &[f64], shares: &DMatrix<f64>, row: usize| {
            for (place, &column) in push.chunks_exact_mut(n - p).zip(&self.moving) {
                add_multiple(place, length * shares[(row, column)], &slopes[p..]);
            }
        };
        for memory in 0..system.memories() {
            let moved = tangents.row(n + memory).iter().any(|share| *share != 0.0);
            if moved && system.write_rates_by_memory(memory, discrete, t, y, slopes) {
                along(slopes, tangents, n + memory);
            }
        }
        for parameter in 0..system.parameters() {
            let shares = self.moving.iter().map(|&column| parameters[(parameter, column)]);
            let Some((share, before)) = shares.zip(self.before.chunks_exact(n)).find(|(share, _)| *share != 0.0) else {
                continue;
            };
            let mut direction = [0.0; MAX_STATES];
            direction.iter_mut().zip(before).for_each(|(slope, moved)| *slope = moved / share);
            let companion = Companion { direction: &direction[..n], jacobian: &self.jacobian };
            system.write_rates_by_parameter(parameter, discrete, t, y, &companion, slopes);
            along(slopes, parameters, parameter);
        }
    }

    /// Finds the stages by fixed-point iteration; returns whether it has converged.
    fn iterate<D: Copy>(&mut self, path: &Path<'_, D>) -> bool {
        let layout = path.step.layout;
        let Self { legendre, lengths, turning, pushing, stages, before, inner, found, weights, least, .. } = self;
        for (node, stage) in stages.iter_mut().enumerate() {
            write_slopes(stage, layout, lengths[node], &turning[node], &pushing[node], before);
        }
        let mut last = f64::INFINITY;
        for _ in 0..MAX_ITERATIONS {
            let mut change = 0.0;
            for node in 0..NODES {
                inner.copy_from_slice(before);
                for (integral, stage) in legendre.integrals[node].iter().zip(&*stages) {
                    add_multiple(inner, *integral, stage);
                }
                write_slopes(found, layout, lengths[node], &turning[node], &pushing[node], inner);
                if node == NODES / 2 {
                    // All nodes come near at the same rate, but for the last if time stands still there.
                    add_multiple(&mut stages[node], -1.0, found);
                    change = size(weights, least, &stages[node], before);
                }
                stages[node].copy_from_slice(found);
            }
            if change <= (CONVERGED * path.tolerance).max(ROUNDING) {
                return true;
            }
            // Of several iterations the first may grow.
            if change > SLOWEST * last {
                return false;
            }
            last = if last.is_infinite() { 2.0 * change } else { change };
        }
        false
    }

    /// Finds the stages by elimination. With the columns q, v and z of J for positions, velocities and first-order states,
    ///
    /// K_i − J_i^(v, z)·Σ_j a_ij·K_j − J_i^q·Σ_j b_ij·K_j^v = J_i·y + J_i^q·v·Σ_j a_ij·L_j + F_i, b_ij = Σ_k a_ik·L_k·a_kj.
    fn eliminate(&mut self, layout: StateLayout) {
        let Self { legendre, lengths, turning, pushing, moved, equations, stages, before, moving, .. } = self;
        let StateLayout { positions: p, states: n, .. } = layout;
        let (forced, columns, a) = (n - p, moving.len(), &legendre.integrals);
        let size = NODES * forced;
        let width = size + columns;
        let equations = &mut equations[..size * width];
        for (i, rows) in equations.chunks_exact_mut(forced * width).enumerate() {
            let sum: f64 = a[i].iter().zip(&*lengths).map(|(share, length)| share * length).sum();
            let twice: [f64; NODES] = from_fn(|j| (0..NODES).map(|k| a[i][k] * lengths[k] * a[k][j]).sum());
            for (state, row) in moved.chunks_exact_mut(columns).enumerate() {
                for (place, start) in row.iter_mut().zip(before.chunks_exact(n)) {
                    *place = start[state] + if state < p { sum * start[p + state] } else { 0.0 };
                }
            }
            for (row_at_node, row) in rows.chunks_exact_mut(width).enumerate() {
                let slope = |state: usize| turning[i][state * forced + row_at_node];
                let (matrix, known) = row.split_at_mut(size);
                for (j, block) in matrix.chunks_exact_mut(forced).enumerate() {
                    for (state, place) in block.iter_mut().enumerate() {
                        let through_position = if state < p { twice[j] * slope(state) } else { 0.0 };
                        *place = -a[i][j] * slope(p + state) - through_position;
                    }
                }
                matrix[i * forced + row_at_node] += 1.0;
                for (place, push) in known.iter_mut().zip(pushing[i].chunks_exact(forced)) {
                    *place = push[row_at_node];
                }
                for (state, moved) in moved.chunks_exact(columns).enumerate() {
                    add_multiple(known, slope(state), moved);
                }
            }
        }
        solve_rows(size, width, equations);
        let found =
            |j: usize, state: usize, direction: usize| equations[(j * forced + state) * width + size + direction];
        for (i, stage) in stages.iter_mut().enumerate() {
            for (direction, (slopes, start)) in stage.chunks_exact_mut(n).zip(before.chunks_exact(n)).enumerate() {
                let (positions, driven) = slopes.split_at_mut(p);
                for (state, slope) in positions.iter_mut().enumerate() {
                    let gained: f64 = (0..NODES).map(|j| a[i][j] * found(j, state, direction)).sum();
                    *slope = lengths[i] * (start[p + state] + gained);
                }
                for (state, slope) in driven.iter_mut().enumerate() {
                    *slope = found(i, state, direction);
                }
            }
        }
    }

    /// Error of the part relative to the tangents. With coefficients that fall like ρ^m the error at the end falls like
    /// ρ^(2·NODES − 1), and the last coefficient is ρ^(NODES − 1).
    fn error(&mut self) -> f64 {
        let Self { legendre, stages, before, inner, weights, least, .. } = self;
        let sizes = legendre.analysis.map(|row| {
            inner.fill(0.0);
            for (share, stage) in row.iter().zip(&*stages) {
                add_multiple(inner, *share, stage);
            }
            size(weights, least, inner, before)
        });
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        if largest == 0.0 {
            return 0.0;
        }
        let last = sizes[NODES - 1] / largest;
        let error = largest * math::powf(last, (2 * NODES - 1) as f64 / (NODES - 1) as f64);
        if error.is_finite() { error } else { f64::INFINITY }
    }
}

/// Adds to `sum` the product of a matrix by columns, each as long as `sum`, with a direction.
fn add_product(sum: &mut [f64], matrix: &[f64], direction: &[f64]) {
    for (column, share) in matrix.chunks_exact(sum.len()).zip(direction) {
        add_multiple(sum, *share, column);
    }
}

/// Writes the slopes of directions at a node, where a part has this length in time, J is `turning` and F is `pushing`.
fn write_slopes(
    slopes: &mut [f64],
    layout: StateLayout,
    length: f64,
    turning: &[f64],
    pushing: &[f64],
    directions: &[f64],
) {
    let StateLayout { positions: p, states: n, .. } = layout;
    let columns = slopes.chunks_exact_mut(n).zip(directions.chunks_exact(n)).zip(pushing.chunks_exact(n - p));
    for ((slopes, direction), push) in columns {
        let (moving, forced) = slopes.split_at_mut(p);
        moving.iter_mut().zip(&direction[p..]).for_each(|(slope, speed)| *slope = length * speed);
        forced.copy_from_slice(push);
        add_product(forced, turning, direction);
    }
}

/// Largest change of a direction relative to the direction itself, states times their `weights`.
fn size(weights: &[f64], least: &[f64], changes: &[f64], directions: &[f64]) -> f64 {
    let (n, mut largest) = (weights.len(), 0.0_f64);
    let norm = |column: &[f64]| {
        let weighted = column.iter().zip(weights).map(|(value, weight)| (value * weight).abs());
        weighted.fold(0.0, |norm: f64, value| if value > norm { value } else { norm })
    };
    for ((change, direction), least) in changes.chunks_exact(n).zip(directions.chunks_exact(n)).zip(least) {
        largest = largest.max(norm(change) / norm(direction).max(*least));
        if change.iter().any(|value| !value.is_finite()) {
            return f64::INFINITY;
        }
    }
    largest
}
