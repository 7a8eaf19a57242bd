//! Dense output: the state at any time in an accepted step, for methods that have no polynomial of their own
//! ([`Method::inside`](super::Method::inside)).
//!
//! Positions follow the quintic through position, velocity and acceleration at both ends, which needs no evaluation.
//! Where the quintic is not accurate enough for the tolerance, three accelerations inside the step, at its quarters,
//! correct it to degree eight: q(s) = quintic(s) + (s·(1 − s))³·(e0 + e1·x + e2·x²), x = s − ½ (Birkhoff interpolation;
//! the coefficients follow from q̈ at x = −¼, 0, ¼). Velocities are the derivative of positions. The end of a quintic is
//! the integral of the velocities' cubic and what the positions add to it, less as much of it as may be their rounding: divided by
//! a short step, the rounding would become an error of velocities and, in a stiff damper, of forces. What is left depends
//! continuously on the positions, so that neighbouring motions remain neighbours.
//!
//! First-order states follow the cubic through value and rate at both ends, always corrected to degree five by the
//! rates at the quarters: z(s) = cubic(s) + (s·(1 − s))²·(e0 + e1·x).

use super::system::{Ode, StateLayout};

/// The quintic is accepted if its error is below this many times the tolerance of a step.
const SLACK: f64 = 30.0;
/// Rounding of a difference of positions as a share of the sum of both: half a unit in the last place.
const ROUNDING: f64 = 0.25 * f64::EPSILON;

/// An accepted step from `t` over `h`: the states and rates at both ends.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// [s] Start of the step.
    pub t: f64,
    /// [s] Length of the step.
    pub h: f64,
    /// State at the start.
    pub y0: &'a [f64],
    /// Rates at the start.
    pub f0: &'a [f64],
    /// State at the end.
    pub y1: &'a [f64],
    /// Rates at the end.
    pub f1: &'a [f64],
    /// Number and kinds of the states.
    pub layout: StateLayout,
}

/// Correction of the interpolants of a step where they are not accurate enough.
#[derive(Clone, Debug)]
pub struct Correction {
    /// e0, e1, e2 of each position and first-order state.
    coefficients: Vec<[f64; 3]>,
    kind: Kind,
    /// Defects at half, a quarter and three quarters of the step.
    defects: [Vec<f64>; 3],
    y: Vec<f64>,
    rates: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Unknown,
    NotNeeded,
    Needed,
}

impl Correction {
    /// A correction of no step yet, with memory for `states` states.
    pub fn new(states: usize) -> Self {
        let zeros = || vec![0.0; states];
        Self {
            coefficients: vec![[0.0; 3]; states],
            kind: Kind::Unknown,
            defects: [zeros(), zeros(), zeros()],
            y: zeros(),
            rates: zeros(),
        }
    }

    /// Discards the correction, because there is a new step.
    #[inline]
    pub fn forget(&mut self) {
        self.kind = Kind::Unknown;
    }

    /// e0, e1, e2 of each position and first-order state; `None` if no correction is needed.
    pub fn coefficients(&self) -> Option<&[[f64; 3]]> {
        (self.kind == Kind::Needed).then_some(&self.coefficients[..])
    }

    /// Computes the correction of the `step` if the acceleration of the quintic at half the step misses that of the
    /// system by too much for the `tolerance`. Later calls for the same step do nothing.
    pub fn find<S: Ode + ?Sized>(&mut self, step: &Step<'_>, system: &S, discrete: &S::Discrete, tolerance: f64) {
        if self.kind == Kind::Unknown {
            self.kind = if self.is_made(step, system, discrete, tolerance) { Kind::Needed } else { Kind::NotNeeded };
        }
    }

    fn is_made<S: Ode + ?Sized>(
        &mut self,
        step: &Step<'_>,
        system: &S,
        discrete: &S::Discrete,
        tolerance: f64,
    ) -> bool {
        let Self { coefficients: e, defects: [half, before, after], y, rates, .. } = self;
        let StateLayout { positions: p, states, .. } = step.layout;
        let mut miss = |s: f64, e: Option<&[[f64; 3]]>, defect: &mut [f64]| {
            step.state(s, e, y);
            system.rates(discrete, step.t + s * step.h, y, rates);
            step.write_defect(s, rates, defect);
        };
        miss(0.5, None, half);
        let scales = system.scales();
        // Largest error of a quintic with defect d at half the step: d/24 in position, d/(10·h) in velocity.
        let good = (0..p).all(|i| {
            let d = half[i].abs();
            d / 24.0 <= SLACK * tolerance * scales[i] && d / (10.0 * step.h) <= SLACK * tolerance * scales[p + i]
        });
        if good && states == 2 * p {
            return false;
        }
        let bent = if good { 0 } else { p };
        e.fill([0.0; 3]);
        for i in 0..bent {
            e[i][0] = -8.0 / 3.0 * half[i];
        }
        for i in 2 * p..states {
            e[i][1] = 16.0 * half[i];
        }
        miss(0.25, Some(e), before);
        miss(0.75, Some(e), after);
        for i in 0..bent {
            let even = 0.5 * (after[i] + before[i]);
            let odd = 0.5 * (after[i] - before[i]);
            e[i][0] = -(32.0 * half[i] + 256.0 / 9.0 * even) / 10.0;
            e[i][1] = -512.0 / 45.0 * odd;
            e[i][2] = 2.0 * e[i][0] - 256.0 / 9.0 * even;
        }
        for i in 2 * p..states {
            e[i][0] = 8.0 / 3.0 * (before[i] - after[i]);
        }
        // A step without an error estimate may have diverged; its correction is then not finite and not used.
        e.iter().flatten().all(|e| e.is_finite())
    }
}

impl Step<'_> {
    /// Writes the state at the share `s` of the step, from 0 to 1, with the coefficients of a [`Correction`].
    pub fn state(&self, s: f64, correction: Option<&[[f64; 3]]>, y: &mut [f64]) {
        let StateLayout { positions: p, states, .. } = self.layout;
        for i in 0..p {
            let (q, v, _) = self.quintic(i, s);
            y[i] = q;
            y[p + i] = v;
        }
        for (i, z) in y.iter_mut().enumerate().take(states).skip(2 * p) {
            *z = self.cubic(i, s).0;
        }
        if let Some(e) = correction {
            let x = s - 0.5;
            let b = 0.25 - x * x; // s·(1 − s)
            for i in 2 * p..states {
                y[i] += b * b * (e[i][0] + x * e[i][1]);
            }
            for i in 0..p {
                let c = e[i][0] + x * (e[i][1] + x * e[i][2]);
                let slope = e[i][1] + 2.0 * x * e[i][2];
                y[i] += b * b * b * c;
                y[p + i] += b * b * (b * slope - 6.0 * x * c) / self.h;
            }
        }
    }

    /// Position, velocity and h²·acceleration of the quintic of position `i` at the share `s`.
    #[inline]
    fn quintic(&self, i: usize, s: f64) -> (f64, f64, f64) {
        let (h, p) = (self.h, self.layout.positions);
        let q0 = self.y0[i];
        let (v0, v1) = (h * self.f0[i], h * self.f1[i]);
        let (a0, a1) = (h * h * self.f0[p + i], h * h * self.f1[p + i]);
        // Differences at the end between the states and the Taylor polynomial of the start.
        let dv = v1 - v0 - a0;
        let da = a1 - a0;
        let of_velocities = 0.5 * dv - da / 12.0;
        let more = self.y1[i] - q0 - v0 - 0.5 * a0 - of_velocities;
        let rounding = ROUNDING * (q0.abs() + self.y1[i].abs());
        // Not by `clamp`, which panics if a diverged state is not a number.
        let dq = of_velocities + (more - more.max(-rounding).min(rounding));
        let c3 = 10.0 * dq - 4.0 * dv + 0.5 * da;
        let c4 = -15.0 * dq + 7.0 * dv - da;
        let c5 = 6.0 * dq - 3.0 * dv + 0.5 * da;
        let q = q0 + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))));
        let v = v0 + s * (a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)));
        let a = a0 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5));
        (q, v / h, a)
    }

    /// First-order state `i` of the cubic and h times its rate, at the share `s`.
    #[inline]
    fn cubic(&self, i: usize, s: f64) -> (f64, f64) {
        let z0 = self.y0[i];
        let (r0, r1) = (self.h * self.f0[i], self.h * self.f1[i]);
        let (dz, dr) = (self.y1[i] - z0 - r0, r1 - r0);
        let (c2, c3) = (3.0 * dz - dr, dr - 2.0 * dz);
        (z0 + s * (r0 + s * (c2 + s * c3)), r0 + s * (2.0 * c2 + s * 3.0 * c3))
    }

    /// Writes the defects at the share `s`, with the rates of the system in the interpolated state: h²·(acceleration of
    /// the system − acceleration of the quintic) of positions, h·(rate of the system − rate of the cubic) of
    /// first-order states.
    fn write_defect(&self, s: f64, rates: &[f64], defect: &mut [f64]) {
        let StateLayout { positions: p, states, .. } = self.layout;
        for i in 0..p {
            defect[i] = self.h * self.h * rates[p + i] - self.quintic(i, s).2;
        }
        for i in 2 * p..states {
            defect[i] = self.h * rates[i] - self.cubic(i, s).1;
        }
    }
}
