//! Writes a ZIP archive. The same parts give the same bytes on every machine and every day.

use anyhow::{Context, Result};
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// One file of the archive.
pub struct Part {
    /// Path with forward slashes.
    pub name: String,
    /// Content.
    pub bytes: Vec<u8>,
}

impl Part {
    /// A file of this name with these bytes.
    pub fn new(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self { name: name.into(), bytes: bytes.into() }
    }
}

/// Writes the parts in their order: deflated, dated 1980-01-01, readable by all users and not executable.
pub fn write(parts: &[Part]) -> Result<Vec<u8>> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(9))
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for Part { name, bytes } in parts {
        zip.start_file(name.as_str(), options).with_context(|| format!("cannot start the entry `{name}`"))?;
        zip.write_all(bytes).with_context(|| format!("cannot write `{name}`"))?;
    }
    Ok(zip.finish()?.into_inner())
}
