//! The packaged FMUs in hosts that others wrote: FMPy, fmutool, fmucontainer, ecos, fmuloader.
//!
//! Each test here is a file of Python tests beside this one, run by pytest in an environment that
//! `fmu_harness::python` makes under `target/` from the pinned list `python/hosts.txt`. README.md tells
//! where each of the things that hosts do to an FMU is tested.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]
#![allow(clippy::panic, reason = "a test's way to fail")]

mod packages;
mod price;
mod ssp;

use fmu_harness::python::{Missing, environment, sources};
use std::env::join_paths;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The environment's interpreter, made once for all tests.
fn python() -> &'static Path {
    static PYTHON: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    match PYTHON.get_or_init(|| environment("hosts", Missing::Make).map_err(|error| format!("{error:#}"))) {
        Ok(python) => python,
        Err(why) => panic!("no Python environment for the tests: {why}"),
    }
}

/// Runs one file of Python tests and fails with its output. What pytest sums up is always shown.
fn pytest(file: &str) {
    let (python, fmus) = (python(), packages::directory());
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hosts");
    let modules = join_paths([sources(), sources().join("press")]).expect("paths without a separator");
    let mut command = Command::new(python);
    command.args(["-B", "-m", "pytest", "-q", "-p", "no:cacheprovider", "--tb=short", "-rfE"]).arg(here.join(file));
    command.current_dir(&here).env("SLIDERCRANK_FMUS", fmus).env("PYTHONPATH", modules).env_remove("LD_LIBRARY_PATH");
    let output = command.output().unwrap_or_else(|error| panic!("{} cannot be started: {error}", python.display()));
    let text = String::from_utf8_lossy(&output.stdout);
    let summary = text.lines().last().unwrap_or_default();
    // Not through `print!`, which the test harness swallows when all is well.
    let _ = writeln!(std::io::stderr(), "{file}: {summary}");
    assert!(output.status.success(), "{file}\n{text}\n{}", String::from_utf8_lossy(&output.stderr));
}

/// Each test by its claim, with the file that holds its parts.
macro_rules! files {
    ($($claim:ident $file:literal)+) => { $(#[test] fn $claim() { pytest($file); })+ };
}

files! {
    every_validator_accepts_the_package             "test_description.py"
    fmpy_runs_it_as_the_harness_does                "test_simulate.py"
    a_restored_run_is_the_run                       "test_states.py"
    no_split_of_time_changes_the_result             "test_steps.py"
    instances_know_nothing_of_each_other            "test_instances.py"
    derivatives_are_what_they_are_called            "test_derivatives.py"
    the_odd_ways_of_hosts_lead_to_the_same_result   "test_odd_hosts.py"
    two_in_a_container_equal_two_alone              "test_container.py"
    a_press_with_its_drive_is_a_valid_package       "test_ssp.py"
    a_press_with_its_drive_runs_alike_in_two_hosts  "test_ssp_hosts.py"
    masters_of_the_press_keep_their_books           "test_ssp_masters.py"
    the_drive_of_the_press_keeps_its_rules          "test_ssp_drive.py"
}

/// Files that nobody runs would be believed.
#[test]
fn every_python_test_file_has_its_test_here() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hosts");
    let source = include_str!("main.rs");
    for entry in std::fs::read_dir(here).expect("the folder of this test").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with("test_") {
            assert!(source.contains(&format!("\"{name}\"")), "{name} is not run");
        }
    }
}
