//! An engine across the border between two libraries.

use slidercrank::fmi::abi::engine::borrowed::Borrowed;
use slidercrank::fmi::abi::engine::offered::{TABLE, attempt};
use slidercrank::fmi::abi::engine::{Sink, Table};
use slidercrank::fmi::abi::panic_guard::guarded;
use slidercrank::fmi::slave::engine::{Engine, Own, Stops};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{JointModel, Method, Scene};
use slidercrank::simulation::step_map::{By, PhaseNumbers, StepRequest};
use slidercrank::simulation::{Side, Snapshot};
use std::ffi::c_void;

/// This library as the engine of another library.
const ACROSS: Borrowed = Borrowed::from_table(&TABLE);

fn worn() -> Scene {
    let mut scene = Scene::default();
    scene.joint.c.model = JointModel::Clearance;
    scene.crank.speed_start = 500.0;
    scene
}

/// All results of a run, after some steps with changing inputs.
fn course(engine: &dyn Engine) -> (Vec<Outputs>, Snapshot) {
    let mut run = engine.start(&worn(), Inputs::default()).expect("a start");
    let mut seen = vec![run.outputs()];
    for point in 1..=20 {
        let inputs = Inputs { crank_torque: f64::from(point), slider_load: -2.0 };
        run.set_inputs(inputs, Inputs { crank_torque: 3.0, slider_load: 0.0 });
        let end = f64::from(point) * 1e-3;
        while run.time() < end {
            let event = run.advance(end, Stops::Events).expect("a step");
            assert!(event || run.time() == end);
            run.look(Side::Before);
            seen.push(run.outputs());
            run.look(Side::After);
        }
        seen.extend([run.outputs(), run.output_rates(), run.output_sensitivity(inputs)]);
    }
    assert_eq!(run.time(), 20.0 * 1e-3);
    (seen, run.snapshot())
}

#[test]
fn a_run_across_the_border_is_the_same_run() {
    assert_eq!(course(&ACROSS), course(&Own));
}

#[test]
fn a_step_map_and_a_placed_phase_are_the_same_across_the_border() {
    let (_, snapshot) = course(&Own);
    let by = vec![By::Parameter("joint.C.clearance".into()), By::SliderLoad];
    let request = StepRequest { end: 0.0205, derivatives: true, by };
    let numbers = PhaseNumbers::of(&worn());
    let found = [&ACROSS as &dyn Engine, &Own].map(|engine| {
        let mut outputs = vec![Outputs::default(); request.output_sets(&numbers)];
        let map = engine.step_map(&worn(), &snapshot, &request, &mut outputs).expect("no grazing");
        let mut run = engine.restore(&worn(), &snapshot).expect("its own snapshot");
        run.place(&numbers.phase(run.time(), &map.next));
        (map, outputs, run.outputs(), run.snapshot())
    });
    assert_eq!(found[0], found[1]);
    let (map, outputs, ..) = &found[0];
    assert!(map.jacobian.len() == numbers.count() && outputs.last().is_some_and(|last| last.slider.v != 0.0));
    let wrong = StepRequest { by: vec![By::Parameter("solver.method".into())], ..request };
    let error = |engine: &dyn Engine| engine.step_map(&worn(), &snapshot, &wrong, &mut [Outputs::default()]);
    assert_eq!(error(&ACROSS), error(&Own));
}

#[test]
fn a_snapshot_is_the_same_for_every_engine() {
    let (_, snapshot) = course(&Own);
    let ends = [&ACROSS as &dyn Engine, &Own].map(|engine| {
        let mut run = engine.restore(&worn(), &snapshot).expect("its own snapshot");
        run.advance(0.03, Stops::Steps).expect("a step");
        (run.outputs(), run.snapshot())
    });
    assert_eq!(ends[0], ends[1]);
}

#[test]
fn errors_cross_the_border_as_they_are() {
    let error = |engine: &dyn Engine, edit: fn(&mut Scene)| {
        let mut scene = worn();
        edit(&mut scene);
        engine.start(&scene, Inputs::default()).map(drop).expect_err("no start")
    };
    for edit in [
        |scene: &mut Scene| scene.guide.offset = 0.3,
        |scene: &mut Scene| {
            scene.solver.method = Method::Moreau;
            scene.energy.audit = true;
        },
    ] {
        assert_eq!(error(&ACROSS, edit), error(&Own, edit));
    }
    let broken = |engine: &dyn Engine| engine.restore(&worn(), &Snapshot::default()).map(drop).expect_err("no run");
    assert_eq!(broken(&ACROSS), broken(&Own));
    let lost = |engine: &dyn Engine| {
        let load = Inputs { crank_torque: 0.0, slider_load: 1e308 };
        let mut run = engine.start(&worn(), load).expect("a start");
        (run.advance(1.0, Stops::Nowhere).expect_err("no step"), run.time().to_bits())
    };
    assert_eq!(lost(&ACROSS), lost(&Own));
}

#[test]
fn a_panic_crosses_the_border_as_a_panic() {
    unsafe extern "C" fn breaks(_: *mut c_void, _: f64, _: Stops, sink: Sink) -> bool {
        attempt::<()>(sink, || std::panic::panic_any("a fault on purpose"));
        false
    }
    static BROKEN: Table = Table { advance: breaks, ..TABLE };
    let engine = Borrowed::from_table(&BROKEN);
    let mut run = engine.start(&worn(), Inputs::default()).expect("a start");
    let caught = guarded(|| run.advance(1.0, Stops::Nowhere));
    assert_eq!(caught, Err("a fault on purpose".into()));
}
