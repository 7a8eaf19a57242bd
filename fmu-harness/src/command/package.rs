//! `package`: packages a scene as an FMU.

use super::{out_directory, say, shown};
use crate::host::Setting;
use crate::package::build::Levels;
use crate::package::platform::Platform;
use crate::package::{self, Stock, Version};
use crate::scenes::Scenario;
use anyhow::Result;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Packages a scene as an FMU.
#[derive(Args)]
pub struct Package {
    /// Scene: the name of a shipped scene, or a .toml file
    #[arg(long, default_value = "wornpin", value_name = "NAME|FILE")]
    scene: String,
    /// Sets a parameter's start value in SI units or with a unit; may be repeated. Useful for hosts that cannot set
    /// every type of variable
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<Setting>,
    /// FMU file to write [default: target/out/SCENE.fmu]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Leave out the library for newer processors: the package is smaller and computes the same bits on every machine.
    /// `--set solver.portable=true` has the same bits with both libraries in the package
    #[arg(long)]
    portable: bool,
    /// Platforms of the FMU's libraries, separated by commas [default: this machine's platform]. FMI 2.0 has no name
    /// for Linux on ARM: the library for it is in a separate file, SCENE-linux-aarch64.fmu, which FMPy can load there
    #[arg(long, value_delimiter = ',', value_name = "PLATFORM")]
    platforms: Vec<Platform>,
    /// Libraries for all platforms
    #[arg(long, conflicts_with = "platforms")]
    all_platforms: bool,
    /// Version of FMI
    #[arg(long, value_enum, default_value_t, value_name = "VERSION")]
    fmi: Version,
}

impl Package {
    /// Builds the libraries and writes the packages.
    pub fn execute(&self) -> Result<()> {
        let scenario = Scenario::find(&self.scene)?.with(&self.set)?;
        let file = self.output.clone().unwrap_or_else(|| out_directory().join(format!("{}.fmu", scenario.name)));
        let mut packages = vec![];
        for (suffix, stock) in self.stocks()? {
            packages.push((with_suffix(&file, suffix), stock.package_for(self.fmi, &scenario)?));
        }
        packages.iter().try_for_each(|(file, package)| save(package, file))
    }

    /// The libraries for each file, with the suffix of the file's name.
    fn stocks(&self) -> Result<Vec<(&'static str, Stock)>> {
        let mut platforms =
            if self.all_platforms { Platform::value_variants().to_vec() } else { self.platforms.clone() };
        platforms.sort();
        platforms.dedup();
        let levels = if self.portable { Levels::Portable } else { Levels::All };
        if platforms.is_empty() {
            Ok(vec![("", Stock::build_for_old_linux(levels)?)])
        } else {
            Stock::build_for(self.fmi, &platforms, levels)
        }
    }
}

/// Adds a suffix to a file's name, before the extension.
fn with_suffix(file: &Path, suffix: &str) -> PathBuf {
    if suffix.is_empty() {
        return file.to_path_buf();
    }
    let mut name = file.file_stem().unwrap_or_default().to_owned();
    name.push(suffix);
    if let Some(extension) = file.extension() {
        name.push(".");
        name.push(extension);
    }
    file.with_file_name(name)
}

/// Builds the library, writes the package and prints its size and what it needs.
pub fn write(scenario: &Scenario, file: &Path) -> Result<()> {
    save(&package::Package::make(scenario)?, file)
}

fn save(package: &package::Package, file: &Path) -> Result<()> {
    package.save(file)?;
    let needs = package.glibc.as_ref().map(|version| format!(", needs glibc {version} or newer")).unwrap_or_default();
    let platforms: Vec<&str> = package.platforms.iter().map(|platform| platform.name()).collect();
    let size = package.bytes.len().div_ceil(1000);
    say(format!("{} ({size} kB, for {}{needs})", shown(file), platforms.join(", ")));
    Ok(())
}
