//! The Python environment of the tests, made once for all of them.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The environment's interpreter.
pub fn python() -> &'static Path {
    static PYTHON: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    let make = || {
        let requirements = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hosts/requirements.txt");
        fmu_harness::environment::python("hosts", &requirements).map_err(|error| format!("{error:#}"))
    };
    match PYTHON.get_or_init(make) {
        Ok(python) => python,
        Err(why) => panic!("no Python environment for the tests: {why}"),
    }
}
