//! The equations without an integrator: those that our own integrator solves.

use slidercrank::model::signals::Inputs;
use slidercrank::scene::Scene;
use slidercrank::scene::read::read_with;
use slidercrank::simulation::{Simulation, System};

fn scene(text: &str) -> Scene {
    let none = |_: &str| Err(std::io::Error::other("no files here"));
    read_with(text, "scene.toml", &none).expect("a legal scene").scene
}

fn shipped() -> [(&'static str, Scene); 5] {
    [
        ("wornpin", scene(include_str!("../fmu-harness/scenes/peers/wornpin.toml"))),
        ("ideal", scene(include_str!("../fmu-harness/scenes/peers/ideal.toml"))),
        ("guideplay", scene(include_str!("../fmu-harness/scenes/peers/guideplay.toml"))),
        ("press", scene(include_str!("../fmu-harness/scenes/press.toml"))),
        ("lugre, elastic rod, audit", scene(include_str!("../fmu-harness/scenes/effects/11-audit.toml"))),
    ]
}

#[test]
fn it_starts_where_a_simulation_starts_and_is_as_large() {
    for (name, scene) in shipped() {
        let inputs = Inputs { crank_torque: 1.5, slider_load: -20.0 };
        let mut simulation = Simulation::start(&scene, inputs).expect("a closed loop");
        let system = System::start(&scene, inputs).expect("a closed loop");
        assert_eq!(system.size(), simulation.size(), "{name}");
        let mut y = vec![0.0; system.size().states];
        system.write_start(&mut y);
        let mut outputs = simulation.outputs();
        outputs.solver = Default::default();
        assert_eq!(system.outputs(0.0, &y), outputs, "{name}");
    }
}

#[test]
fn its_rates_are_the_slopes_of_a_simulation() {
    for (name, scene) in shipped() {
        let mut simulation = Simulation::start(&scene, Inputs::default()).expect("a closed loop");
        let system = System::start(&scene, Inputs::default()).expect("a closed loop");
        let states = system.size().states;
        let (mut y, mut rates) = (vec![0.0; states], vec![0.0; states]);
        system.write_start(&mut y);
        system.write_rates(0.0, &y, &mut rates);
        // One step of Euler's method: its error is ½·h²·ÿ, some 1e-7 m/s in the fastest of these scenes.
        let h = 1e-7;
        y.iter_mut().zip(&rates).for_each(|(y, rate)| *y += h * rate);
        simulation.advance_to(h).expect("a short step");
        let (found, wanted) = (system.outputs(h, &y), simulation.outputs());
        assert!((found.slider.v - wanted.slider.v).abs() < 1e-6, "{name}");
        assert!((found.slider.x - wanted.slider.x).abs() < 1e-11, "{name}");
        assert!((found.rod.speed - wanted.rod.speed).abs() < 1e-5, "{name}");
    }
}

#[test]
fn an_event_closes_its_contact_and_a_restart_opens_it() {
    let [(_, scene), ..] = shipped();
    let mut system = System::start(&scene, Inputs::default()).expect("a closed loop");
    let mut y = vec![0.0; 4];
    system.write_start(&mut y);
    // The journal at a hundredth of the clearance beyond its bearing, moving outward.
    (y[0], y[2]) = (y[0] + 1.01 * scene.joint.c.clearance, 3.0);
    let event = |system: &System, y: &[f64]| {
        let mut functions = [0.0];
        system.write_event_functions(0.0, y, &mut functions);
        functions[0]
    };
    let slider_acceleration = |system: &System, y: &[f64]| {
        let mut rates = [0.0; 4];
        system.write_rates(0.0, y, &mut rates);
        rates[2]
    };
    assert!(event(&system, &y) < 0.0);
    assert_eq!(slider_acceleration(&system, &y), 0.0, "an open contact exerts nothing");
    // Named by nobody: it is below zero and falls.
    system.cross(0.0, &mut y, &[false]);
    assert!(event(&system, &y) > 0.0);
    assert!(slider_acceleration(&system, &y) < 0.0);
    system.restart();
    assert!(event(&system, &y) < 0.0);
}
