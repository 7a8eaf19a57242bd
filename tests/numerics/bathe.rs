//! The composite method: its order, what it does to motions that are too fast for its step, and where it gives up.

use super::free::{Free, begin, distance, kepler, orbit, power};
use slidercrank::integrator::{IntegrationError, Settings, WorkLimit};

const ECCENTRICITY: f64 = 0.2;
const END: f64 = 4.0;

fn settings(fixed_step: f64) -> Settings {
    Settings { tolerance: 1e-6, fixed_step, effort: WorkLimit::ANY }
}

#[test]
fn the_error_of_an_orbit_falls_with_the_order() {
    let problem = Free::<_, 4> { accelerations: kepler };
    let points = [400.0, 560.0, 800.0, 1120.0].map(|steps| {
        let start = orbit(ECCENTRICITY, 0.0);
        let mut integrator = begin("bathe", &problem, settings(END / steps), 0.0, start, ());
        integrator.advance(&problem, END - 0.5 * END / steps).expect("an orbit has no trouble");
        let front = integrator.state().front();
        (1.0 / steps, distance(&front.y, &orbit(ECCENTRICITY, front.t)))
    });
    let order = power(&points);
    println!("bathe: order {order:.3}, errors {:.1e} to {:.1e}", points[0].1, points[3].1);
    assert!((order - 2.0).abs() < 0.1, "order {order}");
}

/// q̈ = −ω²·q from (1, 0): the amplitude after steps of `h`, ω·h apart.
fn amplitude(pace: f64, steps: u32) -> f64 {
    let h = 1.0 / 64.0;
    let omega = pace / h;
    let problem =
        Free::<_, 2> { accelerations: move |_: f64, q: &[f64], _: &[f64], a: &mut [f64]| a[0] = -omega * omega * q[0] };
    let mut integrator = begin("bathe", &problem, settings(h), 0.0, [1.0, 0.0], ());
    integrator.advance(&problem, h * f64::from(steps)).expect("a linear motion has no trouble");
    assert_eq!(integrator.state().statistics.rejected, 0);
    let front = integrator.state().front();
    front.y[0].hypot(front.y[1] / omega)
}

#[test]
fn what_is_too_fast_for_the_step_dies_and_what_is_slow_lasts() {
    // |R(iz)| falls as 5/z: R = (−19·w² + …)/(…) with a denominator of one degree more.
    for pace in [1e2, 1e4, 1e6] {
        let left = amplitude(pace, 1);
        println!("ω·h = {pace:e}: {left:.2e} after a step");
        assert!(left < 10.0 / pace, "{left:e} at {pace:e}");
        assert!(amplitude(pace, 8) < 1e-6, "at {pace:e}");
    }
    // A hundredth of a period to a step: the amplitude decays with the third power of that.
    let left = amplitude(0.0628, 100);
    assert!((1.0 - left).abs() < 1e-4, "{left}");
}

#[test]
fn where_newton_finds_no_state_the_step_comes_down_to_nothing() {
    let problem = Free::<_, 2> {
        accelerations: |t: f64, _: &[f64], _: &[f64], a: &mut [f64]| a[0] = if t < 0.5 { 2.0 } else { f64::NAN },
    };
    let mut integrator = begin("bathe", &problem, settings(0.01), 0.0, [0.0, 0.0], ());
    let error = integrator.advance(&problem, 1.0).expect_err("there is no way on");
    assert!(matches!(error, IntegrationError::StepUnderflow { time, .. } if (time - 0.5).abs() < 1e-6), "{error:?}");
}
