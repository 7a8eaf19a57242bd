//! The state inside a step: exact on the polynomials it is made for, of high order on others.

use super::free::{Free, begin, distance, kepler, orbit, power};
use slidercrank::integrator::dense_output::{Correction, Step};
use slidercrank::integrator::{Ode, Settings, StateLayout, System, WorkLimit};

/// Coefficients of powers of t, of no particular kind.
const POLYNOMIAL: [f64; 9] = [0.3, -1.1, 0.7, 1.9, -0.8, 0.45, -0.6, 0.35, 0.52];

/// Position, velocity and acceleration of the polynomial of this degree.
fn motion(degree: usize, t: f64) -> [f64; 3] {
    let mut list = [0.0; 3];
    for (i, c) in POLYNOMIAL.iter().enumerate().take(degree + 1) {
        let n = i as f64;
        list[0] += c * t.powi(i as i32);
        list[1] += c * n * if i > 0 { t.powi(i as i32 - 1) } else { 0.0 };
        list[2] += c * n * (n - 1.0) * if i > 1 { t.powi(i as i32 - 2) } else { 0.0 };
    }
    list
}

/// Largest error inside a step from 0.2 to 1.4 whose ends are exact, and whether it was corrected.
fn error_inside(degree: usize, tolerance: f64) -> (f64, bool) {
    let problem =
        Free::<_, 2> { accelerations: move |t: f64, _: &[f64], _: &[f64], a: &mut [f64]| a[0] = motion(degree, t)[2] };
    let (t, h) = (0.2, 1.2);
    let [start, end] = [motion(degree, t), motion(degree, t + h)];
    let step = Step {
        t,
        h,
        y0: &[start[0], start[1]],
        f0: &[start[1], start[2]],
        y1: &[end[0], end[1]],
        f1: &[end[1], end[2]],
        layout: StateLayout::second_order(2),
    };
    let correction = correction(&step, &problem, tolerance);
    let mut error = 0.0f64;
    for i in 0..=40 {
        let s = f64::from(i) / 40.0;
        let exact = motion(degree, t + s * h);
        error = error.max(distance(&state(&step, s, &correction), &[exact[0], exact[1]]));
    }
    (error, correction.coefficients().is_some())
}

fn correction(step: &Step<'_>, system: &dyn System<Discrete = ()>, tolerance: f64) -> Correction {
    let mut correction = Correction::new(step.layout.states);
    correction.find(step, system, &(), tolerance);
    correction
}

fn state(step: &Step<'_>, s: f64, correction: &Correction) -> Vec<f64> {
    let mut y = vec![0.0; step.layout.states];
    step.state(s, correction.coefficients(), &mut y);
    y
}

/// Roundings of a polynomial of nine terms of size one at t = 1.4, amplified by the differences of
/// the interpolation: measured 6e-14 at most.
const ROUNDING: f64 = 4e-13;

#[test]
fn a_quintic_is_followed_exactly_without_correction() {
    for degree in 0..=5 {
        let (error, corrected) = error_inside(degree, 1e-12);
        println!("degree {degree}: {error:.1e}");
        assert!(error < ROUNDING && !corrected, "degree {degree}: {error:e}, corrected: {corrected}");
    }
}

/// A position a million times as large as what a short step adds to it.
#[test]
fn rounded_positions_leave_velocities_alone() {
    let (t, h, far) = (0.2, 1e-6, 1e4);
    let [start, end] = [motion(4, t), motion(4, t + h)];
    let step = Step {
        t,
        h,
        y0: &[far + start[0], start[1]],
        f0: &[start[1], start[2]],
        y1: &[far + end[0], end[1]],
        f1: &[end[1], end[2]],
        layout: StateLayout::second_order(2),
    };
    let mut y = [0.0; 2];
    for s in [0.1, 0.5, 0.9] {
        step.state(s, None, &mut y);
        let [position, velocity, _] = motion(4, t + s * h);
        assert!((y[1] - velocity).abs() < 4.0 * f64::EPSILON, "{s}: {} is not {velocity}", y[1]);
        assert!((y[0] - far - position).abs() < 4.0 * f64::EPSILON * far, "{s}: {} is not {}", y[0], far + position);
    }
}

#[test]
fn the_correction_makes_degree_eight_exact() {
    for degree in 6..=8 {
        let (error, corrected) = error_inside(degree, 1e-12);
        println!("degree {degree}: {error:.1e}");
        assert!(error < ROUNDING && corrected, "degree {degree}: {error:e}, corrected: {corrected}");
    }
    let (rough, corrected) = error_inside(8, 1.0);
    assert!(rough > 1e-3 && !corrected, "at a loose tolerance the quintic will do: {rough:e}");
}

#[test]
fn ends_are_met_to_the_bit() {
    let y0 = orbit(0.3, 1.0);
    let y1 = orbit(0.3, 1.5);
    let problem = Free::<_, 4> { accelerations: kepler };
    let (mut f0, mut f1) = ([0.0; 4], [0.0; 4]);
    problem.rates(&(), 1.0, &y0, &mut f0);
    problem.rates(&(), 1.5, &y1, &mut f1);
    let step = Step { t: 1.0, h: 0.5, y0: &y0, f0: &f0, y1: &y1, f1: &f1, layout: StateLayout::second_order(4) };
    for tolerance in [1e-14, 1.0] {
        let correction = correction(&step, &problem, tolerance);
        assert_eq!(state(&step, 0.0, &correction), y0);
        // At the other end the Taylor polynomial is summed up again: a few roundings of one.
        assert!(distance(&state(&step, 1.0, &correction), &y1) < 16.0 * f64::EPSILON);
    }
}

#[test]
fn between_exact_ends_of_an_orbit_the_error_falls_with_the_degree() {
    // A quintic errs with h⁵ in velocity. The correction's accelerations are taken where the quintic is
    // off by h⁶, which makes h²·h⁶/h in velocity: degree eight, order seven.
    let problem = Free::<_, 4> { accelerations: kepler };
    for (tolerance, steps, wanted) in [(1e3, [0.05, 0.06, 0.08, 0.1], 5.0), (1e-16, [0.1, 0.12, 0.15, 0.2], 7.0)] {
        let points = steps.map(|h| {
            let (y0, y1) = (orbit(0.1, 0.7), orbit(0.1, 0.7 + h));
            let (mut f0, mut f1) = ([0.0; 4], [0.0; 4]);
            problem.rates(&(), 0.7, &y0, &mut f0);
            problem.rates(&(), 0.7 + h, &y1, &mut f1);
            let step = Step { t: 0.7, h, y0: &y0, f0: &f0, y1: &y1, f1: &f1, layout: StateLayout::second_order(4) };
            let correction = correction(&step, &problem, tolerance);
            let error = (1..40).map(|i| f64::from(i) / 40.0);
            let error = error.map(|s| distance(&state(&step, s, &correction), &orbit(0.1, 0.7 + s * h)));
            (h, error.fold(0.0, f64::max))
        });
        let found = power(&points);
        println!("tolerance {tolerance:e}: velocity error falls with h^{found:.2}, {:.1e}", points[0].1);
        assert!((found - wanted).abs() < 0.15, "falls with h^{found}");
    }
}

#[test]
fn looking_back_into_a_step_is_as_accurate_as_its_end() {
    fn check(method: &str, tolerance: f64) {
        let problem = Free::<_, 4> { accelerations: kepler };
        let settings = Settings { tolerance, fixed_step: 2e-3, effort: WorkLimit::ANY };
        let mut integrator = begin(method, &problem, settings, 0.0, orbit(0.3, 0.0), ());
        let (mut at_ends, mut inside) = (0.0f64, 0.0f64);
        for i in 1..=600 {
            let t = 0.01 * f64::from(i);
            integrator.advance(&problem, t).expect("an orbit has no trouble");
            let front = integrator.state().front().clone();
            at_ends = at_ends.max(distance(&front.y, &orbit(0.3, front.t)));
            inside = inside.max(distance(integrator.state_at(&problem, t).0, &orbit(0.3, t)));
        }
        println!("{} at {tolerance:e}: {at_ends:.1e} at ends, {inside:.1e} inside", method);
        // The quintic may miss 30 tolerances of a single step unseen, and a factor for their sum.
        assert!(inside <= 2.0 * at_ends + 60.0 * tolerance, "{}: {inside:e} > {at_ends:e}", method);
    }
    for tolerance in [1e-6, 1e-9] {
        check("dopri5", tolerance);
        check("verner7", tolerance);
        check("dop853", tolerance);
        check("cong8", tolerance);
    }
    check("rk4", 1e-12);
}
