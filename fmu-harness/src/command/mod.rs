//! The subcommands.

mod accuracy;
mod campaign;
mod dynamics;
mod effects;
mod inspect;
mod laws;
mod package;
mod peers;
mod precision;
mod realtime;
mod report;
mod run;
mod sensitivity;
mod ssp;
mod sweep;
mod wear;

pub use accuracy::Accuracy;
pub use campaign::Campaign;
pub use dynamics::Dynamics;
pub use effects::Effects;
pub use inspect::Inspect;
pub use laws::Laws;
pub use package::Package;
pub use peers::Peers;
pub use precision::Precision;
pub use realtime::Realtime;
pub use report::Report;
pub use run::Run;
pub use sensitivity::Sensitivity;
pub use ssp::Ssp;
pub use sweep::Sweep;
pub use wear::Wear;

use crate::frame::ended;
use crate::package::build::workspace;
use crate::report::say::say;
use anyhow::{Context, Result};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// The default directory of results.
fn out_directory() -> PathBuf {
    workspace().join("target").join("out")
}

/// Writes the file `BASE.ENDING` and returns its path.
fn write(base: &Path, ending: &str, text: &str) -> Result<PathBuf> {
    let file = ended(base, ending);
    fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
    Ok(file)
}

/// A path relative to the working directory, if it is inside that directory.
fn shown(path: &Path) -> String {
    let relative = env::current_dir().ok().and_then(|here| path.strip_prefix(here).ok().map(Path::to_path_buf));
    relative.as_deref().unwrap_or(path).display().to_string()
}
