//! Methods without error control, in steps that are too long for the motion.

use crate::run::shipped;
use slidercrank::model::signals::Inputs;
use slidercrank::scene::{DriveMode, Method};
use slidercrank::simulation::Simulation;

#[test]
fn steps_longer_than_the_impacts_end_the_run_and_are_named() {
    let mut guide = shipped("guideplay").scene;
    guide.solver.method = Method::Rk4;
    let mut accumulated = 0;
    for trial in 0..20 {
        guide.solver.step = 2e-4 * f64::from(trial).mul_add(1e-5, 1.0);
        let mut simulation = Simulation::start(&guide, Inputs::default()).expect("a start");
        let error = simulation.advance_to(0.5).expect_err("the contact is faster").to_string();
        // Rounding decides whether events or forces grow without end first.
        let named = ["events accumulate at joint T's contact ", "is not finite, or too large to continue"];
        assert!(named.iter().any(|cause| error.contains(cause)), "{error}");
        accumulated += u32::from(error.contains(named[0]));
        assert!(error.ends_with("; solver.step may be too long"), "{error}");
        let out = simulation.outputs();
        assert!(out.slider.x.is_finite() && out.crank.speed.is_finite(), "the state is intact");
    }
    assert!(accumulated > 0, "the contact is named");
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
    // Steps as long as the contact's period; those of 1 µs follow it.
    let mut pin = shipped("wornpin").scene;
    pin.solver.method = Method::Rk4;
    for (step, fits) in [(1e-4, false), (1e-6, true)] {
        pin.solver.step = step;
        let mut simulation = Simulation::start(&pin, Inputs::default()).expect("a start");
        let advanced = simulation.advance_to(0.02).map_err(|error| error.to_string());
        let is_named =
            |error: &String| error.contains("so deep in penetration that the journal lies outside its bearing");
        assert!(advanced.as_ref().map_or_else(|error| !fits && is_named(error), |()| fits), "{advanced:?}");
    }
}
