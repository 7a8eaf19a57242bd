//! The library for newer processors: used where it can be, done without where it cannot, and the same motion.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use crate::program::stock;
use fmu_harness::host::{Archive, Fmu, Kind, Setting, Variable};
use fmu_harness::package::archive::{Part, write};
use fmu_harness::package::{Package, Stock};
use fmu_harness::run::{Experiment, Until, run};
use fmu_harness::scenes::Scenario;
use slidercrank::fmi::abi::dispatch_x86_64_v3;
use std::fs;
use tempfile::TempDir;

/// Which library computes.
const USED: &str = "solver.portable_used";

/// `solver.portable = true`.
fn portable() -> Setting {
    Setting { name: "solver.portable".into(), value: "true".into() }
}

/// Outputs at every communication point of a run a tenth of a turn long.
#[derive(PartialEq)]
struct Course {
    /// Those that measure.
    measures: Vec<Vec<f64>>,
    /// Those that count.
    counts: Vec<Vec<f64>>,
    /// Which library computed.
    portable: Vec<f64>,
}

fn outputs(directory: &TempDir, package: &[u8], settings: &[Setting]) -> Course {
    let file = directory.path().join("scene.fmu");
    fs::write(&file, package).expect("written");
    let fmu = Fmu::open(&file).expect("an FMU");
    let until = Until::Turns { turns: 0.1, latest: 1.0 };
    let experiment =
        Experiment { settings: settings.to_vec(), inputs: vec![], start: 0.0, until, step: 1e-5, tolerance: None };
    let recording = run(&fmu, &experiment, |line| assert!(line.message.is_empty(), "{}", line.message), |_| {});
    let recording = recording.expect("a run");
    let outputs = fmu.description().variables.iter().filter(|variable| variable.causality() == "output");
    // An estimate of errors is no part of the motion.
    let outputs = outputs.filter(|variable| variable.name != "solver.error_estimate");
    let (measures, counts): (Vec<_>, Vec<_>) = outputs.partition(|variable| variable.kind == Kind::Real);
    let column = |name: &str| recording.column(name).expect("recorded").to_vec();
    let columns = |variables: Vec<&Variable>| -> Vec<Vec<f64>> {
        variables.iter().filter(|variable| variable.name != USED).map(|variable| column(&variable.name)).collect()
    };
    let course = Course { measures: columns(measures), counts: columns(counts), portable: column(USED) };
    assert!(course.measures.len() > 20 && course.counts.len() > 3 && course.measures[0].len() > 100);
    course
}

/// The package with what `damage` leaves of its second library.
fn damaged(directory: &TempDir, package: &[u8], damage: fn(Vec<u8>) -> Vec<u8>) -> Vec<u8> {
    let (file, unpacked) = (directory.path().join("whole.fmu"), directory.path().join("whole"));
    fs::write(&file, package).expect("written");
    let mut archive = Archive::open(&file).expect("an archive");
    archive.unpack(&unpacked).expect("unpacked");
    let is_newer = |name: &str| name.contains(dispatch_x86_64_v3::LEVEL);
    assert_eq!(archive.names().iter().filter(|name| is_newer(name)).count(), 1);
    let content = |name: &str| {
        let bytes = fs::read(unpacked.join(name)).expect("read");
        if is_newer(name) { damage(bytes) } else { bytes }
    };
    let parts: Vec<Part> = archive.names().iter().map(|name| Part::new(name.as_str(), content(name))).collect();
    write(&parts).expect("an archive")
}

#[test]
fn the_processor_chooses_the_library_and_the_motion_stays_the_same() {
    let directory = TempDir::new().expect("a directory");
    let stock = stock();
    let scenario = Scenario::find("press").expect("a shipped scene");
    let package = |stock: &Stock| -> Vec<u8> {
        let Package { bytes, .. } = stock.package(&scenario).expect("a package");
        bytes
    };
    let both = package(stock);
    let alone = package(&stock.clone().portable());
    let (found, wanted) = (outputs(&directory, &both, &[]), outputs(&directory, &alone, &[]));
    // The other library rounds otherwise, and nothing more.
    let has_level = std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma");
    assert_eq!(found.measures != wanted.measures, has_level, "the library that computes");
    let told =
        |course: &Course, portable: bool| course.portable.iter().all(|used| *used == f64::from(u8::from(portable)));
    assert!(told(&found, !has_level) && told(&wanted, true), "and its name");
    for (found, wanted) in found.measures.iter().zip(&wanted.measures) {
        let amplitude = wanted.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() <= 1e-4 * amplitude, "{found} is not {wanted}, of {amplitude}");
        }
    }
    // Whoever asks for portable bits has them, from a host or from the package.
    for package in [&both, &alone] {
        assert!(outputs(&directory, package, &[portable()]) == wanted);
    }
    let packaged = stock.package(&scenario.with(&[portable()]).expect("a scene")).expect("a package");
    assert!(outputs(&directory, &packaged.bytes, &[]) == wanted);
    // One that does not load, or was cut short, is done without.
    let foreign = |_: Vec<u8>| b"no library".to_vec();
    let empty = |_: Vec<u8>| vec![];
    let half = |library: Vec<u8>| library[..library.len() / 2].to_vec();
    let nearly_whole = |library: Vec<u8>| library[..library.len() - 1].to_vec();
    for damage in [foreign as fn(Vec<u8>) -> Vec<u8>, empty, half, nearly_whole] {
        assert!(outputs(&directory, &damaged(&directory, &both, damage), &[]) == wanted);
    }
}
