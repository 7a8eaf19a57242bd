//! The benchmark with clearance at the slider pin: until its first impact the rod is a pendulum on a
//! circling pivot and the slider stands still, whatever the contact laws.

use super::scenes::{at, at_tolerance, speed_driven, start, with_play};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::{DampingLaw, Elasticity, Method, Scene};
use std::f64::consts::TAU;

const SPEED: f64 = 5000.0 * TAU / 60.0;

fn worn_pin() -> Scene {
    let mut scene = speed_driven(with_play(Scene::default(), [false, false, true, false]));
    scene.crank.speed_start = SPEED;
    scene
}

/// The journal's eccentricity and its rate, from the rod's angle and speed: the pin stands at r + l.
fn journal(t: f64, [angle, speed]: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    let (r, l) = (0.05, 0.12);
    let (crank_sin, crank_cos) = (SPEED * t).sin_cos();
    let (sin, cos) = angle.sin_cos();
    let place = [r + l - r * crank_cos - l * cos, -r * crank_sin - l * sin];
    let rate = [r * SPEED * crank_sin + l * speed * sin, -r * SPEED * crank_cos - l * speed * cos];
    (place, rate)
}

/// One classical Runge-Kutta step of the rod: J_B·φ̈ = −m·(com × a_B), a_B = −ω²·r.
fn rod_step(t: f64, [angle, speed]: [f64; 2], h: f64) -> [f64; 2] {
    let acceleration = |t: f64, angle: f64| {
        let (mass, inertia, com) = (0.21, 2.5e-4, 0.06);
        let (crank_sin, crank_cos) = (SPEED * t).sin_cos();
        let pivot = [-SPEED * SPEED * 0.05 * crank_cos, -SPEED * SPEED * 0.05 * crank_sin];
        let (sin, cos) = angle.sin_cos();
        -mass * com * (cos * pivot[1] - sin * pivot[0]) / (inertia + mass * com * com)
    };
    let k1 = [speed, acceleration(t, angle)];
    let k2 = [speed + 0.5 * h * k1[1], acceleration(t + 0.5 * h, angle + 0.5 * h * k1[0])];
    let k3 = [speed + 0.5 * h * k2[1], acceleration(t + 0.5 * h, angle + 0.5 * h * k2[0])];
    let k4 = [speed + h * k3[1], acceleration(t + h, angle + h * k3[0])];
    std::array::from_fn(|i| [angle, speed][i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}

/// Time of the first impact and its speed.
fn reference() -> (f64, f64) {
    // Steps of 0.1 µs, of which the order of four leaves 1e-20.
    let h = 1e-7;
    let gap = |t: f64, rod: [f64; 2]| {
        let (place, _) = journal(t, rod);
        5e-4 - place[0].hypot(place[1])
    };
    let mut rod = [0.0, -SPEED * 0.05 / 0.12];
    let mut t = 0.0;
    loop {
        let next = rod_step(t, rod, h);
        if gap(t + h, next) < 0.0 {
            break;
        }
        (t, rod) = (t + h, next);
    }
    let (mut low, mut high) = (0.0, h);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if gap(t + middle, rod_step(t, rod, middle)) < 0.0 { high = middle } else { low = middle }
    }
    let (place, rate) = journal(t + high, rod_step(t, rod, high));
    (t + high, (place[0] * rate[0] + place[1] * rate[1]) / place[0].hypot(place[1]))
}

/// When the simulation reports the first contact, and the approach speed then.
fn first_impact(scene: &Scene) -> (f64, f64) {
    let in_contact = |t: f64| {
        let mut simulation = start(scene, Inputs::default());
        at(&mut simulation, t).joint_c.contact
    };
    // The stiffest contact, of a steel layer, opens again 10 µs later.
    let (mut low, mut high) = (2.0e-4, 2.28e-4);
    assert!(!in_contact(low) && in_contact(high));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if in_contact(middle) { high = middle } else { low = middle }
    }
    let mut simulation = start(scene, Inputs::default());
    let o = at(&mut simulation, high);
    let (place, mut rate) = journal(high, [o.rod.angle, o.rod.speed]);
    rate[0] += o.slider.v;
    (high, (place[0] * rate[0] + place[1] * rate[1]) / place[0].hypot(place[1]))
}

#[test]
fn the_reference_is_the_published_impact() {
    let (time, speed) = reference();
    let degrees = (SPEED * time).to_degrees();
    println!("first impact at {degrees:.6}° and {speed:.7} m/s");
    assert!((degrees - 6.8186).abs() <= 0.00005, "{degrees}°");
    assert!((speed - 4.38578).abs() <= 0.000005, "{speed} m/s");
}

#[test]
fn the_first_impact_comes_when_it_should_and_better_so_at_a_tighter_tolerance() {
    let (time, speed) = reference();
    for method in [Method::Dopri5, Method::Verner7, Method::Dop853] {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let mut scene = at_tolerance(worn_pin(), tolerance);
            scene.solver.method = method;
            let (found_time, found_speed) = first_impact(&scene);
            let (late, fast) = ((found_time - time).abs(), (found_speed - speed).abs());
            println!("{method:?} at {tolerance:e}: {late:.1e} s, {fast:.1e} m/s");
            // A step errs by the tolerance times 10 µm, met at 4.4 m/s; less than ten steps. Below that,
            // the rounding of e = 0.17 m − … leaves 3e-17 m.
            assert!(late < 10.0 * tolerance * 10e-6 / 4.4 + 3e-16, "{method:?} at {tolerance:e}: {late:e} s");
            // The tolerance times 10 µm times the contact's frequency, below 1e5/s.
            assert!(fast < 10.0 * tolerance + 1e-11, "{method:?} at {tolerance:e}: {fast:e} m/s");
        }
    }
}

#[test]
fn the_first_impact_does_not_know_the_contact_law() {
    let (time, speed) = reference();
    let scene = at_tolerance(worn_pin(), 1e-10);
    let laws = DampingLaw::ITEMS.iter().filter_map(|&(_, value)| DampingLaw::from_value(value));
    for law in laws {
        for &elasticity in Elasticity::ALL {
            let mut scene = scene.clone();
            scene.joint.c.contact.law = law;
            scene.joint.c.elasticity = elasticity;
            let (found_time, found_speed) = first_impact(&scene);
            let (late, fast) = ((found_time - time).abs(), (found_speed - speed).abs());
            assert!(late < 1e-14 && fast < 1e-8, "{law:?}, {elasticity:?}: {late:e} s, {fast:e} m/s");
        }
    }
}
