//! Controller and sheet as FMUs. PythonFMU makes them, and this program packages them, so that their bytes are
//! reproducible.

use crate::package::archive::{self, Part};
use crate::python::{output, script};
use anyhow::{Context, Result};
use std::fs;
use std::path::{Path, PathBuf};

/// An FMU of the SSP package, in addition to the press.
pub struct Companion {
    /// Name of the file.
    pub file: String,
    /// Bytes of the file.
    pub bytes: Vec<u8>,
}

/// Controller and sheet, sorted by name. The interpreter `python` has PythonFMU.
pub fn companions(python: &Path) -> Result<Vec<Companion>> {
    let folder = tempfile::tempdir()?;
    output(script(python, "press/companions.py").arg(folder.path())).context("controller and sheet cannot be made")?;
    let unpacked = entries(folder.path())?;
    unpacked
        .into_iter()
        .map(|place| Ok(Companion { file: format!("{}.fmu", name(&place)), bytes: pack(&place)? }))
        .collect()
}

/// Packages the files of an FMU, sorted by name.
fn pack(place: &Path) -> Result<Vec<u8>> {
    let (mut open, mut parts) = (vec![place.to_path_buf()], vec![]);
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(entries(&path)?);
        } else {
            let inside: Vec<String> =
                path.strip_prefix(place)?.iter().map(|step| step.to_string_lossy().into()).collect();
            parts.push(Part::new(inside.join("/"), fs::read(&path)?));
        }
    }
    parts.sort_by(|one, other| one.name.cmp(&other.name));
    archive::write(&parts)
}

/// The entries of a folder, sorted.
fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    let read = || fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>();
    let mut paths = read().with_context(|| format!("cannot read {}", folder.display()))?;
    paths.sort();
    Ok(paths)
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
