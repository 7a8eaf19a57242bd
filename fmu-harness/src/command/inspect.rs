//! `inspect`: what an FMU declares.

use crate::host::{Archive, Description};
use crate::inspect;
use anyhow::Result;
use clap::Args;
use std::io::Write;
use std::path::PathBuf;

/// Prints what an FMU declares.
#[derive(Args)]
pub struct Inspect {
    /// The FMU
    fmu: PathBuf,
}

impl Inspect {
    /// Prints; an FMU for another platform will do.
    pub fn execute(&self) -> Result<()> {
        let mut archive = Archive::open(&self.fmu)?;
        let description = Description::parse(&archive.description()?)?;
        let text = inspect::declared(&description, &archive.platforms(), &archive.names());
        // A reader that has seen enough closes the pipe; that is no failure.
        let _ = std::io::stdout().lock().write_all(text.as_bytes());
        Ok(())
    }
}
