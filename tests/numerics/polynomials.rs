//! A method of order p is exact where the position is a polynomial of degree p in time.

use super::free::Free;
use slidercrank::integrator::methods::{Bs3, Dop853, Dopri5, Rk4, Verner7};
use slidercrank::integrator::stages::Attempt;
use slidercrank::integrator::{Explicit, Front, Problem};

/// Position, velocity and acceleration of tⁿ.
fn monomial(n: i32, t: f64) -> [f64; 3] {
    let n_ = f64::from(n);
    [
        t.powi(n),
        if n >= 1 { n_ * t.powi(n - 1) } else { 0.0 },
        if n >= 2 { n_ * (n_ - 1.0) * t.powi(n - 2) } else { 0.0 },
    ]
}

/// (error in position and velocity) of one step from 0.25 to 1 along tⁿ.
fn error<M: Explicit>(n: i32) -> f64 {
    let problem = Free { accelerations: |t: f64, _: &[f64], _: &[f64], a: &mut [f64]| a[0] = monomial(n, t)[2] };
    let (t, h) = (0.25, 0.75);
    let [q, v, _] = monomial(n, t);
    let mut rates = [0.0; 2];
    problem.rates(&(), t, &[q, v], &mut rates);
    let mut made = Attempt::NONE;
    made.explicitly::<M, _>(&problem, &Front { t, y: [q, v], rates, modes: (), impact_end: 0.0 }, h);
    let [q, v, _] = monomial(n, t + h);
    (made.y[0] - q).abs().max((made.y[1] - v).abs())
}

fn exact_up_to_its_order<M: Explicit>() {
    let order = M::TABLEAU.order as i32;
    // Up to twelve stages with weights b_i of at most 10 and accelerations of at most n·(n − 1).
    let sum: f64 = M::TABLEAU.b.iter().map(|b| b.abs()).sum();
    for n in 0..=order {
        let bound = 8.0 * sum * f64::from(n * n + 1) * f64::EPSILON;
        let error = error::<M>(n);
        assert!(error <= bound, "{}: t^{n} is off by {error:e}", M::NAME);
    }
    // And no further: two degrees on, even a method whose weights integrate one degree more fails.
    let beyond = error::<M>(order + 2);
    assert!(beyond > 1e-7, "{}: t^{} is off by {beyond:e} only", M::NAME, order + 2);
}

#[test]
fn each_method_is_exact_on_polynomials_up_to_its_order() {
    exact_up_to_its_order::<Rk4>();
    exact_up_to_its_order::<Bs3>();
    exact_up_to_its_order::<Dopri5>();
    exact_up_to_its_order::<Verner7>();
    exact_up_to_its_order::<Dop853>();
}

#[test]
fn a_motion_at_constant_acceleration_has_no_error_estimate() {
    fn silent<M: Explicit>() {
        let problem = Free { accelerations: |_: f64, _: &[f64], _: &[f64], a: &mut [f64]| a[0] = -9.81 };
        let start = Front { t: 0.0, y: [1.0, 2.0], rates: [2.0, -9.81], modes: (), impact_end: 0.0 };
        let mut made = Attempt::NONE;
        made.explicitly::<M, _>(&problem, &start, 0.5);
        let sum: f64 = M::TABLEAU.error.iter().map(|weight| weight.abs()).sum();
        let bound = 8.0 * sum * 9.81 * f64::EPSILON;
        assert!(made.error.iter().all(|e| e.abs() <= bound), "{}: {:?}", M::NAME, made.error);
    }
    silent::<Bs3>();
    silent::<Dopri5>();
    silent::<Verner7>();
    silent::<Dop853>();
}
