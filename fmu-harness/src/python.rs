//! Python environments under `target/`, for zig and for measurements and tests with other programs.

use crate::package::build::workspace;
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the Python sources.
pub fn sources() -> PathBuf {
    workspace().join("fmu-harness").join("python")
}

/// What happens if an environment is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// It is made, with packages from the package index.
    Make,
    /// It is an error.
    Refuse,
}

/// The interpreter of the environment `target/NAME`, with the packages that `python/NAME.txt` lists.
///
/// # Errors
/// If Python or the package index is missing; the text says which.
pub fn environment(name: &str, missing: Missing) -> Result<PathBuf> {
    let mut command = Command::new("python3");
    command.arg(sources().join("environment.py"));
    command.arg(workspace().join("target").join(name)).arg(sources().join(format!("{name}.txt")));
    if missing == Missing::Refuse {
        command.arg("--find");
    }
    Ok(PathBuf::from(output(&mut command)?.trim()))
}

/// An environment's interpreter. What it compiles lies under `target/`, not beside the sources.
pub fn interpreter(python: &Path) -> Command {
    let mut command = Command::new(python);
    command.env("PYTHONPYCACHEPREFIX", workspace().join("target").join("pycache"));
    command.env_remove("PYTHONDONTWRITEBYTECODE").env_remove("PYTHONPATH").env_remove("LD_LIBRARY_PATH");
    command
}

/// A script of [`sources`], run by an environment's interpreter.
pub fn script(python: &Path, name: &str) -> Command {
    let mut command = interpreter(python);
    command.arg(sources().join(name));
    command
}

/// Runs a command and returns its standard output. The error is its standard error.
pub fn output(command: &mut Command) -> Result<String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output().with_context(|| format!("{program} cannot be started"))?;
    if !output.status.success() {
        bail!("{}", String::from_utf8_lossy(&output.stderr).trim());
    }
    String::from_utf8(output.stdout).with_context(|| format!("the output of {program} is not UTF-8"))
}
