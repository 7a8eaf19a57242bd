//! Accepted errors follow the tolerance, and steps follow the motion.

use super::free::{Free, begin, distance, kepler, nearest, orbit, power};
use slidercrank::integrator::methods::named;
use slidercrank::integrator::{Settings, WorkLimit};

const ECCENTRICITY: f64 = 0.5;

/// Error and steps of three quarters of an orbit.
fn run(method: &str, tolerance: f64, fixed_step: f64) -> (f64, u64) {
    let problem = Free::<_, 4> { accelerations: kepler };
    let settings = Settings { tolerance, fixed_step, effort: WorkLimit::ANY };
    let mut integrator = begin(method, &problem, settings, 0.0, nearest(ECCENTRICITY), ());
    let end = 4.7;
    integrator.advance(&problem, end).expect("an orbit has no trouble");
    let front = integrator.state().front().clone();
    (distance(&front.y, &orbit(ECCENTRICITY, front.t)), integrator.state().statistics.steps)
}

#[test]
fn the_error_follows_the_tolerance() {
    fn follows(method: &str) {
        let runs = [1e-7, 1e-8, 1e-9, 1e-10, 1e-11].map(|tolerance| (tolerance, run(method, tolerance, 0.0)));
        let found = power(&runs.map(|(tolerance, (error, _))| (tolerance, error)));
        let work = power(&runs.map(|(tolerance, (_, steps))| (tolerance, steps as f64)));
        let ratios = runs.map(|(tolerance, (error, _))| error / tolerance);
        println!("{}: error ~ tolerance^{found:.2}, steps ~ tolerance^{work:.3}, {ratios:.1?}", method);
        let method = named::<()>(method, 4).expect("a method of this name");
        let (properties, method) = (method.properties(), method.properties().name);
        // Error per step: the error of a whole run falls with tolerance^(order/error_power); steps grow
        // with tolerance^(−1/error_power), those of the start apart, which the tolerance does not set.
        let wanted = f64::from(properties.order) / properties.error_power;
        assert!((found - wanted).abs() < 0.25, "{}: error ~ tolerance^{found}", method);
        let wanted = -1.0 / properties.error_power;
        assert!(wanted < work && work < 0.6 * wanted, "{}: steps ~ tolerance^{work}", method);
        // A hundred steps, each with an error that the orbit triples or so.
        assert!(ratios.iter().all(|&ratio| ratio < 300.0), "{}: {ratios:?}", method);
    }
    follows("dopri5");
    follows("verner7");
    follows("dop853");
}

#[test]
fn a_fixed_step_takes_as_many_steps_as_fit() {
    let (_, steps) = run("rk4", 1.0, 1.0 / 1024.0);
    assert_eq!(steps, (4.7f64 * 1024.0).ceil() as u64);
    let (coarse, _) = run("rk4", 1.0, 4e-3);
    let (fine, _) = run("rk4", 1.0, 2e-3);
    let order = (coarse / fine).log2();
    assert!((order - 4.0).abs() < 0.1, "order {order}");
}

#[test]
fn a_far_communication_point_does_not_change_the_steps() {
    let problem = Free::<_, 4> { accelerations: kepler };
    let settings = Settings { tolerance: 1e-8, fixed_step: 0.0, effort: WorkLimit::ANY };
    let start = || begin("verner7", &problem, settings, 0.0, nearest(ECCENTRICITY), ());
    let mut far = start();
    far.advance(&problem, 3.0).expect("an orbit has no trouble");
    let mut near = start();
    for i in 1..=3000 {
        near.advance(&problem, 1e-3 * f64::from(i)).expect("an orbit has no trouble");
    }
    assert_eq!(far.state(), near.state());
}

#[test]
fn no_step_is_longer_than_the_longest() {
    // Straight motion: no error, so the longest step of 1 is soon reached.
    let problem = Free::<_, 2> { accelerations: |_: f64, _: &[f64], _: &[f64], a: &mut [f64]| a[0] = 0.0 };
    let settings = Settings { tolerance: 1e-6, fixed_step: 0.0, effort: WorkLimit::ANY };
    let mut integrator = begin("verner7", &problem, settings, 0.0, [0.0, 1.0], ());
    let mut longest = 0.0f64;
    for i in 1..=4000 {
        integrator.advance(&problem, 0.01 * f64::from(i)).expect("straight motion has no trouble");
        let memory = integrator.state();
        longest = longest.max(memory.end().t - memory.start().t);
    }
    assert_eq!(longest, 1.0);
    assert!(integrator.state().statistics.steps < 60);
}
