//! Files of Python tests, run by pytest in an environment that `fmu_harness::python` makes under `target/`.
#![allow(clippy::panic, reason = "a test's way to fail")]

use fmu_harness::python::{Missing, environment, interpreter};
use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The Python tests of one folder.
pub struct Suite {
    /// The environment's interpreter, made once, or why there is none.
    pub python: OnceLock<Result<PathBuf, String>>,
    /// The environment: a list in `fmu-harness/python/` without its ending.
    pub environment: &'static str,
    /// The folder, in `fmu-harness/tests/`.
    pub folder: &'static str,
    /// The Rust file that names them all.
    pub source: &'static str,
    /// Environment variables that the tests read.
    pub variables: fn() -> Vec<(&'static str, OsString)>,
}

impl Suite {
    fn folder(&self) -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(self.folder)
    }

    /// The environment's interpreter.
    pub fn python(&self) -> &Path {
        let make = || environment(self.environment, Missing::Make).map_err(|error| format!("{error:#}"));
        match self.python.get_or_init(make) {
            Ok(python) => python,
            Err(why) => panic!("no Python environment for the tests: {why}"),
        }
    }

    /// Runs one file and fails with its output. What pytest sums up is always shown.
    pub fn run(&self, file: &str) {
        let (python, folder) = (self.python(), self.folder());
        let mut command = interpreter(python);
        command.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "--tb=short", "-rfEs"]);
        command.arg(folder.join(file)).current_dir(&folder);
        command.envs((self.variables)());
        let output = command.output().unwrap_or_else(|error| panic!("{} cannot be started: {error}", python.display()));
        let text = String::from_utf8_lossy(&output.stdout);
        let told = text.lines().filter(|line| line.starts_with("SKIPPED")).chain(text.lines().last());
        // Not through `print!`, which the test harness swallows when all is well.
        told.for_each(|line| drop(writeln!(std::io::stderr(), "{file}: {line}")));
        assert!(output.status.success(), "{file}\n{text}\n{}", String::from_utf8_lossy(&output.stderr));
    }

    /// Files that nobody runs would be believed.
    pub fn names_every_file(&self) {
        for entry in std::fs::read_dir(self.folder()).expect("the folder of the tests").flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with("test_") {
                assert!(self.source.contains(&format!("\"{name}\"")), "{name} is not run");
            }
        }
    }
}

/// Each test by its claim, with the file that holds its parts.
macro_rules! files {
    ($suite:ident: $($claim:ident $file:literal)+) => {
        $(#[test] fn $claim() { $suite.run($file); })+
        #[test]
        fn every_python_test_file_has_its_test_here() { $suite.names_every_file(); }
    };
}
