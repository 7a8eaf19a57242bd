//! `package`: a scene as an FMU.

use super::{out_directory, shown};
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
    /// Scene: the name of a shipped one, or a .toml file
    #[arg(long, default_value = "wornpin", value_name = "NAME|FILE")]
    scene: String,
    /// A parameter's start value, in SI units or with a unit; may be repeated. For hosts that cannot set every type
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<Setting>,
    /// The FMU to write [default: target/out/SCENE.fmu]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Leaves the library for newer processors out: a smaller package with the same bits on every machine, as
    /// `--set solver.portable=true` makes them too
    #[arg(long)]
    portable: bool,
    /// Platforms that the FMU has a library for, separated by commas [default: this machine's]. FMI 2.0 has no name for
    /// Linux on ARM: its library, for FMPy on such a machine, is in another file, SCENE-linux-aarch64.fmu
    #[arg(long, value_delimiter = ',', value_name = "PLATFORM")]
    platforms: Vec<Platform>,
    /// All of these platforms
    #[arg(long, conflicts_with = "platforms")]
    all_platforms: bool,
    /// Version of FMI
    #[arg(long, value_enum, default_value_t, value_name = "VERSION")]
    fmi: Version,
}

impl Package {
    /// Builds, packages, writes.
    pub fn execute(&self) -> Result<()> {
        let scenario = Scenario::find(&self.scene)?.with(&self.set)?;
        let file = self.output.clone().unwrap_or_else(|| out_directory().join(format!("{}.fmu", scenario.name)));
        let mut packages = vec![];
        for (ending, stock) in self.stocks()? {
            packages.push((ended(&file, ending), stock.package_for(self.fmi, &scenario)?));
        }
        packages.iter().try_for_each(|(file, package)| save(package, file))
    }

    /// What is packaged, and what the names of the files end in.
    fn stocks(&self) -> Result<Vec<(&'static str, Stock)>> {
        let mut platforms =
            if self.all_platforms { Platform::value_variants().to_vec() } else { self.platforms.clone() };
        platforms.sort();
        platforms.dedup();
        let levels = if self.portable { Levels::Portable } else { Levels::All };
        if platforms.is_empty() {
            Ok(vec![("", Stock::build_for_old_linux(levels)?)])
        } else {
            Stock::build_for(&platforms, levels)
        }
    }
}

/// The file whose name without its extension ends so.
fn ended(file: &Path, ending: &str) -> PathBuf {
    if ending.is_empty() {
        return file.to_path_buf();
    }
    let mut name = file.file_stem().unwrap_or_default().to_owned();
    name.push(ending);
    if let Some(extension) = file.extension() {
        name.push(".");
        name.push(extension);
    }
    file.with_file_name(name)
}

/// Builds, packages, writes, and says what came of it.
pub fn write(scenario: &Scenario, file: &Path) -> Result<()> {
    save(&package::Package::make(scenario)?, file)
}

fn save(package: &package::Package, file: &Path) -> Result<()> {
    package.save(file)?;
    let needs = package.glibc.as_ref().map(|version| format!(", needs glibc {version} or newer")).unwrap_or_default();
    let platforms: Vec<&str> = package.platforms.iter().map(|platform| platform.name()).collect();
    let size = package.bytes.len().div_ceil(1000);
    println!("{} ({size} kB, for {}{needs})", shown(file), platforms.join(", "));
    Ok(())
}
