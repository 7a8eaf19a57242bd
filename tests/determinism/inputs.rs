//! An input that changes at a communication point changes there and nowhere else.

use super::mechanisms::{Dice, END, INPUTS, METHODS, advance, bits, mechanisms, outputs_at, reached, split, start};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{JointModel, Method, Point, Scene};
use slidercrank::simulation::Simulation;

#[test]
fn setting_the_same_inputs_changes_nothing() {
    for torque in [4.0, 0.0, 1e-300] {
        let same = Inputs { crank_torque: torque, slider_load: 0.1 };
        for (name, scene) in mechanisms(Method::Verner7) {
            let begin = || Simulation::start(&scene, same).expect("a start");
            let (mut quiet, mut talkative) = (begin(), begin());
            for i in 1..=200 {
                let t = END * f64::from(i) / 200.0;
                advance(&mut quiet, t);
                advance(&mut talkative, t);
                talkative.set_inputs(same, Inputs::default());
                assert_eq!(bits(&quiet.outputs()), bits(&talkative.outputs()), "{name}, torque {torque} at {t}");
            }
        }
    }
}

#[test]
fn a_slope_that_goes_on_changes_nothing() {
    // Powers of two, so that value + rate·time is exact.
    let rate = Inputs { crank_torque: 1024.0, slider_load: -4096.0 };
    let at = |t: f64| Inputs { crank_torque: 1.0 + 1024.0 * t, slider_load: -4096.0 * t };
    let step = 1.0 / 8192.0;
    for (name, scene) in mechanisms(Method::Verner7) {
        let mut quiet = Simulation::start(&scene, at(0.0)).expect("a start");
        quiet.set_inputs(at(0.0), rate);
        let mut talkative = Simulation::start(&scene, at(0.0)).expect("a start");
        for i in 0..100 {
            let t = step * f64::from(i);
            talkative.set_inputs(at(t), rate);
            advance(&mut talkative, t + step);
        }
        advance(&mut quiet, 100.0 * step);
        assert_eq!(reached(&mut quiet).0, reached(&mut talkative).0, "{name}");
    }
}

/// Largest difference of two runs' states of motion, each over its size.
fn apart(one: &Outputs, other: &Outputs) -> f64 {
    let pairs = [
        (one.slider.x, other.slider.x, 0.1),
        (one.slider.v, other.slider.v, 10.0),
        (one.slider.y, other.slider.y, 0.01),
        (one.crank.angle, other.crank.angle, 1.0),
        (one.crank.speed, other.crank.speed, 180.0),
        (one.rod.angle, other.rod.angle, 1.0),
        (one.rod.speed, other.rod.speed, 100.0),
    ];
    pairs.into_iter().map(|(one, other, size)| (one - other).abs() / size).fold(0.0, f64::max)
}

#[test]
fn an_input_that_changes_does_so_exactly_at_its_communication_point() {
    let mut dice = Dice(0xF00D);
    let later = Inputs { crank_torque: -30.0, slider_load: 900.0 };
    for (name, scene) in METHODS.into_iter().flat_map(mechanisms) {
        for change in [0.001_234_567, 0.005, 0.009_999_9] {
            // With other splits before and after the change: the same bits.
            let runs = [0, 1, 2].map(|splits| {
                let mut simulation = start(&scene);
                for t in split(&mut dice, 0.0).into_iter().filter(|&t| t < change && splits > 0) {
                    advance(&mut simulation, t);
                }
                advance(&mut simulation, change);
                let before = simulation.outputs();
                simulation.set_inputs(later, Inputs::default());
                let after = simulation.outputs();
                // Before it the state is interpolated, after it it is the end of a step of its own: both know
                // it to the tolerance of 1e-6 of 10 µm and what the interpolation may miss; measured 1e-7.
                // Five microseconds are long for an impact.
                let bound = if scene.solver.method == Method::Rk4 { 1e-4 } else { 1e-6 };
                assert!(apart(&before, &after) < bound, "{name}: jumps by {:e}", apart(&before, &after));
                for t in split(&mut dice, change).into_iter().filter(|_| splits > 1) {
                    advance(&mut simulation, t);
                }
                advance(&mut simulation, END);
                reached(&mut simulation)
            });
            assert!(runs[0] == runs[1] && runs[1] == runs[2], "{name}, change at {change}");
        }
    }
}

#[test]
fn in_free_flight_the_load_s_impulse_counts_from_the_change_on() {
    // A slider alone on an ideal guide: v = F·t/m from the change on, and x accordingly.
    let mut scene = Scene::default();
    scene.solver.step = 5e-6;
    scene.joint.c.model = JointModel::Clearance;
    (scene.joint.c.radius, scene.joint.c.clearance) = (0.2, 0.1);
    for method in METHODS {
        scene.solver.method = method;
        for change in [0.0, 1e-9, 0.003_3, 0.007_777] {
            let mut simulation = Simulation::start(&scene, Inputs::default()).expect("a start");
            advance(&mut simulation, change);
            simulation.set_inputs(Inputs { crank_torque: 0.0, slider_load: 14.0 }, Inputs::default());
            // 14 N, 0.14 kg: 100 m/s²; then 1000 N/s on top, from 0.002 s after the change.
            let second = change + 0.002;
            advance(&mut simulation, second);
            simulation.set_inputs(
                Inputs { crank_torque: 0.0, slider_load: 14.0 },
                Inputs { crank_torque: 0.0, slider_load: 1400.0 },
            );
            for t in [0.5e-3, 1e-3, 4e-3] {
                let o = outputs_at(&mut simulation, second + t);
                let (u, jerk) = (0.002 + t, 1e4);
                let v = 100.0 * u + 0.5 * jerk * t * t;
                let x = 0.17 + 50.0 * u * u + jerk * t * t * t / 6.0;
                // The midpoint rule takes a step's mean force for its first: jerk·h³/12 too far in each.
                let rule = if method == Method::Moreau { jerk * t * scene.solver.step.powi(2) / 12.0 } else { 0.0 };
                assert!((o.slider.v - v).abs() < 1e-13, "{method:?} at {t}: {o:?}");
                assert!((o.slider.x - x - rule).abs() < 1e-15, "{method:?} at {t}: {o:?}");
                assert!((o.slider.a - 100.0 - jerk * t).abs() < 1e-11, "{method:?} at {t}: {}", o.slider.a);
            }
        }
    }
}

#[test]
fn a_slope_is_the_limit_of_many_small_changes() {
    // A host that knows no slopes, holding the value of each interval's middle.
    let (value, rate) = (2.0, 900.0);
    let load = |t: f64| Inputs { crank_torque: value + rate * t, slider_load: -60.0 };
    for (name, mut scene) in mechanisms(Method::Verner7).filter(|(name, _)| name.contains("Torque")) {
        scene.solver.tolerance = 1e-9;
        let end = 0.002;
        let mut sloped = Simulation::start(&scene, load(0.0)).expect("a start");
        sloped.set_inputs(load(0.0), Inputs { crank_torque: rate, slider_load: 0.0 });
        let wanted = outputs_at(&mut sloped, end);
        let errors = [20, 80].map(|count| {
            let mut stepped = Simulation::start(&scene, load(0.0)).expect("a start");
            for i in 0..count {
                let h = end / f64::from(count);
                stepped.set_inputs(load(h * (f64::from(i) + 0.5)), Inputs::default());
                advance(&mut stepped, h * f64::from(i + 1));
            }
            apart(&wanted, &stepped.outputs())
        });
        // The middle's rule: sixteen times less for a quarter of the step.
        assert!(errors[1] < errors[0] / 8.0 + 1e-9 && errors[0] < 1e-3, "{name}: {errors:?}");
        let drive = outputs_at(&mut sloped, end).drive_torque;
        assert!((drive - load(end).crank_torque).abs() < 1e-14, "{name}: the torque itself is an output");
    }
}

#[test]
fn outputs_use_the_inputs_of_the_interval_that_ends_until_new_ones_are_set() {
    for (name, mut scene) in mechanisms(Method::Verner7) {
        scene.slider.com = Point::default();
        let mut simulation = start(&scene);
        let before = outputs_at(&mut simulation, 0.004);
        let others = Inputs { crank_torque: 4.0, slider_load: 500.0 };
        let [first, second, third] = [others, INPUTS, others].map(|inputs| {
            simulation.set_inputs(inputs, Inputs::default());
            Outputs { solver: before.solver, ..simulation.outputs() }
        });
        assert!(apart(&before, &first) < 1e-6, "{name}: the state stays");
        // m·a = F_C + F_T + load: 560 N more, at once; to and fro brings the same bits back.
        let load = |o: &Outputs| 0.14 * o.slider.a - o.joint_c.force[0] - o.joint_t.force[0];
        assert!((load(&before) + 60.0).abs() < 1e-9 && (load(&first) - 500.0).abs() < 1e-9, "{name}: {}", load(&first));
        assert!((load(&second) + 60.0).abs() < 1e-9, "{name}: {}", load(&second));
        assert_eq!(bits(&first), bits(&third), "{name}");
    }
}
