//! The FMU's library, built by cargo so that its bytes do not tell where it was built.

use anyhow::{Context, Result, ensure};
use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The old Linux that zig links for: CentOS 7's.
const OLD_LINUX: &str = "x86_64-unknown-linux-gnu";
const OLD_GLIBC: &str = "2.17";

/// The workspace that this program was built from.
pub fn workspace() -> PathBuf {
    let harness = Path::new(env!("CARGO_MANIFEST_DIR"));
    harness.parent().unwrap_or(harness).into()
}

/// The cargo to call: the one that runs this program, or the one on PATH.
pub fn cargo() -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(workspace());
    command
}

/// Builds the library in its release form and returns its path. cargo's own words go to standard error.
pub fn library() -> Result<PathBuf> {
    let workspace = workspace();
    let manifest = workspace.join("Cargo.toml");
    ensure!(manifest.is_file(), "the sources are gone: no {}", manifest.display());
    let target = workspace.join("target").join("library");
    let zig = zig_is_here();

    let mut command = cargo();
    command.arg(if zig { "zigbuild" } else { "build" });
    command.args(["--profile", "fmu", "--lib", "--package", "slidercrank", "--target-dir"]).arg(&target);
    if zig {
        command.arg("--target").arg(format!("{OLD_LINUX}.{OLD_GLIBC}"));
    }
    command.env("CARGO_ENCODED_RUSTFLAGS", remapped(&workspace)).env_remove("CARGO_BUILD_TARGET");
    let status = command.stdin(Stdio::null()).status().context("cargo cannot be started")?;
    ensure!(status.success(), "cargo could not build the FMU's library ({status})");

    let directory = if zig { target.join(OLD_LINUX) } else { target }.join("fmu");
    let (prefix, suffix) = (env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
    Ok(directory.join(format!("{prefix}slidercrank{suffix}")))
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

/// Whether cargo-zigbuild and zig, itself or as a Python package, can be called on a machine that they are wanted on.
fn zig_is_here() -> bool {
    let answers = |program: &str, arguments: &[&str]| {
        let mut command = Command::new(program);
        command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    };
    cfg!(all(target_os = "linux", target_arch = "x86_64", target_env = "gnu"))
        && answers("cargo-zigbuild", &["--version"])
        && (answers("zig", &["version"]) || answers("python3", &["-m", "ziglang", "version"]))
}
