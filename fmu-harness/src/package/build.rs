//! Builds the FMU's libraries with cargo. Their bytes do not depend on the folder they are built in.

use super::EPOCH;
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

/// The glibc that zig links for: that of CentOS 7, of 2014.
const OLD_GLIBC: &str = "2.17";

/// The compiler's name of this machine's platform.
const OWN_TRIPLE: &str = env!("TARGET_TRIPLE");

/// The workspace that this program was built from.
pub fn workspace() -> PathBuf {
    let harness = Path::new(env!("CARGO_MANIFEST_DIR"));
    harness.parent().unwrap_or(harness).into()
}

/// Calls cargo in the workspace: the cargo that runs this program, or the one on PATH.
pub fn cargo() -> Command {
    let mut command = Command::new(own_cargo());
    command.current_dir(workspace());
    command
}

fn own_cargo() -> OsString {
    env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// The program that links a library.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Linker {
    /// The machine's own linker.
    Own,
    /// zig, which links for old Linux and for other platforms. cargo-zigbuild, in this folder, calls it.
    Zig(PathBuf),
    /// MinGW-w64, which links for Windows.
    MinGw,
}

/// A library in its release form.
#[derive(Clone, Debug)]
pub struct Library {
    /// The platform that loads it.
    pub platform: Platform,
    /// The compiler's name of the platform and its processor.
    pub triple: &'static str,
    /// The level of processors that it needs, if it needs one; see [`dispatch_x86_64_v3`].
    pub level: Option<&'static str>,
    /// Its file.
    pub file: PathBuf,
}

/// The libraries of a platform that are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Levels {
    /// The library for every processor, and on x86-64 Linux the library for newer processors.
    All,
    /// Only the library for every processor.
    Portable,
}

/// The profile of a library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profile {
    /// As it is packaged.
    Release,
    /// Not optimised, for tests of its form.
    Unoptimised,
}

impl Profile {
    /// Its name for cargo.
    fn name(self) -> &'static str {
        match self {
            Self::Release => "fmu",
            Self::Unoptimised => "unoptimised",
        }
    }
}

/// Builds the libraries of this machine. On Linux zig links them for glibc 2.17 if it is installed, or if `zig` is
/// [`Missing::Make`] and it can be installed; otherwise the machine's own linker does. cargo prints to standard error.
pub fn for_this_machine(levels: Levels, zig: Missing) -> Result<Vec<Library>> {
    build(&[own_target(zig)?], levels, Profile::Release)
}

/// Builds the libraries of these platforms. The tools are set up first; if one is missing, nothing is built.
pub fn for_platforms(platforms: &[Platform], levels: Levels) -> Result<Vec<Library>> {
    in_profile(platforms, levels, Profile::Release)
}

/// As [`for_platforms`], in this profile.
pub fn in_profile(platforms: &[Platform], levels: Levels, profile: Profile) -> Result<Vec<Library>> {
    let targets: Result<Vec<Target>> = platforms
        .iter()
        .map(|platform| target(*platform).with_context(|| format!("no library for {}", platform.name())))
        .collect();
    build(&targets?, levels, profile)
}

/// Sets up the tools that build for a platform.
///
/// # Errors
/// If a tool is missing and cannot be installed; the text names it.
pub fn prepare(platform: Platform) -> Result<()> {
    target(platform).map(|_| ())
}

/// A platform to build for, and the linker.
struct Target {
    platform: Platform,
    triples: &'static [&'static str],
    linker: Linker,
}

/// Whether this machine runs a Linux for which zig can link.
fn has_glibc() -> bool {
    cfg!(all(target_os = "linux", target_env = "gnu", any(target_arch = "x86_64", target_arch = "aarch64")))
}

/// A platform with its linker. All tools are set up.
fn target(platform: Platform) -> Result<Target> {
    if Platform::here().is_ok_and(|own| own == platform) {
        return own_target(Missing::Make);
    }
    let linker = if platform == Platform::Win64 {
        tools::mingw()?;
        Linker::MinGw
    } else {
        Linker::Zig(tools::zig(Missing::Make)?)
    };
    tools::standard_library(platform)?;
    Ok(Target { platform, triples: platform.triples(), linker })
}

/// This machine's platform. If zig could not be installed, one line says what the library needs instead.
fn own_target(zig: Missing) -> Result<Target> {
    let platform = Platform::here()?;
    if platform == Platform::Darwin64 {
        tools::standard_library(platform)?;
        return Ok(Target { platform, triples: platform.triples(), linker: Linker::Own });
    }
    if !has_glibc() {
        return Ok(own_linker(platform));
    }
    match tools::zig(zig) {
        Ok(folder) => Ok(Target { platform, triples: platform.triples(), linker: Linker::Zig(folder) }),
        Err(error) => {
            if zig == Missing::Make {
                eprintln!("{error:#}; the library is linked for this machine's glibc and newer ones");
            }
            Ok(own_linker(platform))
        }
    }
}

fn own_linker(platform: Platform) -> Target {
    Target { platform, triples: &[OWN_TRIPLE], linker: Linker::Own }
}

/// Builds all libraries of all targets, as many at the same time as there are processors, but for those of one linker and
/// level.
fn build(targets: &[Target], levels: Levels, profile: Profile) -> Result<Vec<Library>> {
    let workspace = workspace();
    let manifest = workspace.join("Cargo.toml");
    ensure!(manifest.is_file(), "the source files are missing: there is no {}", manifest.display());
    let mut series: Vec<Series> = Vec::new();
    for target in targets {
        // Only on x86-64 Linux does the library for every processor look for one for newer processors.
        let has_newer = levels == Levels::All && target.platform == Platform::Linux64;
        let newer = has_newer.then_some(Some(dispatch_x86_64_v3::LEVEL));
        for level in [None].into_iter().chain(newer) {
            let products = target.triples.iter().map(|triple| (target.platform, *triple));
            match series.iter_mut().find(|series| series.linker == target.linker && series.level == level) {
                Some(series) => series.products.extend(products),
                None => {
                    series.push(Series { linker: target.linker.clone(), level, profile, products: products.collect() })
                }
            }
        }
    }
    let libraries: Result<Vec<Vec<Library>>> = series.par_iter().map(|series| series.run(&workspace)).collect();
    let mut libraries: Vec<Library> = libraries?.into_iter().flatten().collect();
    libraries.sort_by_key(|library| (library.platform, library.level));
    Ok(libraries)
}

/// Libraries of one linker and level, which are built one after the other in a directory of their own: no build replaces one
/// of another series or waits for it, and what runs on this machine is compiled once for all of them.
struct Series {
    linker: Linker,
    level: Option<&'static str>,
    profile: Profile,
    products: Vec<(Platform, &'static str)>,
}

impl Series {
    fn run(&self, workspace: &Path) -> Result<Vec<Library>> {
        self.products.iter().map(|(platform, triple)| self.library(workspace, *platform, triple)).collect()
    }

    /// Builds the library, for processors of the series' level if it has one. cargo makes a shared library of a Rust library
    /// for one target at a time.
    fn library(&self, workspace: &Path, platform: Platform, triple: &'static str) -> Result<Library> {
        let linker = match self.linker {
            Linker::Own => "",
            Linker::Zig(_) => "-zig",
            Linker::MinGw => "-mingw",
        };
        let level = self.level.map(|level| format!("-{level}")).unwrap_or_default();
        let directory = workspace.join("target").join(format!("library{linker}{level}"));
        let mut command = self.program(&directory)?;
        command
            .args(["--profile", self.profile.name(), "--lib", "--crate-type", "cdylib", "--package", "slidercrank"])
            .arg("--target-dir")
            .arg(&directory);
        // If a target is named, cargo keeps the flags from build scripts, which run here.
        command.arg("--target").arg(match (&self.linker, platform) {
            (Linker::Zig(_), Platform::Linux64 | Platform::LinuxAarch64) => format!("{triple}.{OLD_GLIBC}"),
            _ => triple.to_owned(),
        });
        let mut flags = remapped(workspace);
        flags.push(compact());
        if let Some(level) = self.level {
            flags.push(format!("\u{1f}-Ctarget-cpu={level}"));
        }
        command.env("SLIDERCRANK_SHARED_LIBRARY", "1");
        // The date of a package is no part of its libraries. zig would refuse to run if the date is invalid.
        command.env("CARGO_ENCODED_RUSTFLAGS", flags).env_remove("CARGO_BUILD_TARGET").env_remove(EPOCH);
        let status = command.stdin(Stdio::null()).status().context("cargo cannot be started")?;
        ensure!(status.success(), "cargo could not build the FMU's library for {triple} ({status})");
        let (prefix, suffix) = platform.affixes();
        let file = directory.join(triple).join(self.profile.name()).join(format!("{prefix}slidercrank{suffix}"));
        Ok(Library { platform, triple, level: self.level, file })
    }

    /// cargo or cargo-zigbuild, set up for the linker, for builds in a directory.
    fn program(&self, directory: &Path) -> Result<Command> {
        let mut command = match &self.linker {
            Linker::Own | Linker::MinGw => cargo(),
            Linker::Zig(folder) => {
                let mut command = Command::new(folder.join("cargo-zigbuild"));
                command.current_dir(workspace()).env("PATH", tools::path_with(folder)?).env("CARGO", own_cargo());
                let cache = workspace().join("target").join("zig-cache");
                command.env("ZIG_GLOBAL_CACHE_DIR", &cache).env("ZIG_LOCAL_CACHE_DIR", &cache);
                // It makes its wrappers there, and fails if another series makes the same ones at that moment.
                command.env("CARGO_ZIGBUILD_CACHE_DIR", directory.join("zigbuild"));
                command
            }
        };
        // The crate is a Rust library to the programs here; only this command makes it a shared library.
        command.arg("rustc");
        if self.linker == Linker::MinGw {
            command.env("CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER", tools::MINGW);
        }
        Ok(command)
    }
}

/// Flags that keep the library small, each behind the separator that cargo expects. Loops over states, modes and joints turn a few
/// times: copies of their bodies beyond what a short loop needs cost memory and, in the equations, time. Where cargo makes a shared
/// library of a Rust library, symbols are left in it, whatever the profile says.
fn compact() -> String {
    const FLAGS: [&str; 5] = [
        "strip=symbols",
        "llvm-args=--inline-threshold=150",
        "llvm-args=--unroll-threshold=100",
        "llvm-args=--unroll-runtime=false",
        "llvm-args=--force-vector-interleave=1",
    ];
    FLAGS.map(|flag| format!("\u{1f}-C{flag}")).concat()
}

/// Flags that replace this machine's paths in panic messages, with the separator that cargo expects between them.
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
