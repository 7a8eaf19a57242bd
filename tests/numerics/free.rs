//! Problems without events whose solutions are known.

use slidercrank::integrator::method::Attempt;
use slidercrank::integrator::methods::named;
use slidercrank::integrator::{
    Events, Integrator, Linearizable, Method, Ode, Settings, SeveralInstants, StateLayout, StepPoint, System,
};

/// A second-order problem of `N` states with these accelerations and no events.
pub struct Free<A, const N: usize = 4> {
    /// [of each position] at time, positions and velocities.
    pub accelerations: A,
}

/// Tolerance of a single step, for a method that iterates.
const TOLERANCE: f64 = 1e-10;
/// Weights of one: the tolerance is the error that a step may make.
static UNIT: [f64; 16] = [1.0; 16];

impl<const N: usize, A: Fn(f64, &[f64], &[f64], &mut [f64])> Ode for Free<A, N> {
    type Discrete = ();

    fn layout(&self) -> StateLayout {
        StateLayout::second_order(N)
    }

    fn rates(&self, (): &(), t: f64, y: &[f64], rates: &mut [f64]) {
        let (positions, velocities) = y.split_at(N / 2);
        let (moving, forced) = rates.split_at_mut(N / 2);
        moving.copy_from_slice(velocities);
        (self.accelerations)(t, positions, velocities, forced);
    }

    fn scales(&self) -> &[f64] {
        &UNIT
    }

    fn longest_step(&self) -> f64 {
        1.0
    }
}

impl<const N: usize, A: Fn(f64, &[f64], &[f64], &mut [f64])> Linearizable for Free<A, N> {}

impl<const N: usize, A: Fn(f64, &[f64], &[f64], &mut [f64])> SeveralInstants for Free<A, N> {}

impl<const N: usize, A: Fn(f64, &[f64], &[f64], &mut [f64])> Events for Free<A, N> {}

/// Starts the method of this name from the state `y` at `t`.
pub fn begin<D: Copy + 'static>(
    method: &str,
    system: &dyn System<Discrete = D>,
    settings: Settings,
    t: f64,
    y: impl AsRef<[f64]>,
    discrete: D,
) -> Integrator<D> {
    let y = y.as_ref();
    let method = named(method, y.len()).expect("a method of this name");
    Integrator::start(system, method, settings, t, y, discrete)
}

/// A point at which a step of `system` starts.
pub fn point(system: &dyn System<Discrete = ()>, t: f64, y: &[f64]) -> StepPoint<()> {
    let mut point = StepPoint::new(t, y, ());
    system.rates(&(), t, y, &mut point.rates);
    point
}

/// A step of `h` from there by a method: the state at its end, and what else it tells.
pub fn step_from(
    method: &mut dyn Method<()>,
    system: &dyn System<Discrete = ()>,
    start: &StepPoint<()>,
    h: f64,
) -> (StepPoint<()>, Attempt) {
    let (mut end, mut made) = (start.clone(), Attempt::new(start.y.len(), TOLERANCE));
    method.attempt(system, start, h, &mut end, &mut made);
    end.t = start.t + h;
    (end, made)
}

/// Two bodies: q̈ = −q/|q|³. From (1 − e, 0) at √((1 + e)/(1 − e)) across, the period is 2π.
pub fn kepler(_: f64, q: &[f64], _: &[f64], a: &mut [f64]) {
    let per_cube = (q[0] * q[0] + q[1] * q[1]).powf(-1.5);
    a[0] = -q[0] * per_cube;
    a[1] = -q[1] * per_cube;
}

/// Where an orbit of this eccentricity starts, at its nearest.
pub fn nearest(eccentricity: f64) -> [f64; 4] {
    [1.0 - eccentricity, 0.0, 0.0, ((1.0 + eccentricity) / (1.0 - eccentricity)).sqrt()]
}

/// The orbit at time `t`: Kepler's equation E − e·sin E = t by Newton's method.
pub fn orbit(eccentricity: f64, t: f64) -> [f64; 4] {
    let e = eccentricity;
    let mut anomaly = t;
    for _ in 0..50 {
        anomaly -= (anomaly - e * anomaly.sin() - t) / (1.0 - e * anomaly.cos());
    }
    let (sin, cos) = anomaly.sin_cos();
    let rate = 1.0 / (1.0 - e * cos);
    let across = (1.0 - e * e).sqrt();
    [cos - e, across * sin, -sin * rate, across * cos * rate]
}

/// Largest difference of two states.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Slope of the straight line that fits (ln x, ln y) best.
pub fn power(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let mean = logs.iter().fold((0.0, 0.0), |sum, (x, y)| (sum.0 + x / n, sum.1 + y / n));
    let (mut up, mut down) = (0.0, 0.0);
    for (x, y) in logs {
        up += (x - mean.0) * (y - mean.1);
        down += (x - mean.0) * (x - mean.0);
    }
    up / down
}
