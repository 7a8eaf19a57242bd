//! What accuracy costs, measured on short windows, and how the measurements are told. Nothing here is timed.

mod diagrams;
mod report;
mod steps;

use crate::program::stock;
use fmu_harness::host::Fmu;
use fmu_harness::precision::diagram::{Budget, Diagram, Point, Verdict};
use fmu_harness::precision::ladder::Rung;
use fmu_harness::precision::{Lengths, Subject};
use fmu_harness::scenes::Scenario;
use slidercrank::scene::Method;
use std::time::Duration;

/// A budget that no run of these tests comes near.
const AMPLE: Budget = Budget {
    run: Duration::from_secs(600),
    reference: Duration::from_secs(600),
    scene: Duration::from_secs(3600),
    quick: true,
};

/// The scene, packaged and opened.
fn open(scenario: &Scenario) -> Fmu {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("scene.fmu");
    stock().package(scenario).and_then(|package| package.save(&file)).expect("a package");
    Fmu::open(&file).expect("an FMU")
}

/// What `look` sees of a shipped scene.
fn with_subject<T>(scene: &str, look: impl FnOnce(&Subject) -> T) -> T {
    let scenario = Scenario::find(scene).expect("a legal scene");
    let fmu = open(&scenario);
    look(&Subject { file: &scenario.file, fmu: &fmu, lengths: Lengths::OF_SCENE })
}

/// A run as a diagram holds it.
fn point(method: Method, tolerance: f64, error: f64, cost: f64) -> Point {
    let (error, cost, evaluations) = (Some(error), Some(cost), Some(1e7 * cost));
    let verdict = Verdict::Reached;
    Point { method, rung: Rung::Tolerance(tolerance), error, cost, evaluations, over: 0.012, verdict }
}

/// A diagram of these runs.
fn diagram(points: Vec<Point>) -> Diagram {
    Diagram { scene: "own".into(), window: 0.011, span: 0.012, floor: 1e-9, points, others: vec![] }
}
