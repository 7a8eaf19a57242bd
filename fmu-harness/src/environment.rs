//! Python environments under `target/`, each made once from a pinned list of packages.

use crate::package::build::workspace;
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The interpreter of the environment `target/<name>` with the packages in the file `requirements`. It is made, or made
/// anew, when the list, the Python or the place has changed.
///
/// # Errors
/// Without Python 3.11, its `venv`, or the package index.
pub fn python(name: &str, requirements: &Path) -> Result<PathBuf> {
    let script = workspace().join("fmu-harness/src/environment.py");
    let mut command = Command::new("python3");
    command.arg(script).arg(workspace().join("target").join(name)).arg(requirements);
    let output = command.stdin(Stdio::null()).output().context("python3 cannot be started")?;
    if !output.status.success() {
        bail!("{}", String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().into())
}
