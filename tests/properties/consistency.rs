//! Outputs among themselves: rates are derivatives, sensitivities are differences, the mass matrix is
//! symmetric and positive, the loop closes.

use super::motion::Vec2;
use super::scenes::{
    Play, all_plays, at, at_tolerance, contacts, crooked, inputs, letters, reals, speed_driven, start, with_play,
};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{FrictionLaw, Scene};
use slidercrank::simulation::Simulation;

/// Soft contacts, so that differences over a microsecond see their forces as smooth; no limit of the damping
/// ratio, which would be a discontinuity in them.
fn soft(play: Play) -> Scene {
    let mut scene = with_play(crooked(), play);
    for contact in contacts(&mut scene) {
        contact.stiffness = 1e8;
        contact.ratio_limit = 0.0;
        contact.friction.law = FrictionLaw::Tanh;
        contact.friction.v1 = 1.0;
    }
    scene.joint.b.damping = 1e-3;
    scene.joint.t.damping = 2.0;
    at_tolerance(scene, 1e-11)
}

fn events(o: &Outputs) -> i32 {
    o.solver.events
}

/// One side of the drive or the other.
fn drives(scene: &Scene) -> [Scene; 2] {
    [scene.clone(), speed_driven(scene.clone())]
}

/// [s] Half of the interval over which differences are taken.
const HALF: f64 = 1e-6;

/// Outputs around `t`, and at it; `None` if something touches or parts near by.
fn around(simulation: &mut Simulation, t: f64) -> Option<([Outputs; 5], Outputs)> {
    let [first, second] = [t - 2.0 * HALF, t - HALF].map(|t| at(simulation, t));
    let now = at(simulation, t);
    let rates = simulation.output_rates();
    let [fourth, fifth] = [t + HALF, t + 2.0 * HALF].map(|t| at(simulation, t));
    (events(&first) == events(&fifth)).then_some(([first, second, now, fourth, fifth], rates))
}

/// The derivative of five values a `HALF` apart, and how much two ways of taking it disagree.
fn derivative(y: [f64; 5]) -> (f64, f64) {
    let (near, far) = ((y[3] - y[1]) / (2.0 * HALF), (y[4] - y[0]) / (4.0 * HALF));
    // Richardson's extrapolation; where the function is not smooth, the disagreement tells.
    ((4.0 * near - far) / 3.0, (near - far).abs())
}

#[test]
fn rates_of_outputs_are_their_differences_between_communication_points() {
    let (mut worst, mut seen) = ((0.0f64, ""), 0);
    for play in all_plays() {
        for scene in drives(&soft(play)) {
            let mut simulation = start(&scene, inputs(3.0, -20.0));
            for i in 1..=40 {
                let t = 5e-4 * f64::from(i);
                let Some((outputs, rates)) = around(&mut simulation, t) else { continue };
                let lists = outputs.map(|o| reals(&o));
                for (k, (name, rate)) in reals(&rates).into_iter().enumerate() {
                    let y = [0, 1, 2, 3, 4].map(|i: usize| lists[i][k].1);
                    assert!(rate.is_finite(), "{} {name} at {t}", letters(play));
                    let (difference, doubt) = derivative(y);
                    // Where the rate is exact, its place and speed are interpolated to 1e-16 m and 1e-11 m/s and
                    // the rounding of differences over 2e-8 s and 2e-6 s stays: measured 5e-8.
                    let size = y[2].abs().max(1.0) + rate.abs();
                    let error = (rate - difference).abs();
                    assert!(
                        error < 0.5 * doubt + 2e-7 * size,
                        "{} {name} at {t}: rate {rate}, difference {difference} ± {doubt:e}",
                        letters(play)
                    );
                    seen += 1;
                    let share = (error - 0.5 * doubt) / size;
                    if share > worst.0 {
                        worst = (share, name);
                    }
                }
            }
        }
    }
    println!("rates against differences: {:.1e} in {}, {seen} compared", worst.0, worst.1);
}

#[test]
fn rates_of_outputs_are_numbers_under_any_torque() {
    for torque in [1e6, 1e9, 1e12, 1e15] {
        let mut scene = Scene::default();
        scene.rod.flexible.bending_modes = 2;
        // Many times what the whole run takes up to its last moment, which would take any number.
        scene.solver.max_evaluations = 200_000;
        let mut simulation = start(&scene, inputs(torque, 0.0));
        // Times that the crank needs for a turn, where the mechanism does not come to an end before.
        let turn = (1e-2 / torque).sqrt();
        for i in 1..=40 {
            if simulation.advance_to(turn * f64::from(i) / 40.0).is_err() {
                break;
            }
            let rates = simulation.output_rates();
            assert!(simulation.outputs().is_finite() && rates.is_finite(), "{torque:e} N.m: {rates:?}");
        }
    }
}

#[test]
fn speeds_are_differences_of_places_and_accelerations_of_speeds() {
    let mut worst = 0.0f64;
    for play in all_plays() {
        for scene in drives(&soft(play)) {
            let mut simulation = start(&scene, inputs(3.0, -20.0));
            for i in 1..=40 {
                let t = 5e-4 * f64::from(i);
                let Some((outputs, _)) = around(&mut simulation, t) else { continue };
                let now = outputs[2];
                let slope = |value: fn(&Outputs) -> f64| derivative(outputs.map(|o| value(&o)));
                for (what, rate, (difference, doubt), size) in [
                    ("slider.v", now.slider.v, slope(|o| o.slider.x), 10.0),
                    ("slider.a", now.slider.a, slope(|o| o.slider.v), 2e3),
                    ("crank.speed", now.crank.speed, slope(|o| o.crank.angle), 150.0),
                    ("crank.acceleration", now.crank.acceleration, slope(|o| o.crank.speed), 3e4),
                    ("rod.speed", now.rod.speed, slope(|o| o.rod.angle), 60.0),
                    ("accuracy.velocity", now.accuracy.velocity, slope(|o| o.accuracy.position), 10.0),
                    ("accuracy.acceleration", now.accuracy.acceleration, slope(|o| o.accuracy.velocity), 2e3),
                ] {
                    let error = ((rate - difference).abs() - 0.5 * doubt) / size;
                    worst = worst.max(error);
                    // Places are interpolated to 1e-16 m and speeds to 1e-11 m/s, over 2e-6 s.
                    assert!(error < 1e-7, "{} {what} at {t}: {rate}, difference {difference}", letters(play));
                }
            }
        }
    }
    println!("speeds and accelerations against differences: {worst:.1e}");
}

#[test]
fn sensitivities_are_differences_between_inputs() {
    let mut worst = 0.0f64;
    for play in all_plays() {
        for scene in drives(&soft(play)) {
            let base = inputs(3.0, -20.0);
            let mut simulation = start(&scene, base);
            for i in 0..20 {
                let t = 1e-3 * f64::from(i);
                at(&mut simulation, t);
                let snapshot = simulation.snapshot();
                for seed in [inputs(1.0, 0.0), inputs(0.0, 1.0), inputs(0.7, -13.0)] {
                    let found = simulation.output_sensitivity(seed);
                    // Both from the state that new inputs meet, which a step of its own leads to.
                    let [less, more] = [-2.0, 2.0].map(|times| {
                        let mut other = Simulation::restore(&scene, &snapshot).expect("its own state");
                        let moved = Inputs {
                            crank_torque: base.crank_torque + times * seed.crank_torque,
                            slider_load: base.slider_load + times * seed.slider_load,
                        };
                        other.set_inputs(moved, Inputs::default());
                        other.outputs()
                    });
                    for (((name, less), (_, more)), (_, found)) in
                        reals(&less).into_iter().zip(reals(&more)).zip(reals(&found))
                    {
                        if !less.is_finite() {
                            continue;
                        }
                        let difference = (more - less) / 4.0;
                        // Rounding of an output's own size and of accelerations of 1e4 rad/s².
                        let size = less.abs().max(found.abs()).max(1e4);
                        worst = worst.max((found - difference).abs() / size);
                        assert!(
                            (found - difference).abs() < 1e-11 * size,
                            "{} {name} at {t}: {found}, difference {difference}",
                            letters(play)
                        );
                    }
                }
            }
        }
    }
    println!("sensitivities against differences: {worst:.1e}");
}

#[test]
fn the_mass_matrix_is_symmetric_and_positive() {
    // Accelerations of the crank and of the slider per torque and per load: a part of M⁻¹ in the
    // directions that the inputs push, so symmetric and positive definite.
    for play in all_plays() {
        let scene = soft(play);
        let mut simulation = start(&scene, inputs(3.0, -20.0));
        for i in 0..40 {
            at(&mut simulation, 5e-4 * f64::from(i));
            let torque = simulation.output_sensitivity(inputs(1.0, 0.0));
            let load = simulation.output_sensitivity(inputs(0.0, 1.0));
            let (first, last) = (torque.crank.acceleration, load.slider.a);
            let [one, other] = [torque.slider.a, load.crank.acceleration];
            let size = (first * last).sqrt();
            assert!(first > 0.0 && last > 0.0, "{}: {first}, {last}", letters(play));
            assert!((one - other).abs() < 1e-10 * size, "{}: {one} and {other}", letters(play));
            // With all joints ideal there is one coordinate: the matrix has rank one.
            assert!(one * other <= size * size * (1.0 + 1e-9), "{}: {one}·{other} over {first}·{last}", letters(play));
        }
    }
}

#[test]
fn the_loop_closes_through_every_eccentricity() {
    for play in all_plays() {
        for scene in drives(&soft(play)) {
            let mut simulation = start(&scene, inputs(3.0, -20.0));
            for i in 0..=200 {
                let o = at(&mut simulation, 1e-4 * f64::from(i));
                let along = |angle: f64, length: f64| Vec2::new(length * angle.cos(), length * angle.sin());
                let small_end = Vec2::from(o.joint_a.eccentricity) + along(o.crank.angle, scene.crank.length)
                    - Vec2::from(o.joint_b.eccentricity)
                    + along(o.rod.angle, scene.rod.length);
                let gap = small_end + Vec2::from(o.joint_c.eccentricity) - Vec2::new(o.slider.x, o.slider.y);
                // Five terms of 0.1 m: no drift, however long it runs.
                assert!(gap.norm() < 16.0 * f64::EPSILON * 0.17, "{} at step {i}: {:e}", letters(play), gap.norm());
                for (clear, penetration, e, clearance) in [
                    (play[0], o.joint_a.penetration, o.joint_a.eccentricity, 5e-4),
                    (play[1], o.joint_b.penetration, o.joint_b.eccentricity, 5e-4),
                    (play[2], o.joint_c.penetration, o.joint_c.eccentricity, 5e-4),
                ] {
                    let wanted = if clear { Vec2::from(e).norm() - clearance } else { 0.0 };
                    assert!((penetration - wanted).abs() < 4.0 * f64::EPSILON * 0.17);
                }
            }
        }
    }
}
