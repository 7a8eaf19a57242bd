//! A method of order p is exact where the position is a polynomial of degree p in time.

use super::free::{Free, point, step_from};
use slidercrank::integrator::Tableau;
use slidercrank::integrator::methods::explicit::Explicit;
use slidercrank::integrator::methods::{BS3, DOP853, DOPRI5, RK4, VERNER7};

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
fn error(tableau: &'static Tableau, n: i32) -> f64 {
    let problem =
        Free::<_, 2> { accelerations: |t: f64, _: &[f64], _: &[f64], a: &mut [f64]| a[0] = monomial(n, t)[2] };
    let (t, h) = (0.25, 0.75);
    let [q, v, _] = monomial(n, t);
    let (end, _) = step_from(&mut Explicit::new(tableau, 2), &problem, &point(&problem, t, &[q, v]), h);
    let [q, v, _] = monomial(n, t + h);
    (end.y[0] - q).abs().max((end.y[1] - v).abs())
}

fn exact_up_to_its_order(tableau: &'static Tableau) {
    let order = tableau.order as i32;
    // Up to twelve stages with weights b_i of at most 10 and accelerations of at most n·(n − 1).
    let sum: f64 = tableau.b.iter().map(|b| b.abs()).sum();
    for n in 0..=order {
        let bound = 8.0 * sum * f64::from(n * n + 1) * f64::EPSILON;
        let error = error(tableau, n);
        assert!(error <= bound, "{}: t^{n} is off by {error:e}", tableau.name);
    }
    // And no further: two degrees on, even a method whose weights integrate one degree more fails.
    let beyond = error(tableau, order + 2);
    assert!(beyond > 1e-7, "{}: t^{} is off by {beyond:e} only", tableau.name, order + 2);
}

#[test]
fn each_method_is_exact_on_polynomials_up_to_its_order() {
    exact_up_to_its_order(&RK4);
    exact_up_to_its_order(&BS3);
    exact_up_to_its_order(&DOPRI5);
    exact_up_to_its_order(&VERNER7);
    exact_up_to_its_order(&DOP853);
}

#[test]
fn a_motion_at_constant_acceleration_has_no_error_estimate() {
    fn silent(tableau: &'static Tableau) {
        let problem = Free::<_, 2> { accelerations: |_: f64, _: &[f64], _: &[f64], a: &mut [f64]| a[0] = -9.81 };
        let start = point(&problem, 0.0, &[1.0, 2.0]);
        let (_, made) = step_from(&mut Explicit::new(tableau, 2), &problem, &start, 0.5);
        let sum: f64 = tableau.error.iter().map(|weight| weight.abs()).sum();
        let bound = 8.0 * sum * 9.81 * f64::EPSILON;
        assert!(made.error.iter().all(|e| e.abs() <= bound), "{}: {:?}", tableau.name, made.error);
    }
    silent(&BS3);
    silent(&DOPRI5);
    silent(&VERNER7);
    silent(&DOP853);
}
