//! Problems without events whose solutions are known.

use slidercrank::integrator::{Crossed, GUARDS, Guard, Jacobian, Problem, Reset};

/// A second-order problem of `N` states with these accelerations and no events.
pub struct Free<A> {
    /// [of each position] at time, positions and velocities.
    pub accelerations: A,
}

/// Weights of one: the tolerance is the error that a step may make.
static UNIT: [f64; 16] = [1.0; 16];

impl<const N: usize, A: Fn(f64, &[f64], &[f64], &mut [f64])> Problem<N> for Free<A> {
    type Modes = ();

    fn rates(&self, _: &(), t: f64, y: &[f64; N], rates: &mut [f64; N]) {
        let (positions, velocities) = y.split_at(N / 2);
        let (moving, forced) = rates.split_at_mut(N / 2);
        moving.copy_from_slice(velocities);
        (self.accelerations)(t, positions, velocities, forced);
    }

    fn jacobian(&self, (): &(), _: f64, _: &[f64; N], jacobian: &mut Jacobian<N>) {
        jacobian.state = [[f64::NAN; N]; N]; // no explicit method asks
    }

    fn scales(&self) -> &[f64; N] {
        UNIT.first_chunk().expect("at most sixteen states")
    }

    fn longest_step(&self) -> f64 {
        1.0
    }

    fn guard_count(&self) -> usize {
        0
    }

    fn guards(&self, (): &(), _: f64, _: &[f64; N], _: &mut [Guard; GUARDS]) {}

    fn guard_scale(&self) -> f64 {
        1.0
    }

    fn cross(&self, (): &(), _: f64, _: &mut [f64; N], _: &Crossed) -> Reset<()> {
        Reset { modes: (), impact: None }
    }
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
pub fn distance<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
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
