//! The order of each method and of its error estimate, by a fit on measured errors.

use super::free::{Free, distance, kepler, orbit, point, power, step_from};
use slidercrank::integrator::method::Attempt;
use slidercrank::integrator::methods::block::Cong8;
use slidercrank::integrator::methods::explicit::Explicit;
use slidercrank::integrator::methods::named;
use slidercrank::integrator::methods::{BS3, DOP853, DOPRI5, RK4, VERNER7};
use slidercrank::integrator::{Method, StepPoint, System, Tableau};

const ECCENTRICITY: f64 = 0.2;
/// No round part of an orbit, over which errors might cancel.
const END: f64 = 4.0;

fn step(tableau: &'static Tableau, t: f64, y: &[f64], h: f64) -> (StepPoint<()>, Attempt) {
    step_of(tableau, &Free::<_, 4> { accelerations: kepler }, t, y, h)
}

fn step_of(
    tableau: &'static Tableau,
    system: &dyn System<Discrete = ()>,
    t: f64,
    y: &[f64],
    h: f64,
) -> (StepPoint<()>, Attempt) {
    step_from(&mut Explicit::new(tableau, y.len()), system, &point(system, t, y), h)
}

/// Error at the end of this many equal steps.
fn orbit_error(tableau: &'static Tableau, steps: u32) -> f64 {
    let h = END / f64::from(steps);
    let mut y = orbit(ECCENTRICITY, 0.0).to_vec();
    for i in 0..steps {
        y = step(tableau, f64::from(i) * h, &y, h).0.y;
    }
    distance(&y, &orbit(ECCENTRICITY, END))
}

/// Within ±0.1 the measured order is the tableau's.
fn has_its_order(tableau: &'static Tableau, steps: &[u32]) {
    let points: Vec<_> = steps.iter().map(|&n| (f64::from(n).recip(), orbit_error(tableau, n))).collect();
    let order = power(&points);
    let wanted = f64::from(tableau.order);
    println!("{}: order {order:.3}, errors {:.1e} to {:.1e}", tableau.name, points[0].1, points[points.len() - 1].1);
    assert!((order - wanted).abs() < 0.1, "{}: order {order}", tableau.name);
}

#[test]
fn the_error_of_an_orbit_falls_with_the_order() {
    has_its_order(&RK4, &[400, 560, 800, 1120]);
    has_its_order(&BS3, &[600, 850, 1200, 1700]);
    has_its_order(&DOPRI5, &[150, 200, 280, 400]);
    has_its_order(&VERNER7, &[60, 75, 95, 120]);
    has_its_order(&DOP853, &[46, 53, 61, 70]);
}

/// Root of the summed squares.
fn size(error: &[f64]) -> f64 {
    error.iter().map(|e| e * e).sum::<f64>().sqrt()
}

/// The estimate as the controller weighs it: the coarse one keeps the fine one up.
fn estimate(tableau: &'static Tableau, h: f64) -> f64 {
    let (_, made) = step(tableau, 0.7, &orbit(ECCENTRICITY, 0.7), h);
    let fine = size(&made.error);
    match tableau.coarse_error {
        None => fine,
        Some(_) => fine * fine / (fine * fine + 0.01 * size(&made.coarse_error).powi(2)).sqrt(),
    }
}

#[test]
fn the_error_estimate_falls_with_the_power_that_the_controller_reckons_with() {
    fn falls(tableau: &'static Tableau, steps: [f64; 4]) {
        let points = steps.map(|h| (h, estimate(tableau, h)));
        let found = power(&points);
        println!("{}: estimate falls with h^{found:.3}", tableau.name);
        assert!((found - tableau.error_power).abs() < 0.1, "{}: power {found}", tableau.name);
    }
    falls(&BS3, [0.01, 0.012, 0.015, 0.02]);
    falls(&DOPRI5, [0.01, 0.012, 0.015, 0.02]);
    falls(&VERNER7, [0.02, 0.024, 0.03, 0.04]);
    falls(&DOP853, [0.02, 0.024, 0.03, 0.04]);
}

#[test]
fn the_estimate_is_at_least_as_large_as_the_error_of_the_step() {
    fn covers(tableau: &'static Tableau, h: f64) {
        for start in [0.0, 0.7, 1.9, 3.0, 4.4] {
            let (end, made) = step(tableau, start, &orbit(ECCENTRICITY, start), h);
            let exact = orbit(ECCENTRICITY, start + h);
            let difference: [f64; 4] = std::array::from_fn(|i| end.y[i] - exact[i]);
            let (error, estimate) = (size(&difference), estimate(tableau, h).min(size(&made.error)));
            assert!(error <= estimate, "{}: error {error:e}, estimate {estimate:e}", tableau.name);
        }
    }
    covers(&DOPRI5, 0.05);
    covers(&VERNER7, 0.1);
    covers(&DOP853, 0.2);
}

/// States of four orbits side by side, each of which starts a little later: positions first, then velocities.
const SIDE_BY_SIDE: usize = 16;

/// A step of all orbits at once, and of each alone.
fn orbits_do_not_know_of_each_other(tableau: &'static Tableau) {
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
    let (end, together) = step_of(tableau, &Free::<_, SIDE_BY_SIDE> { accelerations }, 0.0, &all, 0.1);
    for (k, orbit) in alone.iter().enumerate() {
        let (own_end, own) = step(tableau, 0.0, orbit, 0.1);
        let of = |all: &[f64]| vec![all[2 * k], all[2 * k + 1], all[8 + 2 * k], all[9 + 2 * k]];
        assert_eq!(of(&end.y), own_end.y, "{}", tableau.name);
        assert_eq!(of(&together.error), own.error, "{}", tableau.name);
        assert_eq!(of(&together.coarse_error), own.coarse_error, "{}", tableau.name);
        assert_eq!(of(&together.unseen), own.unseen, "{}", tableau.name);
    }
}

#[test]
fn a_step_of_many_states_is_that_of_each_to_the_bit() {
    for tableau in [&RK4, &BS3, &DOPRI5, &VERNER7, &DOP853] {
        orbits_do_not_know_of_each_other(tableau);
    }
}

/// Error of an orbit in blocks at the end of this many equal steps.
fn error_in_blocks(steps: u32) -> f64 {
    let problem = Free::<_, 4> { accelerations: kepler };
    let h = END / f64::from(steps);
    let (mut start, mut method) = (point(&problem, 0.0, &orbit(ECCENTRICITY, 0.0)), Cong8::new(4));
    for _ in 0..steps {
        let (end, _) = step_from(&mut method, &problem, &start, h);
        method.remember(&start, end.t);
        start = end;
    }
    distance(&start.y, &orbit(ECCENTRICITY, END))
}

#[test]
fn the_error_of_an_orbit_in_blocks_falls_with_more_than_the_order_that_is_claimed() {
    let points = [10, 12, 14, 17].map(|n| (f64::from(n).recip(), error_in_blocks(n)));
    let order = power(&points);
    println!("cong8: order {order:.3}, errors {:.1e} to {:.1e}", points[0].1, points[3].1);
    assert!(order > f64::from(Method::<()>::properties(&Cong8::new(4)).order), "order {order}");
    // As accurate as the order-8 pair, with fewer and longer steps.
    assert!(error_in_blocks(20) < orbit_error(&DOP853, 60), "{:e}", error_in_blocks(20));
}

#[test]
fn the_estimate_of_a_block_is_at_least_as_large_as_its_error() {
    let problem = Free::<_, 4> { accelerations: kepler };
    for start in [0.0, 0.7, 1.9, 3.0, 4.4] {
        for h in [0.3, 0.45] {
            let mut method = Cong8::new(4);
            for t in [start, start + h] {
                let start = point(&problem, t, &orbit(ECCENTRICITY, t));
                let (end, made) = step_from(&mut method, &problem, &start, h);
                let exact = orbit(ECCENTRICITY, t + h);
                let difference: [f64; 4] = std::array::from_fn(|i| end.y[i] - exact[i]);
                let (error, estimate) = (size(&difference), size(&made.error));
                assert!(error <= estimate, "step of {h} from {t}: error {error:e}, estimate {estimate:e}");
                method.remember(&start, t + h);
            }
        }
    }
}

/// Error of two oscillations at the end of this many equal steps of `radau13`, longer than the oscillations' radian.
fn error_by_collocation(steps: u32) -> f64 {
    let end = 12.0_f64;
    let problem =
        Free::<_, 4> { accelerations: |_: f64, q: &[f64], _: &[f64], a: &mut [f64]| (a[0], a[1]) = (-q[0], -q[1]) };
    let h = end / f64::from(steps);
    let mut method = named::<()>("radau13", 4).expect("a method");
    let mut start = point(&problem, 0.0, &[1.0, 0.0, 0.0, 1.0]);
    for _ in 0..steps {
        let (end, _) = step_from(&mut *method, &problem, &start, h);
        method.remember(&start, end.t);
        start = end;
    }
    let (sin, cos) = end.sin_cos();
    distance(&start.y, &[cos, sin, -sin, cos])
}

#[test]
fn the_error_of_oscillations_by_collocation_falls_with_the_order_that_is_claimed() {
    let points = [5, 6, 7, 8].map(|n| (f64::from(n).recip(), error_by_collocation(n)));
    let order = power(&points);
    println!("radau13: order {order:.3}, errors {:.1e} to {:.1e}", points[0].1, points[3].1);
    let claimed = f64::from(named::<()>("radau13", 4).expect("a method").properties().order);
    assert!((order - claimed).abs() < 0.5, "order {order}");
}
