//! What it takes to build for another platform than the machine's own: found, or set up where that can be done.

use super::platform::Platform;
use crate::python::{Missing, environment};
use anyhow::{Context, Result, anyhow, bail, ensure};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs};

/// MinGW-w64's linker of libraries for Windows.
pub const MINGW: &str = "x86_64-w64-mingw32-gcc";
const MINGW_PACKAGE: &str = "gcc-mingw-w64-x86-64-win32";

/// The folder of cargo-zigbuild and of zig, which are Python packages.
///
/// # Errors
/// If they are missing and cannot be, or are not to be, installed; the text is one line.
pub fn zig(missing: Missing) -> Result<PathBuf> {
    let python = environment("zig", missing).map_err(|error| {
        let cause = format!("{error:#}");
        anyhow!("zig cannot be set up: {}", cause.lines().next().unwrap_or_default())
    })?;
    Ok(python.parent().unwrap_or(Path::new("")).into())
}

/// Sees to it that MinGW-w64's linker can be called.
///
/// # Errors
/// If it is not there and cannot be installed; the text says how to get it.
pub fn mingw() -> Result<()> {
    if answers(MINGW, &["--version"]) || (install(MINGW_PACKAGE) && answers(MINGW, &["--version"])) {
        return Ok(());
    }
    bail!("{MINGW} is missing, which links for Windows: on Debian `apt-get install {MINGW_PACKAGE}` installs it")
}

/// Sees to it that the compiler has Rust's standard library for a platform.
///
/// # Errors
/// If it is not there and cannot be installed; the text says how to get it.
pub fn standard_library(platform: Platform) -> Result<()> {
    let sysroot = sysroot()?;
    let lacks = |triple: &&&str| !sysroot.join("lib").join("rustlib").join(triple).join("lib").is_dir();
    let missing: Vec<&str> = platform.triples().iter().filter(lacks).copied().collect();
    if missing.is_empty() {
        return Ok(());
    }
    eprintln!("installing Rust's standard library for {}", missing.join(", "));
    let rustup = Command::new("rustup").args(["target", "add", "--quiet"]).args(&missing).stdin(Stdio::null()).output();
    let cause = match rustup {
        Ok(output) if output.status.success() => return Ok(()),
        Ok(output) => last_line(&output.stderr),
        Err(_) => "there is no rustup".into(),
    };
    let triples = missing.join(" ");
    bail!("Rust's standard library is missing; `rustup target add {triples}` installs it ({cause})")
}

/// Where the compiler's files are.
fn sysroot() -> Result<PathBuf> {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(&rustc).args(["--print", "sysroot"]).output().context("rustc cannot be started")?;
    ensure!(output.status.success(), "rustc does not tell its place: {}", last_line(&output.stderr));
    Ok(String::from_utf8_lossy(&output.stdout).trim().into())
}

/// Installs a package of Debian's as root; `false` where that cannot be done.
fn install(package: &str) -> bool {
    let is_root = fs::metadata("/proc/self").is_ok_and(|own| owner(&own) == Some(0));
    if !is_root || !answers("apt-get", &["--version"]) {
        return false;
    }
    eprintln!("installing {package}");
    answers("apt-get", &["install", "--yes", "--no-install-recommends", package])
        || (answers("apt-get", &["update"])
            && answers("apt-get", &["install", "--yes", "--no-install-recommends", package]))
}

/// User that a file belongs to, where files belong to users.
fn owner(file: &fs::Metadata) -> Option<u32> {
    #[cfg(unix)]
    return Some(std::os::unix::fs::MetadataExt::uid(file));
    #[cfg(not(unix))]
    return Some(file).and(None);
}

/// Whether a program is there and ends well.
fn answers(program: &str, arguments: &[&str]) -> bool {
    let mut command = Command::new(program);
    command.args(arguments).env("DEBIAN_FRONTEND", "noninteractive");
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// What a program said last.
fn last_line(said: &[u8]) -> String {
    String::from_utf8_lossy(said).trim().lines().last().unwrap_or_default().to_owned()
}

/// PATH with a folder before it.
pub fn path_with(folder: &Path) -> Result<OsString> {
    let path = env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(folder.to_path_buf()).chain(env::split_paths(&path));
    env::join_paths(folders).context("a folder's name cannot stand in PATH")
}
