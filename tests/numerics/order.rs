//! The order of each method and of its error estimate, by a fit on measured errors.

use super::free::{Free, distance, kepler, orbit, power};
use slidercrank::integrator::methods::{Bs3, Cong8, Dop853, Dopri5, Rk4, Verner7};
use slidercrank::integrator::stages::{Attempt, IN_REGISTERS};
use slidercrank::integrator::{Explicit, Front, Method, Past, Problem};

const ECCENTRICITY: f64 = 0.2;
/// No round part of an orbit, over which errors might cancel.
const END: f64 = 4.0;

fn step<M: Explicit>(t: f64, y: &[f64; 4], h: f64) -> Attempt<4> {
    step_of::<M, 4, _>(&Free { accelerations: kepler }, t, y, h)
}

fn step_of<M: Explicit, const N: usize, P: Problem<N, Modes = ()>>(
    problem: &P,
    t: f64,
    y: &[f64; N],
    h: f64,
) -> Attempt<N> {
    let mut rates = [0.0; N];
    problem.rates(&(), t, y, &mut rates);
    let mut made = Attempt::NONE;
    made.explicitly::<M, _>(problem, &Front { t, y: *y, rates, modes: (), impact_end: 0.0 }, h);
    made
}

/// Error at the end of this many equal steps.
fn orbit_error<M: Explicit>(steps: u32) -> f64 {
    let h = END / f64::from(steps);
    let mut y = orbit(ECCENTRICITY, 0.0);
    for i in 0..steps {
        y = step::<M>(f64::from(i) * h, &y, h).y;
    }
    distance(&y, &orbit(ECCENTRICITY, END))
}

/// Within ±0.1 the measured order is the tableau's.
fn has_its_order<M: Explicit>(steps: &[u32]) {
    let points: Vec<_> = steps.iter().map(|&n| (f64::from(n).recip(), orbit_error::<M>(n))).collect();
    let order = power(&points);
    let wanted = f64::from(M::TABLEAU.order);
    println!("{}: order {order:.3}, errors {:.1e} to {:.1e}", M::NAME, points[0].1, points[points.len() - 1].1);
    assert!((order - wanted).abs() < 0.1, "{}: order {order}", M::NAME);
}

#[test]
fn the_error_of_an_orbit_falls_with_the_order() {
    has_its_order::<Rk4>(&[400, 560, 800, 1120]);
    has_its_order::<Bs3>(&[600, 850, 1200, 1700]);
    has_its_order::<Dopri5>(&[150, 200, 280, 400]);
    has_its_order::<Verner7>(&[60, 75, 95, 120]);
    has_its_order::<Dop853>(&[46, 53, 61, 70]);
}

/// Root of the summed squares.
fn size(error: &[f64; 4]) -> f64 {
    error.iter().map(|e| e * e).sum::<f64>().sqrt()
}

/// The estimate as the controller weighs it: the coarse one keeps the fine one up.
fn estimate<M: Explicit>(h: f64) -> f64 {
    let made = step::<M>(0.7, &orbit(ECCENTRICITY, 0.7), h);
    let fine = size(&made.error);
    match M::TABLEAU.coarse_error {
        None => fine,
        Some(_) => fine * fine / (fine * fine + 0.01 * size(&made.coarse_error).powi(2)).sqrt(),
    }
}

#[test]
fn the_error_estimate_falls_with_the_power_that_the_controller_reckons_with() {
    fn falls<M: Explicit>(steps: [f64; 4]) {
        let points = steps.map(|h| (h, estimate::<M>(h)));
        let found = power(&points);
        println!("{}: estimate falls with h^{found:.3}", M::NAME);
        assert!((found - M::TABLEAU.error_power).abs() < 0.1, "{}: power {found}", M::NAME);
    }
    falls::<Bs3>([0.01, 0.012, 0.015, 0.02]);
    falls::<Dopri5>([0.01, 0.012, 0.015, 0.02]);
    falls::<Verner7>([0.02, 0.024, 0.03, 0.04]);
    falls::<Dop853>([0.02, 0.024, 0.03, 0.04]);
}

#[test]
fn the_estimate_is_at_least_as_large_as_the_error_of_the_step() {
    fn covers<M: Explicit>(h: f64) {
        for start in [0.0, 0.7, 1.9, 3.0, 4.4] {
            let made = step::<M>(start, &orbit(ECCENTRICITY, start), h);
            let exact = orbit(ECCENTRICITY, start + h);
            let difference: [f64; 4] = std::array::from_fn(|i| made.y[i] - exact[i]);
            let (error, estimate) = (size(&difference), estimate::<M>(h).min(size(&made.error)));
            assert!(error <= estimate, "{}: error {error:e}, estimate {estimate:e}", M::NAME);
        }
    }
    covers::<Dopri5>(0.05);
    covers::<Verner7>(0.1);
    covers::<Dop853>(0.2);
}

/// States of four orbits side by side, each of which starts a little later: positions first, then velocities.
const SIDE_BY_SIDE: usize = 16;

/// A step of all orbits at once, whose stages are in memory, and of each alone, whose stages are in registers.
fn orbits_do_not_know_of_each_other<M: Explicit>() {
    const { assert!(SIDE_BY_SIDE > IN_REGISTERS && 4 <= IN_REGISTERS) };
    let accelerations = |t: f64, q: &[f64], v: &[f64], a: &mut [f64]| {
        for i in [0, 2, 4, 6] {
            kepler(t, &q[i..i + 2], &v[i..i + 2], &mut a[i..i + 2]);
        }
    };
    let alone: [[f64; 4]; 4] = [0.3, 0.9, 2.5, 5.1].map(|t| orbit(ECCENTRICITY, t));
    let mut all = [0.0; SIDE_BY_SIDE];
    for (k, orbit) in alone.iter().enumerate() {
        all[2 * k..][..2].copy_from_slice(&orbit[..2]);
        all[8 + 2 * k..][..2].copy_from_slice(&orbit[2..]);
    }
    let together = step_of::<M, SIDE_BY_SIDE, _>(&Free { accelerations }, 0.0, &all, 0.1);
    for (k, orbit) in alone.iter().enumerate() {
        let own = step::<M>(0.0, orbit, 0.1);
        let of = |all: &[f64; SIDE_BY_SIDE]| [all[2 * k], all[2 * k + 1], all[8 + 2 * k], all[9 + 2 * k]];
        assert_eq!(of(&together.y), own.y, "{}", M::NAME);
        assert_eq!(of(&together.error), own.error, "{}", M::NAME);
        assert_eq!(of(&together.coarse_error), own.coarse_error, "{}", M::NAME);
        assert_eq!(of(&together.unseen), own.unseen, "{}", M::NAME);
    }
}

#[test]
fn stages_in_registers_and_in_memory_are_the_same_to_the_bit() {
    orbits_do_not_know_of_each_other::<Rk4>();
    orbits_do_not_know_of_each_other::<Bs3>();
    orbits_do_not_know_of_each_other::<Dopri5>();
    orbits_do_not_know_of_each_other::<Verner7>();
    orbits_do_not_know_of_each_other::<Dop853>();
}

/// Where an orbit is at `t`, as a step starts there.
fn front(problem: &impl Problem<4, Modes = ()>, t: f64) -> Front<4, ()> {
    let mut front = Front { t, y: orbit(ECCENTRICITY, t), rates: [0.0; 4], modes: (), impact_end: 0.0 };
    problem.rates(&(), t, &front.y, &mut front.rates);
    front
}

/// What a step in a block from there to `end` leaves.
fn past(made: &Attempt<4>, start: &Front<4, ()>, end: f64) -> Past<4> {
    Past { begin: start.t, end, start: start.rates, nodes: made.nodes }
}

/// Error of an orbit in blocks at the end of this many equal steps.
fn error_in_blocks(steps: u32) -> f64 {
    let problem = Free { accelerations: kepler };
    let h = END / f64::from(steps);
    let mut front = front(&problem, 0.0);
    let (mut made, mut before) = (Attempt::NONE, Past::NONE);
    for i in 1..=steps {
        made.in_block(&problem, &front, &before, h);
        let t = front.t + h;
        before = past(&made, &front, t);
        assert!(before.is_some(), "step {i} leaves something to go on from");
        front = Front { t, y: made.y, rates: made.rates, ..front };
    }
    distance(&front.y, &orbit(ECCENTRICITY, END))
}

#[test]
fn the_error_of_an_orbit_in_blocks_falls_with_more_than_the_order_that_is_claimed() {
    let points = [10, 12, 14, 17].map(|n| (f64::from(n).recip(), error_in_blocks(n)));
    let order = power(&points);
    println!("cong8: order {order:.3}, errors {:.1e} to {:.1e}", points[0].1, points[3].1);
    assert!(order > f64::from(Cong8::ORDER), "order {order}");
    // As accurate as the order-8 pair, with fewer and longer steps.
    assert!(error_in_blocks(20) < orbit_error::<Dop853>(60), "{:e}", error_in_blocks(20));
}

#[test]
fn the_estimate_of_a_block_is_at_least_as_large_as_its_error() {
    let problem = Free { accelerations: kepler };
    for start in [0.0, 0.7, 1.9, 3.0, 4.4] {
        for h in [0.3, 0.45] {
            let (mut made, mut before) = (Attempt::NONE, Past::NONE);
            for t in [start, start + h] {
                let front = front(&problem, t);
                made.in_block(&problem, &front, &before, h);
                let exact = orbit(ECCENTRICITY, t + h);
                let difference: [f64; 4] = std::array::from_fn(|i| made.y[i] - exact[i]);
                let (error, estimate) = (size(&difference), size(&made.error));
                assert!(error <= estimate, "step of {h} from {t}: error {error:e}, estimate {estimate:e}");
                before = past(&made, &front, t + h);
            }
        }
    }
}
