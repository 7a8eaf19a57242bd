//! Methods without error control, in steps that are too long for the motion.

use crate::run::shipped;
use slidercrank::model::coordinates::state_variables;
use slidercrank::model::signals::Inputs;
use slidercrank::scene::{DriveMode, Method};
use slidercrank::simulation::Simulation;

#[test]
fn rates_without_bound_end_the_run_and_are_named() {
    let mut film = shipped("oilpress").scene;
    (film.solver.method, film.solver.step) = (Method::Rk4, 5e-6);
    let mut simulation = Simulation::start(&film, Inputs::default()).expect("a start");
    let error = simulation.advance_to(0.1).expect_err("films are stiff").to_string();
    let named = state_variables(&film).iter().any(|state| error.contains(&format!("the rate of {} is", state.name)));
    assert!(named, "{error}");
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
