//! The FMU's library, built by cargo so that its bytes do not tell where it was built.

use anyhow::{Context, Result, ensure};
use slidercrank::fmi::v2::abi::dispatch_x86_64_v3;
use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

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

/// The library in its release form.
pub struct Libraries {
    /// For every processor of this platform.
    pub every: PathBuf,
    /// For newer ones, where the platform has levels of them; see [`dispatch_x86_64_v3`].
    pub newer: Option<PathBuf>,
}

/// Builds the libraries, side by side. cargo's own words go to standard error.
pub fn libraries() -> Result<Libraries> {
    let workspace = workspace();
    let manifest = workspace.join("Cargo.toml");
    ensure!(manifest.is_file(), "the sources are gone: no {}", manifest.display());
    let zig = zig_is_here();
    let levels = cfg!(all(target_os = "linux", target_arch = "x86_64"));
    let every = Build::start(&workspace, zig, None)?;
    let newer = levels.then(|| Build::start(&workspace, zig, Some(dispatch_x86_64_v3::LEVEL))).transpose();
    let every = every.finish();
    let newer = newer?.map(Build::finish).transpose();
    Ok(Libraries { every: every?, newer: newer? })
}

/// cargo at work.
struct Build {
    cargo: Child,
    library: PathBuf,
}

impl Build {
    /// Starts it, for the processors of a `level` alone if one is told.
    fn start(workspace: &Path, zig: bool, level: Option<&str>) -> Result<Self> {
        let suffix = level.map(|level| format!("-{level}")).unwrap_or_default();
        let target = workspace.join("target").join(format!("library{suffix}"));
        let triple = if zig { OLD_LINUX } else { env!("TARGET_TRIPLE") };
        let mut command = cargo();
        command.arg(if zig { "zigbuild" } else { "build" });
        command.args(["--profile", "fmu", "--lib", "--package", "slidercrank", "--target-dir"]).arg(&target);
        // With a target, flags are not for what runs here.
        command.arg("--target").arg(if zig { format!("{triple}.{OLD_GLIBC}") } else { triple.into() });
        let mut flags = remapped(workspace);
        if let Some(level) = level {
            flags.push(format!("\u{1f}-Ctarget-cpu={level}"));
        }
        command.env("CARGO_ENCODED_RUSTFLAGS", flags).env_remove("CARGO_BUILD_TARGET");
        let cargo = command.stdin(Stdio::null()).spawn().context("cargo cannot be started")?;
        let (prefix, suffix) = (env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
        let library = target.join(triple).join("fmu").join(format!("{prefix}slidercrank{suffix}"));
        Ok(Self { cargo, library })
    }

    /// Waits for it.
    fn finish(mut self) -> Result<PathBuf> {
        let status = self.cargo.wait().context("cargo was lost")?;
        ensure!(status.success(), "cargo could not build the FMU's library ({status})");
        Ok(self.library)
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
