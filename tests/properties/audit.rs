//! The energy audit: its residual vanishes with the tolerance, and it leaves the motion alone.

use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{DriveMode, Scene, read};
use slidercrank::simulation::Simulation;
use std::path::Path;

const SHIPPED: [&str; 7] = ["wornpin", "ideal", "guideplay", "press", "allplay", "flexrod", "seed"];

fn shipped(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../fmu-harness/scenes/{name}.toml"));
    let text = std::fs::read_to_string(&path).expect("a shipped scene");
    read::read(&text, name).expect("a legal scene").scene
}

fn run(scene: &Scene, span: f64, points: u32) -> Vec<Outputs> {
    let inputs = Inputs { crank_torque: 40.0, slider_load: -500.0 };
    let mut simulation = Simulation::start(scene, inputs).expect("a scene whose loop closes");
    let points = (1..=points).map(|i| span * f64::from(i) / f64::from(points));
    points
        .map(|t| {
            simulation.advance_to(t).expect("no trouble");
            simulation.outputs()
        })
        .collect()
}

/// Energy turned over: what went in, what came out and what was stored at most.
fn turned_over(outputs: &[Outputs]) -> f64 {
    let most = |of: &dyn Fn(&Outputs) -> f64| outputs.iter().map(|o| of(o).abs()).fold(0.0, f64::max);
    most(&|o| o.energy.torque_work) + most(&|o| o.energy.load_work) + most(&|o| o.energy.kinetic)
}

#[test]
fn in_every_shipped_scene_the_residual_is_below_a_millionth_of_the_energy_turned_over() {
    for name in SHIPPED {
        let mut scene = shipped(name);
        scene.energy.audit = true;
        scene.solver.tolerance = 1e-8;
        let turn = std::f64::consts::TAU / scene.crank.speed_start.abs().max(1.0);
        let outputs = run(&scene, turn.min(0.1), 400);
        let residual = outputs.iter().map(|o| o.energy.residual.abs()).fold(0.0, f64::max);
        let share = residual / turned_over(&outputs);
        println!("{name}: {residual:.1e} J, {share:.1e} of {:.1e} J", turned_over(&outputs));
        assert!(share < 1e-6, "{name}: {share:e}");
        assert!(outputs.iter().all(|o| o.energy.dissipated >= 0.0));
    }
}

#[test]
fn an_audit_changes_no_bit_of_the_motion() {
    for name in SHIPPED {
        let scene = shipped(name);
        let mut audited = scene.clone();
        audited.energy.audit = true;
        let alone = run(&scene, 4e-3, 50);
        let with = run(&audited, 4e-3, 50);
        for (alone, mut with) in alone.into_iter().zip(with) {
            assert!(with.energy.kinetic > 0.0 && alone.energy.kinetic == 0.0);
            with.energy = alone.energy;
            // Works and losses are its only states; without them it has no stages to compute.
            if name == "ideal" {
                assert!(with.solver.evaluations > alone.solver.evaluations);
                with.solver.evaluations = alone.solver.evaluations;
            }
            assert_eq!(alone, with, "{name}");
        }
    }
}

/// Nothing but the audit has an error there, and the rod may be hardly longer than the crank.
#[test]
fn works_of_a_prescribed_crank_are_those_of_its_way() {
    for length in [0.05001, 0.0502, 0.052, 0.15] {
        let mut scene = Scene::default();
        scene.drive.mode = DriveMode::Speed;
        (scene.energy.audit, scene.crank.speed_start, scene.crank.angle_start) = (true, 100.0, 0.3);
        (scene.rod.length, scene.rod.com.x) = (length, 0.5 * length);
        let load = 1000.0;
        let inputs = Inputs { crank_torque: 0.0, slider_load: load };
        let mut simulation = Simulation::start(&scene, inputs).expect("a scene whose loop closes");
        let start = simulation.outputs();
        simulation.advance_to(0.012).expect("no trouble");
        let end = simulation.outputs();
        let by_load = load * (end.slider.x - start.slider.x);
        let by_torque = end.energy.kinetic - start.energy.kinetic - by_load;
        println!("{length} m: {:e} J of {by_load} J", end.energy.residual);
        for (found, wanted) in
            [(end.energy.load_work, by_load), (end.energy.torque_work, by_torque), (end.energy.residual, 0.0)]
        {
            assert!((found - wanted).abs() < 1e-9 * by_load.abs(), "{length} m: {found}, not {wanted}");
        }
    }
}

/// Another point of phase space, of another time, has no sums of its own.
#[test]
fn sums_since_the_start_go_on_from_a_phase_of_another_time() {
    let mut scene = shipped("wornpin");
    scene.energy.audit = true;
    let mut simulation = Simulation::start(&scene, Inputs::default()).expect("a scene whose loop closes");
    simulation.advance_to(1e-3).expect("no trouble");
    let early = simulation.phase();
    simulation.advance_to(0.1).expect("no trouble");
    simulation.phase();
    let before = simulation.outputs().energy;
    simulation.place(&early);
    let after = simulation.outputs().energy;
    assert_eq!(after.torque_work.to_bits(), before.torque_work.to_bits());
    // What contacts have taken in is stored or lost.
    let [before, after] = [before, after].map(|energy| energy.contact_loss + energy.contact);
    assert!((after - before).abs() <= 1e-12 * before.abs(), "{after:e}, not {before:e}");
}
