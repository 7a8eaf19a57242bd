//! Wear of a journal at rest, by its closed form, through the packaged FMU; and studies that are resumed.

use crate::program::stock;
use fmu_harness::host::Fmu;
use fmu_harness::scenes::Scenario;
use fmu_harness::sweep::Journal;
use fmu_harness::wear::{Plan, Study};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::time::Duration;

/// A journal that hangs at rest in its bearing while it turns, on a linear contact of m·g/δ = 1e9 N/m.
const RESTING: &str = r#"
name = "resting"
gravity = 9.81

[run]
turns = 1
step = "20 us"

[drive]
mode = "speed"

[crank]
speed_start = 200
mass = 2
com = { x = 0, y = 0 }

[rod]
mass = 1e-12
inertia = 1e-15

[slider]
mass = 1e-12
inertia = 1e-15

[joint.A]
model = "clearance"
radius = "10 mm"
clearance = "0.1 mm"
width = "20 mm"
stiffness = 1e9
exponent = 1
law = "hertz"
eccentricity_start = { x = 0, y = -1.0001962e-4 }

[solver]
tolerance = 1e-10
"#;

const PLAN: Plan = Plan { transient: 1, turns: 3, sectors: 72, budget: Duration::from_secs(300) };
/// [m²/N]
const COEFFICIENTS: [f64; 2] = [1e-15, 3e-15];

/// Hands a study of the resting journal to `claim`, with the directory of its journal.
fn resting(claim: impl Fn(&Study, &Path)) {
    let directory = tempfile::tempdir().expect("a directory");
    let [scene, package] = ["resting.toml", "resting.fmu"].map(|name| directory.path().join(name));
    fs::write(&scene, RESTING).expect("a file");
    let scenario = Scenario::find(&scene.display().to_string()).expect("a scene");
    stock().package(&scenario).expect("a package").save(&package).expect("a file");
    let fmu = Fmu::open(&package).expect("an FMU");
    let coefficients = "A=1e-15,3e-15".parse().expect("coefficients");
    claim(&Study::new(&scenario, &fmu, &[coefficients], PLAN).expect("a study"), directory.path());
}

#[test]
fn a_resting_journal_wears_evenly_and_its_bearing_at_the_bottom_alone() {
    resting(|study, directory| {
        let journal = Journal::open(&directory.join("runs.jsonl"), &study.digest()).expect("a journal");
        let measured = study.measure(0.0, &[1e-4], &journal).expect("a run");
        let (joint, work) = (&study.joints[0], &measured.works[0]);
        let [bearing, journal] = joint.depths(1e-4, work);
        let weight = 2.0 * 9.81;
        let even = COEFFICIENTS[1] * weight * (1.0 - weight / 1e9 / (0.01 - 1e-4)) / 0.02;
        assert!((even / 2.942994e-12 - 1.0).abs() < 1e-6, "{even:e}");
        for (sector, depth) in journal.iter().enumerate() {
            assert!((depth / even - 1.0).abs() < 1e-6, "journal, sector {sector}: {depth:e}, not {even:e}");
        }
        // Sectors 53 and 54 of 72 meet at 270°.
        let deepest: f64 = bearing[53..55].iter().sum();
        let elsewhere: f64 = bearing.iter().sum::<f64>() - deepest;
        assert!(elsewhere.abs() <= 1e-12 * deepest, "bearing: {bearing:?}");

        let each = weight * (0.01 - 1e-4 - weight / 1e9) * TAU;
        let total: f64 = work.strokes.iter().sum();
        assert!((total / 3.0 / each - 1.0).abs() < 1e-6, "{total:e} J in 3 turns, not {each:e} J in each");
        let volume = |depths: &[f64], radius: f64| depths.iter().sum::<f64>() * TAU * radius * 0.02 / 72.0;
        let worn = volume(&bearing, 0.01) + volume(&journal, 0.01 - 1e-4);
        let wanted = (COEFFICIENTS[0] + COEFFICIENTS[1]) * total / 3.0;
        assert!((worn / wanted - 1.0).abs() < 1e-9, "{worn:e} m³, not {wanted:e} m³");
        let mean = |depths: &[f64]| depths.iter().sum::<f64>() / 72.0;
        let [growth, error] = joint.growth(1e-4, work);
        assert!((growth / (mean(&bearing) + mean(&journal)) - 1.0).abs() < 1e-9, "{growth:e}");
        assert!(error < 1e-6 * growth, "{error:e}");
    });
}

#[test]
fn a_study_that_was_killed_runs_nothing_twice_and_ends_the_same() {
    resting(|study, directory| {
        let file = directory.join("runs.jsonl");
        let follow = || {
            let journal = Journal::open(&file, &study.digest()).expect("a journal");
            let worn = study.follow(1e6, 1e-2, &journal, |_| {}).expect("an end");
            (worn.extrapolation.steps, worn.runs, journal.len())
        };
        let first = follow();
        let text = fs::read_to_string(&file).expect("a journal");
        assert_eq!(text.lines().count(), 1 + first.2);
        fs::write(&file, &text[..text.len() - 10]).expect("a journal");
        assert_eq!(follow(), first);
        assert_eq!(fs::read_to_string(&file).expect("a journal"), text);
        assert_eq!(follow(), first);
        assert_eq!(fs::read_to_string(&file).expect("a journal"), text);
    });
}

#[test]
fn another_table_of_modes_is_another_study() {
    resting(|study, _| {
        let [first, mut other] = [(); 2].map(|()| Scenario::find("ferod").expect("a scene"));
        other.file.scene.rod.flexible.table.as_mut().expect("a table").mass *= 2.0;
        let coefficients = ["C=1e-17".parse().expect("coefficients")];
        let digest = |scenario| Study::new(scenario, study.fmu, &coefficients, PLAN).expect("a study").digest();
        assert!(digest(&first) == digest(&first) && digest(&first) != digest(&other));
    });
}
