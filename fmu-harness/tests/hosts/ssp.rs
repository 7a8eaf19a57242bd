//! The press with its drive as a package: its bytes, and the study of it from the plan to the drawing.

use super::{packages, python};
use crate::program::stock;
use fmu_harness::report::ssp as report;
use fmu_harness::ssp::package;
use fmu_harness::ssp::study::{Plan, Study};

#[test]
fn the_same_package_twice_has_the_same_bytes() {
    let [one, other] = [(); 2].map(|()| package(stock(), python()).expect("a package"));
    assert!(one == other && one.len() > 100_000);
}

/// A short plan: the first stroke, three steps.
fn plan() -> Plan {
    Plan {
        stroke_stop: 0.3,
        stroke_step: 2e-4,
        factors: vec![0.0, 1.0],
        clearance_step: 2e-4,
        clearance_stop: 0.2,
        steps: vec![1e-4, 2e-4, 5e-4],
        references: [2e-5, 2.5e-5],
        ..Plan::default()
    }
}

#[test]
fn a_study_finds_the_orders_of_the_masters_and_is_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let package = packages::directory().join("press.ssp");
    let study = Study::run(python(), &package, &folder.path().join("strokes.csv"), &plan()).expect("a study");
    // A held input is wrong by its slope times half a step, a line through two values by a curvature times its square.
    // The sheet's corners lie anywhere in a step, so orders are met within a few tenths; errors of either sign may cancel at
    // one step, which looks like a higher order.
    for (method, wanted, within) in [("held", 1.0, 0.1), ("extrapolated", 2.0, 0.3), ("iterated", 2.0, 0.5)] {
        let order = report::order(&study.ideal, method).expect("three steps");
        assert!((wanted - within..wanted + 1.0).contains(&order), "{method}: {order}");
    }
    let ideal = &study.clearances[0];
    // A ram with ideal joints turns back where crank and rod are in line; a communication step of 200 µs is off that by
    // at most 100 µs, at up to 20 rad/s: 2 mrad, of which 15 mm make r·φ²/2 = 30 nm, and less than 0.
    assert!(ideal.clearance == 0.0 && ideal.dead_centre.iter().all(|error| (-3e-8..=1e-12).contains(error)));
    assert!(study.clearances[1].loaded[0] < -100e-6, "play gives way under the load");
    let told = report::strokes(&study).expect("forces").markdown();
    assert!(told.contains("| torque, largest | 2.000 kN·m |"), "{told}");
    assert_eq!(report::steps(&study).markdown().lines().count(), 2 + 9 + 1, "a row for each master and step");
    for drawing in [
        report::strokes_sheet(&study).expect("columns").svg(),
        report::clearance_sheet(&study.clearances).svg(),
        report::step_sheet(&study).svg(),
    ] {
        assert!(drawing.expect("a drawing").matches("<polyline").count() >= 6);
    }
}
