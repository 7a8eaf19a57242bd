//! Finds or installs the tools that build for other platforms.

use super::platform::Platform;
use crate::python::{Missing, environment};
use anyhow::{Context, Result, anyhow, bail, ensure};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};
use std::{env, fs};

/// MinGW-w64's C compiler, which links libraries for Windows.
pub const MINGW: &str = "x86_64-w64-mingw32-gcc";
const MINGW_PACKAGE: &str = "gcc-mingw-w64-x86-64-win32";

/// One thread at a time looks for a tool and installs it: a half-installed tool looks like a whole one, and two installers
/// stand in each other's way.
static INSTALLING: Mutex<()> = Mutex::new(());

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

/// Installs MinGW-w64's linker if it is missing.
///
/// # Errors
/// If it cannot be installed; the text says how to install it by hand.
pub fn mingw() -> Result<()> {
    let _alone = INSTALLING.lock().unwrap_or_else(PoisonError::into_inner);
    if succeeds(MINGW, &["--version"]) || (install(MINGW_PACKAGE) && succeeds(MINGW, &["--version"])) {
        return Ok(());
    }
    bail!("the linker for Windows, {MINGW}, is missing: on Debian, install it with `apt-get install {MINGW_PACKAGE}`")
}

/// Installs Rust's standard library for a platform if it is missing.
///
/// # Errors
/// If it cannot be installed; the text says how to install it by hand.
pub fn standard_library(platform: Platform) -> Result<()> {
    let _alone = INSTALLING.lock().unwrap_or_else(PoisonError::into_inner);
    let sysroot = sysroot()?;
    let lacks = |triple: &&&str| !sysroot.join("lib").join("rustlib").join(triple).join("lib").is_dir();
    let missing: Vec<&str> = platform.triples().iter().filter(lacks).copied().collect();
    if missing.is_empty() {
        return Ok(());
    }
    eprintln!("installing Rust's standard library for {}", missing.join(", "));
    let rustup = Command::new("rustup").args(["--quiet", "target", "add"]).args(&missing).stdin(Stdio::null()).output();
    let cause = match rustup {
        Ok(output) if output.status.success() => return Ok(()),
        Ok(output) if output.stderr.is_empty() => format!("rustup ended with {}", output.status),
        Ok(output) => last_line(&output.stderr),
        Err(_) => "rustup is not installed".into(),
    };
    let triples = missing.join(" ");
    bail!("Rust's standard library for {triples} is missing: install it with `rustup target add {triples}` ({cause})")
}

/// The folder of the compiler's files.
fn sysroot() -> Result<PathBuf> {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(&rustc).args(["--print", "sysroot"]).output().context("rustc cannot be started")?;
    ensure!(output.status.success(), "`rustc --print sysroot` failed: {}", last_line(&output.stderr));
    Ok(String::from_utf8_lossy(&output.stdout).trim().into())
}

/// Installs a Debian package; `false` unless this program runs as root and apt-get succeeds.
fn install(package: &str) -> bool {
    let is_root = fs::metadata("/proc/self").is_ok_and(|own| owner(&own) == Some(0));
    if !is_root || !succeeds("apt-get", &["--version"]) {
        return false;
    }
    eprintln!("installing {package}");
    succeeds("apt-get", &["install", "--yes", "--no-install-recommends", package])
        || (succeeds("apt-get", &["update"])
            && succeeds("apt-get", &["install", "--yes", "--no-install-recommends", package]))
}

/// The user that owns a file; `None` on systems without such users.
fn owner(file: &fs::Metadata) -> Option<u32> {
    #[cfg(unix)]
    return Some(std::os::unix::fs::MetadataExt::uid(file));
    #[cfg(not(unix))]
    return Some(file).and(None);
}

/// Whether a program can be started and succeeds.
fn succeeds(program: &str, arguments: &[&str]) -> bool {
    let mut command = Command::new(program);
    command.args(arguments).env("DEBIAN_FRONTEND", "noninteractive");
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// The last line of a program's output.
fn last_line(output: &[u8]) -> String {
    String::from_utf8_lossy(output).trim().lines().last().unwrap_or_default().to_owned()
}

/// PATH with this folder put first.
pub fn path_with(folder: &Path) -> Result<OsString> {
    let path = env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(folder.to_path_buf()).chain(env::split_paths(&path));
    env::join_paths(folders).context("PATH cannot contain this folder's name")
}
