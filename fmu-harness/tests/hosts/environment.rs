//! The Python environment of the tests, made once for all of them.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The environment's interpreter.
pub fn python() -> &'static Path {
    static PYTHON: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    match PYTHON.get_or_init(make) {
        Ok(python) => python,
        Err(why) => panic!("no Python environment for the tests: {why}"),
    }
}

fn make() -> Result<PathBuf, String> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hosts/environment.py");
    let mut command = Command::new("python3");
    command.arg(script).arg(Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("hosts"));
    let output = command.output().map_err(|error| format!("python3 cannot be started: {error}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().into())
}
