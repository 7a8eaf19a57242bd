//! All shipped scenes as FMUs, the press with its companions as an SSP package, and a run of one scene by the harness
//! itself, made once for all tests.

use super::mechanisms::packages;
use super::python;
use crate::program::stock;
use anyhow::Result;
use fmu_harness::host::Fmu;
use fmu_harness::package::{Stock, Version, build::workspace};
use fmu_harness::run::{Experiment, Until, run};
use fmu_harness::scenes::{Scenario, names};
use fmu_harness::ssp::{PRESS, package as package_ssp};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The scene that the harness runs, as `test_simulate.py` does.
pub const RUN: &str = "wornpin";
/// A scene whose slider touches the guide with its corners.
const CORNERS: &str = "guideplay";
/// Folders of the mechanisms.
const MECHANISMS: [(Version, &str); 2] = [(Version::Fmi2, "mechanisms"), (Version::Fmi3, "mechanisms3")];
/// [s] Length of that run.
pub const STOP: f64 = 0.024;
/// [s] Its communication step.
pub const STEP: f64 = 1e-5;

/// Where the files are. A scene that cannot be packaged is missing there: its tests fail, others do not.
pub fn directory() -> &'static Path {
    static DIRECTORY: OnceLock<PathBuf> = OnceLock::new();
    DIRECTORY.get_or_init(|| {
        let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fmus");
        let stock = stock();
        for scene in names(&workspace().join("fmu-harness").join("scenes")) {
            if let Err(error) = package(stock, &scene, &directory) {
                eprintln!("{scene} cannot be packaged: {error:#}");
            }
        }
        for (version, folder) in MECHANISMS {
            if let Err(error) = mechanisms(stock, version, &directory.join(folder)) {
                eprintln!("the mechanisms cannot be packaged: {error:#}");
            }
        }
        for (scene, version, ending) in [
            (RUN, Version::Fmi3, "3"),
            (RUN, Version::Fmi3WithoutClocks, "3-without-clocks"),
            (CORNERS, Version::Fmi3, "3"),
        ] {
            if let Err(error) = package_for_fmi3(stock, scene, version, &directory.join(format!("{scene}{ending}.fmu")))
            {
                eprintln!("{scene} cannot be packaged for FMI 3.0: {error:#}");
            }
        }
        if let Err(error) = couple(stock, &directory) {
            eprintln!("{PRESS} cannot be packaged with its companions: {error:#}");
        }
        if let Err(error) = record(&directory) {
            eprintln!("{RUN} cannot be run: {error:#}");
        }
        directory
    })
}

fn package(stock: &Stock, scene: &str, directory: &Path) -> Result<()> {
    let package = Scenario::find(scene).and_then(|scenario| stock.package(&scenario));
    replace(&directory.join(format!("{scene}.fmu")), |file| package?.save(file))
}

/// As portable packages, which are half as large.
fn mechanisms(stock: &Stock, version: Version, directory: &Path) -> Result<()> {
    fs::create_dir_all(directory)?;
    for (name, bytes) in packages(version, &stock.clone().portable()) {
        replace(&directory.join(format!("{name}.fmu")), |file| Ok(fs::write(file, bytes?)?))?;
    }
    Ok(())
}

fn package_for_fmi3(stock: &Stock, scene: &str, version: Version, file: &Path) -> Result<()> {
    let package = Scenario::find(scene).and_then(|scenario| stock.package_for(version, &scenario));
    replace(file, |file| package?.save(file))
}

fn couple(stock: &Stock, directory: &Path) -> Result<()> {
    let bytes = package_ssp(stock, python());
    replace(&directory.join(format!("{PRESS}.ssp")), |file| Ok(fs::write(file, bytes?)?))
}

fn record(directory: &Path) -> Result<()> {
    let fmu = Fmu::open(&directory.join(format!("{RUN}.fmu")))?;
    let experiment = Experiment {
        settings: vec![],
        inputs: vec![],
        start: 0.0,
        until: Until::Time(STOP),
        step: STEP,
        tolerance: None,
    };
    let recording = run(&fmu, &experiment, |line| eprintln!("{}", line.message), |_| ())?;
    replace(&directory.join(format!("{RUN}.csv")), |file| recording.trajectory.write_csv(file))
}

/// Puts a whole new file in an old one's place, or removes the old one: another run of these tests
/// may be reading.
fn replace(file: &Path, write: impl FnOnce(&Path) -> Result<()>) -> Result<()> {
    let draft = file.with_extension(format!("{}.draft", std::process::id()));
    let done = write(&draft).and_then(|()| Ok(fs::rename(&draft, file)?));
    if done.is_err() {
        let _ = fs::remove_file(file);
    }
    done
}
