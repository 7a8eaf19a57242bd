//! The state anywhere in an accepted step.
//!
//! Positions follow the quintic through position, velocity and acceleration at both ends, which
//! costs nothing. Where that is not accurate enough for the tolerance, three accelerations inside
//! the step, at its quarters, correct it to degree eight:
//! q(s) = quintic(s) + (s·(1 − s))³·(e0 + e1·x + e2·x²), x = s − ½ (Birkhoff interpolation; the
//! coefficients follow from q̈ at x = −¼, 0, ¼). Velocities are the derivative of positions.
//!
//! First-order states follow the cubic through value and rate at both ends, always corrected to degree
//! five by their rates at the same quarters: z(s) = cubic(s) + (s·(1 − s))²·(e0 + e1·x).

use super::problem::{Extent, Problem};

/// A quintic's error this many times a step's tolerance goes unseen.
const SLACK: f64 = 30.0;

/// An accepted step from `t` over `h`: the states and rates at its ends.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a, const N: usize> {
    /// [s] Where it starts.
    pub t: f64,
    /// [s] How long it is.
    pub h: f64,
    /// State at its start.
    pub y0: &'a [f64; N],
    /// Rates at its start.
    pub f0: &'a [f64; N],
    /// State at its end.
    pub y1: &'a [f64; N],
    /// Rates at its end.
    pub f1: &'a [f64; N],
    /// How many states there are.
    pub extent: Extent,
}

/// Corrections e0, e1, e2 of each position and first-order state; `None` where none is needed.
pub type Correction<const N: usize> = Option<[[f64; 3]; N]>;

impl<const N: usize> Step<'_, N> {
    /// The state at the share `s` of the step, 0 to 1.
    pub fn state(&self, s: f64, correction: &Correction<N>) -> [f64; N] {
        let Extent { positions: p, states, .. } = self.extent;
        let mut y = [0.0; N];
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
        y
    }

    /// Position, velocity and h²·acceleration of the quintic.
    #[inline]
    fn quintic(&self, i: usize, s: f64) -> (f64, f64, f64) {
        let (h, p) = (self.h, self.extent.positions);
        let q0 = self.y0[i];
        let (v0, v1) = (h * self.f0[i], h * self.f1[i]);
        let (a0, a1) = (h * h * self.f0[p + i], h * h * self.f1[p + i]);
        // What is left at the end of the Taylor polynomial of the start.
        let dq = self.y1[i] - q0 - v0 - 0.5 * a0;
        let dv = v1 - v0 - a0;
        let da = a1 - a0;
        let c3 = 10.0 * dq - 4.0 * dv + 0.5 * da;
        let c4 = -15.0 * dq + 7.0 * dv - da;
        let c5 = 6.0 * dq - 3.0 * dv + 0.5 * da;
        let q = q0 + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))));
        let v = v0 + s * (a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)));
        let a = a0 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5));
        (q, v / h, a)
    }

    /// A first-order state by the cubic, and h·its rate.
    #[inline]
    fn cubic(&self, i: usize, s: f64) -> (f64, f64) {
        let z0 = self.y0[i];
        let (r0, r1) = (self.h * self.f0[i], self.h * self.f1[i]);
        let (dz, dr) = (self.y1[i] - z0 - r0, r1 - r0);
        let (c2, c3) = (3.0 * dz - dr, dr - 2.0 * dz);
        (z0 + s * (r0 + s * (c2 + s * c3)), r0 + s * (2.0 * c2 + s * 3.0 * c3))
    }

    /// Looks at the acceleration half-way and, where the quintic misses it by too much for the
    /// tolerance, makes the correction.
    pub fn correction<P: Problem<N> + ?Sized>(&self, problem: &P, modes: &P::Modes, tolerance: f64) -> Correction<N> {
        let Extent { positions: p, states, .. } = self.extent;
        let half = self.defect(problem, modes, 0.5, &None);
        let scales = problem.scales();
        // Largest error of a quintic with this defect half-way: position d/24, velocity d/(10·h).
        let good = (0..p).all(|i| {
            let d = half[i].abs();
            d / 24.0 <= SLACK * tolerance * scales[i] && d / (10.0 * self.h) <= SLACK * tolerance * scales[p + i]
        });
        if good && states == 2 * p {
            return None;
        }
        let bent = if good { 0 } else { p };
        let mut e = [[0.0; 3]; N];
        for i in 0..bent {
            e[i][0] = -8.0 / 3.0 * half[i];
        }
        for i in 2 * p..states {
            e[i][1] = 16.0 * half[i];
        }
        let sextic = Some(e);
        let before = self.defect(problem, modes, 0.25, &sextic);
        let after = self.defect(problem, modes, 0.75, &sextic);
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
        // Where a step without an error estimate has gone astray, a correction may be no number.
        e.iter().flatten().all(|e| e.is_finite()).then_some(e)
    }

    /// h²·(acceleration of the system − acceleration of the quintic) at the share `s`, and h·(rate − rate
    /// of the cubic) of first-order states; the system's are taken at the corrected state.
    fn defect<P: Problem<N> + ?Sized>(
        &self,
        problem: &P,
        modes: &P::Modes,
        s: f64,
        correction: &Correction<N>,
    ) -> [f64; N] {
        let mut rates = [0.0; N];
        problem.rates(modes, self.t + s * self.h, &self.state(s, correction), &mut rates);
        let mut defect = [0.0; N];
        let Extent { positions: p, states, .. } = self.extent;
        for i in 0..p {
            defect[i] = self.h * self.h * rates[p + i] - self.quintic(i, s).2;
        }
        for i in 2 * p..states {
            defect[i] = self.h * rates[i] - self.cubic(i, s).1;
        }
        defect
    }
}
