//! `package`: a scene as an FMU.

use super::{out_directory, shown};
use crate::package::{self, Stock, Version};
use crate::scenes::Scenario;
use anyhow::Result;
use clap::Args;
use std::path::{Path, PathBuf};

/// Packages a scene as an FMU.
#[derive(Args)]
pub struct Package {
    /// Scene: the name of a shipped one, or a .toml file
    #[arg(long, default_value = "wornpin", value_name = "NAME|FILE")]
    scene: String,
    /// The FMU to write [default: target/out/SCENE.fmu]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Leaves the library for newer processors out: the same bits on every machine, for up to a third more time
    #[arg(long)]
    portable: bool,
    /// Version of FMI
    #[arg(long, value_enum, default_value_t, value_name = "VERSION")]
    fmi: Version,
}

impl Package {
    /// Builds, packages, writes.
    pub fn execute(&self) -> Result<()> {
        let scenario = Scenario::find(&self.scene)?;
        let file = self.output.clone().unwrap_or_else(|| out_directory().join(format!("{}.fmu", scenario.name)));
        let stock = Stock::build()?;
        let stock = if self.portable { stock.portable() } else { stock };
        save(&stock.package_for(self.fmi, &scenario)?, &file)
    }
}

/// Builds, packages, writes, and says what came of it.
pub fn write(scenario: &Scenario, file: &Path) -> Result<()> {
    save(&package::Package::make(scenario)?, file)
}

fn save(package: &package::Package, file: &Path) -> Result<()> {
    package.save(file)?;
    let needs = package.glibc.as_ref().map(|version| format!(", needs glibc {version} or newer")).unwrap_or_default();
    println!("{} ({} kB{needs})", shown(file), package.bytes.len().div_ceil(1000));
    Ok(())
}
