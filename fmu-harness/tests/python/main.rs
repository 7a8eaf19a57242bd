//! The Python package `slidercrank`: beside the harness, on a Dask cluster, in a notebook.
//!
//! Each test here is a file of Python tests beside this one, run by pytest in an environment that
//! `fmu_harness::python` makes under `target/` from the pinned list `python/analysis.txt`.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]
#![allow(clippy::panic, reason = "a test's way to fail")]

use fmu_harness::package::{Stock, build::workspace};
use fmu_harness::python::{Missing, environment, sources};
use fmu_harness::scenes::Scenario;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The environment's interpreter, made once for all tests.
fn python() -> &'static Path {
    static PYTHON: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    match PYTHON.get_or_init(|| environment("analysis", Missing::Make).map_err(|error| format!("{error:#}"))) {
        Ok(python) => python,
        Err(why) => panic!("no Python environment for the tests: {why}"),
    }
}

/// The scenes that are run, packaged once for all tests.
fn packages() -> &'static Path {
    static DIRECTORY: OnceLock<PathBuf> = OnceLock::new();
    DIRECTORY.get_or_init(|| {
        let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python-fmus");
        let stock = Stock::build().expect("a library");
        for name in ["ideal", "press", "wornpin"] {
            let scenario = Scenario::find(name).expect("a shipped scene");
            let file = directory.join(format!("{name}.fmu"));
            stock.package(&scenario).expect("a package").save(&file).expect("a file");
        }
        directory
    })
}

/// Runs one file of Python tests and fails with its output. What pytest sums up is always shown.
fn pytest(file: &str) {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python");
    let mut command = Command::new(python());
    command.args(["-B", "-m", "pytest", "-q", "-p", "no:cacheprovider", "--tb=short", "-rfE"]).arg(here.join(file));
    command.current_dir(&here).env("PYTHONPATH", sources()).env("PYTHONDONTWRITEBYTECODE", "1");
    command.env("SLIDERCRANK_FMUS", packages()).env("MPLBACKEND", "agg").env_remove("LD_LIBRARY_PATH");
    command.env("SLIDERCRANK_HOME", workspace()).env("SLIDERCRANK_PROGRAM", env!("CARGO_BIN_EXE_fmu-harness"));
    let output = command.output().unwrap_or_else(|error| panic!("{} cannot be started: {error}", python().display()));
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
    the_program_is_found_and_called             "test_source.py"
    an_input_is_what_its_formula_says           "test_recipe.py"
    a_quantity_is_what_its_definition_says      "test_quantity.py"
    either_program_goes_on_from_the_journal     "test_journal.py"
    a_cluster_finds_the_bits_that_sweep_finds   "test_distributed.py"
    indices_and_optima_are_those_of_theory      "test_analysis.py"
    figures_show_what_is_in_the_frame           "test_plots.py"
    the_notebook_runs                           "test_notebook.py"
    the_package_can_be_installed                "test_install.py"
}

/// Files that nobody runs would be believed.
#[test]
fn every_python_test_file_has_its_test_here() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python");
    let source = include_str!("main.rs");
    for entry in std::fs::read_dir(here).expect("the folder of this test").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with("test_") {
            assert!(source.contains(&format!("\"{name}\"")), "{name} is not run");
        }
    }
}
