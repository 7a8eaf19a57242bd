//! Methods without error control, in steps that are too long for the motion.

use crate::run::shipped;
use slidercrank::model::signals::Inputs;
use slidercrank::scene::{DriveMode, Method, Scene};
use slidercrank::simulation::Simulation;

#[test]
fn events_without_end_end_the_run_and_are_named() {
    let mut guide = shipped("guideplay").scene;
    (guide.solver.method, guide.solver.step) = (Method::Rk4, 1e-3);
    let mut simulation = Simulation::start(&guide, Inputs::default()).expect("a start");
    let error = simulation.advance_to(0.5).expect_err("the contact is faster").to_string();
    assert!(error.contains("events accumulate at joint T's contact"), "{error}");
}

#[test]
fn rigid_contacts_that_a_step_loses_end_the_run_and_are_named() {
    let mut rigid = shipped("press").scene;
    (rigid.solver.method, rigid.solver.step) = (Method::Moreau, 2e-4);
    rigid.drive.mode = DriveMode::Speed;
    (rigid.crank.speed_start, rigid.crank.angle_start, rigid.gravity) = (0.0, 0.0, 0.0);
    let load = Inputs { crank_torque: 0.0, slider_load: 150e3 };
    let mut simulation = Simulation::start(&rigid, load).expect("a start");
    let error =
        simulation.advance_to(0.1).expect_err("the load moves the slide by a clearance in a few steps").to_string();
    assert!(error.contains("joint C's contact deeper in penetration than its clearance"), "{error}");
    let reached = simulation.outputs().slider.x;
    assert!((reached / 0.515 - 1.0).abs() < 1e-3, "{reached} m");
    rigid.solver.step = 1e-4;
    let mut simulation = Simulation::start(&rigid, load).expect("a start");
    simulation.advance_to(0.1).expect("it comes to rest");
}

#[test]
fn a_journal_outside_its_bearing_ends_the_run_and_is_named() {
    let end = |scene: &Scene, load: f64, time: f64| {
        let inputs = Inputs { crank_torque: 70.0, slider_load: load };
        let mut simulation = Simulation::start(scene, inputs).expect("a start");
        let advanced = simulation.advance_to(time);
        (simulation, advanced.map_err(|error| error.to_string()))
    };
    let outside = "deep in penetration that the journal's centre lies outside its bearing";
    // Steps as long as the contact's period; those of 1 µs follow it.
    let mut press = shipped("press").scene;
    press.solver.method = Method::Rk4;
    for (step, fits) in [(1e-3, false), (1e-6, true)] {
        press.solver.step = step;
        let (_, advanced) = end(&press, 0.0, 0.02);
        assert!(advanced.as_ref().map_or_else(|error| !fits && error.contains(outside), |()| fits), "{advanced:?}");
    }

    // A bearing as soft as rubber, with the default method. The run ends where a step has led outside.
    let mut soft = shipped("wornpin").scene;
    soft.joint.c.contact.young.bearing = 1e8;
    let (mut simulation, advanced) = end(&soft, -1e5, 0.1);
    assert!(
        advanced.as_ref().is_err_and(|error| error.contains(&format!("joint C's contact is so {outside}"))),
        "{advanced:?}"
    );
    let [x, y] = simulation.outputs().joint_c.eccentricity;
    let share = x.hypot(y) / soft.joint.c.radius;
    assert!(share > 1.0 && share < 2.0, "{share} radii");
}
