//! The platforms that a package can have a library for.

use anyhow::{Result, bail};
use clap::ValueEnum;
use std::env::consts::{ARCH, OS};

/// An operating system and its processors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Platform {
    /// Linux on x86-64 processors
    Linux64,
    /// Windows on x86-64 processors
    Win64,
    /// macOS on x86-64 and on ARM processors
    Darwin64,
    /// Linux on 64-bit ARM processors; with FMI 2.0 in a separate file
    LinuxAarch64,
}

impl Platform {
    /// The platform of this program.
    ///
    /// # Errors
    /// If packages cannot have a library for this platform.
    pub fn here() -> Result<Self> {
        match (OS, ARCH) {
            ("linux", "x86_64") => Ok(Self::Linux64),
            ("linux", "aarch64") => Ok(Self::LinuxAarch64),
            ("windows", "x86_64") => Ok(Self::Win64),
            ("macos", "x86_64" | "aarch64") => Ok(Self::Darwin64),
            (os, arch) => bail!("FMUs cannot have a library for {os} on {arch}"),
        }
    }

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linux64 => "linux64",
            Self::Win64 => "win64",
            Self::Darwin64 => "darwin64",
            Self::LinuxAarch64 => "linux-aarch64",
        }
    }

    /// The compiler's name of the platform with each of its processors.
    pub fn triples(self) -> &'static [&'static str] {
        match self {
            Self::Linux64 => &["x86_64-unknown-linux-gnu"],
            Self::Win64 => &["x86_64-pc-windows-gnu"],
            Self::Darwin64 => &["x86_64-apple-darwin", "aarch64-apple-darwin"],
            Self::LinuxAarch64 => &["aarch64-unknown-linux-gnu"],
        }
    }

    /// Prefix and suffix of the file name of a library.
    pub fn affixes(self) -> (&'static str, &'static str) {
        match self {
            Self::Linux64 | Self::LinuxAarch64 => ("lib", ".so"),
            Self::Win64 => ("", ".dll"),
            Self::Darwin64 => ("lib", ".dylib"),
        }
    }
}
