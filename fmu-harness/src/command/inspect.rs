//! `inspect`: what an FMU declares.

use super::say;
use crate::host::{Archive, Description};
use crate::inspect;
use anyhow::Result;
use clap::Args;
use std::path::PathBuf;

/// Prints what an FMU declares.
#[derive(Args)]
pub struct Inspect {
    /// The FMU file
    fmu: PathBuf,
}

impl Inspect {
    /// Prints the declaration. The FMU may be for another platform.
    pub fn execute(&self) -> Result<()> {
        let mut archive = Archive::open(&self.fmu)?;
        let description = Description::parse(&archive.description()?)?;
        let text = inspect::declared(&description, &archive.platforms(), &archive.names());
        say(text.trim_end());
        Ok(())
    }
}
