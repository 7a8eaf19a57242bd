//! `package`: a scene as an FMU.

use super::{out_directory, shown};
use crate::package;
use crate::scenes::Scenario;
use anyhow::Result;
use clap::Args;
use std::path::PathBuf;

/// Packages a scene as an FMU.
#[derive(Args)]
pub struct Package {
    /// Scene: the name of a shipped one, or a .toml file
    #[arg(long, default_value = "wornpin", value_name = "NAME|FILE")]
    scene: String,
    /// The FMU to write [default: target/out/SCENE.fmu]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

impl Package {
    /// Builds, packages, writes.
    pub fn execute(&self) -> Result<()> {
        let scenario = Scenario::find(&self.scene)?;
        let file = self.output.clone().unwrap_or_else(|| out_directory().join(format!("{}.fmu", scenario.name)));
        write(&scenario, &file)
    }
}

/// Builds, packages, writes, and says what came of it.
pub fn write(scenario: &Scenario, file: &std::path::Path) -> Result<()> {
    let package = package::Package::make(scenario)?;
    package.save(file)?;
    let needs = package.glibc.as_ref().map(|version| format!(", needs glibc {version} or newer")).unwrap_or_default();
    println!("{} ({} kB{needs})", shown(file), package.bytes.len().div_ceil(1000));
    Ok(())
}
