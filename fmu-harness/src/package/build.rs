//! The FMU's libraries, built by cargo so that their bytes do not tell where they were built.

use super::platform::Platform;
use super::tools;
use crate::python::Missing;
use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use slidercrank::fmi::abi::dispatch_x86_64_v3;
use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The old Linux that zig links for: CentOS 7's.
const OLD_GLIBC: &str = "2.17";

/// This machine's own platform, as the compiler calls it.
const OWN_TRIPLE: &str = env!("TARGET_TRIPLE");

/// The workspace that this program was built from.
pub fn workspace() -> PathBuf {
    let harness = Path::new(env!("CARGO_MANIFEST_DIR"));
    harness.parent().unwrap_or(harness).into()
}

/// The cargo to call: the one that runs this program, or the one on PATH.
pub fn cargo() -> Command {
    let mut command = Command::new(own_cargo());
    command.current_dir(workspace());
    command
}

fn own_cargo() -> OsString {
    env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// What links a library.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Linker {
    /// The machine's own.
    Own,
    /// zig, called by cargo-zigbuild in this folder: for an old Linux, and for other platforms.
    Zig(PathBuf),
    /// MinGW-w64, for Windows.
    MinGw,
}

/// A library in its release form.
#[derive(Clone, Debug)]
pub struct Library {
    /// Where it runs.
    pub platform: Platform,
    /// The compiler's name of the processors that it is for.
    pub triple: &'static str,
    /// The level of processors that it needs, if it needs one; see [`dispatch_x86_64_v3`].
    pub level: Option<&'static str>,
    /// Its file.
    pub file: PathBuf,
}

/// Which libraries of a platform are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Levels {
    /// That for every processor, and that for newer ones where the platform has levels of them.
    All,
    /// That for every processor alone.
    Portable,
}

/// Builds the libraries of this machine with the machine's own linker. cargo's own words go to standard error.
pub fn own(levels: Levels) -> Result<Vec<Library>> {
    build(&[own_target(Platform::here()?)], levels)
}

/// Builds the libraries of this machine, on Linux for an old one if zig is there already.
pub fn own_for_old_linux_if_ready(levels: Levels) -> Result<Vec<Library>> {
    let zig = if links_for_old_linux() { tools::zig(Missing::Refuse).ok() } else { None };
    match zig {
        Some(zig) => build(&[zig_target(Platform::here()?, zig)], levels),
        None => own(levels),
    }
}

/// Builds the libraries of these platforms. What that takes is set up before; nothing is built if something is missing.
pub fn of(platforms: &[Platform], levels: Levels) -> Result<Vec<Library>> {
    let targets: Result<Vec<Target>> = platforms
        .iter()
        .map(|platform| target(*platform).with_context(|| format!("no library for {}", platform.name())))
        .collect();
    build(&targets?, levels)
}

/// Sets up what it takes to build for a platform.
///
/// # Errors
/// If something is missing and cannot be installed; the text says what.
pub fn prepare(platform: Platform) -> Result<()> {
    target(platform).map(|_| ())
}

/// One platform to build for.
struct Target {
    platform: Platform,
    triples: &'static [&'static str],
    linker: Linker,
}

/// Whether this is a Linux on which zig makes libraries that older ones load, too.
fn links_for_old_linux() -> bool {
    cfg!(all(target_os = "linux", target_env = "gnu", any(target_arch = "x86_64", target_arch = "aarch64")))
}

/// With everything that it takes. On Linux the machine's own platform does without zig where zig cannot be had.
fn target(platform: Platform) -> Result<Target> {
    let is_own = Platform::here().is_ok_and(|own| own == platform);
    if is_own && platform == Platform::Darwin64 {
        tools::standard_library(platform)?;
        return Ok(Target { platform, triples: platform.triples(), linker: Linker::Own });
    }
    if is_own && !links_for_old_linux() {
        return Ok(own_target(platform));
    }
    if platform == Platform::Win64 {
        tools::mingw()?;
        tools::standard_library(platform)?;
        return Ok(Target { platform, triples: platform.triples(), linker: Linker::MinGw });
    }
    match tools::zig(Missing::Make) {
        Ok(zig) => {
            tools::standard_library(platform)?;
            Ok(zig_target(platform, zig))
        }
        Err(error) if is_own => {
            eprintln!("{error:#}\n{} is linked for this machine's Linux and newer ones instead", platform.name());
            Ok(own_target(platform))
        }
        Err(error) => Err(error),
    }
}

fn own_target(platform: Platform) -> Target {
    Target { platform, triples: &[OWN_TRIPLE], linker: Linker::Own }
}

fn zig_target(platform: Platform, zig: PathBuf) -> Target {
    Target { platform, triples: platform.triples(), linker: Linker::Zig(zig) }
}

/// Builds all libraries of all targets. Those that one call of cargo can build are built by one; as many calls run at a time
/// as there are processors.
fn build(targets: &[Target], levels: Levels) -> Result<Vec<Library>> {
    let workspace = workspace();
    let manifest = workspace.join("Cargo.toml");
    ensure!(manifest.is_file(), "the sources are gone: no {}", manifest.display());
    let mut calls: Vec<Call> = Vec::new();
    for target in targets {
        // The level is that of Linux on x86-64 alone, whose library for every processor looks for the other one.
        let has_newer = levels == Levels::All && target.platform == Platform::Linux64;
        let newer = has_newer.then_some(Some(dispatch_x86_64_v3::LEVEL));
        for level in [None].into_iter().chain(newer) {
            let products = target.triples.iter().map(|triple| (target.platform, *triple));
            match calls.iter_mut().find(|call| call.linker == target.linker && call.level == level) {
                Some(call) => call.products.extend(products),
                None => calls.push(Call { linker: target.linker.clone(), level, products: products.collect() }),
            }
        }
    }
    let libraries: Result<Vec<Vec<Library>>> = calls.par_iter().map(|call| call.run(&workspace)).collect();
    let mut libraries: Vec<Library> = libraries?.into_iter().flatten().collect();
    libraries.sort_by_key(|library| (library.platform, library.level));
    Ok(libraries)
}

/// One call of cargo.
struct Call {
    linker: Linker,
    level: Option<&'static str>,
    products: Vec<(Platform, &'static str)>,
}

impl Call {
    /// Builds, for the processors of a level alone if the call has one.
    fn run(&self, workspace: &Path) -> Result<Vec<Library>> {
        let mut command = self.program()?;
        let linker = match self.linker {
            Linker::Own => "",
            Linker::Zig(_) => "-zig",
            Linker::MinGw => "-mingw",
        };
        let level = self.level.map(|level| format!("-{level}")).unwrap_or_default();
        // Each linker and level has a directory: cargo does not build anew for another linker.
        let directory = workspace.join("target").join(format!("library{linker}{level}"));
        command.args(["--profile", "fmu", "--lib", "--package", "slidercrank", "--target-dir"]).arg(&directory);
        for (platform, triple) in &self.products {
            // With a target, flags are not for what runs here.
            command.arg("--target").arg(match (&self.linker, platform) {
                (Linker::Zig(_), Platform::Linux64 | Platform::LinuxAarch64) => format!("{triple}.{OLD_GLIBC}"),
                _ => (*triple).to_owned(),
            });
        }
        let mut flags = remapped(workspace);
        if let Some(level) = self.level {
            flags.push(format!("\u{1f}-Ctarget-cpu={level}"));
        }
        command.env("CARGO_ENCODED_RUSTFLAGS", flags).env_remove("CARGO_BUILD_TARGET");
        let status = command.stdin(Stdio::null()).status().context("cargo cannot be started")?;
        ensure!(status.success(), "cargo could not build the FMU's library ({status})");
        let library = |&(platform, triple): &(Platform, &'static str)| {
            let (prefix, suffix) = platform.affixes();
            let file = directory.join(triple).join("fmu").join(format!("{prefix}slidercrank{suffix}"));
            Library { platform, triple, level: self.level, file }
        };
        Ok(self.products.iter().map(library).collect())
    }

    /// cargo, as the linker needs it.
    fn program(&self) -> Result<Command> {
        let mut command = match &self.linker {
            Linker::Own | Linker::MinGw => cargo(),
            Linker::Zig(folder) => {
                let mut command = Command::new(folder.join("cargo-zigbuild"));
                command.current_dir(workspace()).env("PATH", tools::path_with(folder)?).env("CARGO", own_cargo());
                let cache = workspace().join("target").join("zig-cache");
                for variable in ["CARGO_ZIGBUILD_CACHE_DIR", "ZIG_GLOBAL_CACHE_DIR", "ZIG_LOCAL_CACHE_DIR"] {
                    command.env(variable, &cache);
                }
                command
            }
        };
        command.arg(if matches!(self.linker, Linker::Zig(_)) { "zigbuild" } else { "build" });
        if self.linker == Linker::MinGw {
            command.env("CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER", tools::MINGW);
        }
        Ok(command)
    }
}

/// Flags that replace this machine's paths in panic messages, separated as cargo wants it.
fn remapped(workspace: &Path) -> OsString {
    let home = env::home_dir().unwrap_or_default();
    let cargo_home = env::var_os("CARGO_HOME").map_or_else(|| home.join(".cargo"), PathBuf::from);
    let mut flags = OsString::new();
    for (place, name) in [(cargo_home.as_path(), "/cargo"), (workspace, "/slidercrank")] {
        if !flags.is_empty() {
            flags.push("\u{1f}");
        }
        flags.push("--remap-path-prefix=");
        flags.push(place);
        flags.push("=");
        flags.push(name);
    }
    flags
}
