//! Reads a `.fmu` file, a ZIP archive that follows FMI's rules. An archive that breaks a rule is refused.

use super::error::HostError;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use zip::{CompressionMethod, ZipArchive};

/// FMI 2.0's name of the platform that this program runs on.
pub const PLATFORM: &str = if cfg!(target_os = "windows") {
    if cfg!(target_pointer_width = "64") { "win64" } else { "win32" }
} else if cfg!(target_os = "macos") {
    "darwin64"
} else if cfg!(target_pointer_width = "64") {
    "linux64"
} else {
    "linux32"
};

/// An archive whose entries all follow FMI's rules.
pub struct Archive {
    file: PathBuf,
    zip: ZipArchive<File>,
}

impl Archive {
    /// Opens the file and checks every entry's name and method.
    pub fn open(file: &Path) -> Result<Self, HostError> {
        let opened = File::open(file).map_err(|cause| HostError::File { file: file.into(), cause })?;
        let zip = ZipArchive::new(opened).map_err(|error| torn(file, &error))?;
        let mut archive = Self { file: file.into(), zip };
        (0..archive.zip.len()).try_for_each(|index| archive.check(index))?;
        Ok(archive)
    }

    /// FMI 2.0.5 §2.3: names with forward slashes, entries stored or deflated, no links; and no name that leaves the
    /// archive.
    fn check(&mut self, index: usize) -> Result<(), HostError> {
        let entry = self.zip.by_index_raw(index).map_err(|error| torn(&self.file, &error))?;
        let name = entry.name().map_err(|error| torn(&self.file, &error))?.into_owned();
        let legal_method = matches!(entry.compression(), CompressionMethod::Stored | CompressionMethod::Deflated);
        let fault = if name.contains('\\') {
            "has a backslash in its name"
        } else if entry.enclosed_name().is_none() {
            "would be unpacked outside the archive's directory"
        } else if entry.is_symlink() {
            "is a symbolic link"
        } else if !legal_method {
            "is neither stored nor deflated"
        } else {
            return Ok(());
        };
        Err(HostError::Entry { file: self.file.clone(), entry: name, fault })
    }

    /// Names of all entries, in the archive's order.
    pub fn names(&self) -> Vec<String> {
        (0..self.zip.len()).filter_map(|index| Some(self.zip.name_for_index(index)?.ok()?.into_owned())).collect()
    }

    /// The platforms for which it has binaries.
    pub fn platforms(&self) -> Vec<String> {
        let mut platforms: Vec<String> = (self.names().iter())
            .filter_map(|name| name.strip_prefix("binaries/")?.split_once('/'))
            .map(|(platform, _)| platform.to_owned())
            .collect();
        platforms.sort();
        platforms.dedup();
        platforms
    }

    /// The text of an entry; `None` if there is no such entry or if it is not UTF-8 text.
    pub fn text(&mut self, name: &str) -> Option<String> {
        let mut text = String::new();
        self.zip.by_name(name).ok()?.read_to_string(&mut text).ok()?;
        Some(text)
    }

    /// The text of modelDescription.xml.
    pub fn description(&mut self) -> Result<String, HostError> {
        let Ok(mut entry) = self.zip.by_name("modelDescription.xml") else {
            return Err(HostError::NoDescription { file: self.file.clone() });
        };
        let mut text = String::new();
        entry.read_to_string(&mut text).map_err(|error| torn(&self.file, &error))?;
        Ok(text)
    }

    /// Unpacks every entry below `directory` and verifies its checksum.
    pub fn unpack(&mut self, directory: &Path) -> Result<(), HostError> {
        for index in 0..self.zip.len() {
            let mut entry = self.zip.by_index(index).map_err(|error| torn(&self.file, &error))?;
            let Some(name) = entry.enclosed_name() else { continue };
            let target = directory.join(name);
            if entry.is_dir() {
                fs::create_dir_all(&target)?;
                continue;
            }
            fs::create_dir_all(target.parent().unwrap_or(directory))?;
            let mut file = File::create(&target)?;
            io::copy(&mut entry, &mut file).map_err(|error| torn(&self.file, &error))?;
        }
        Ok(())
    }
}

/// An archive that cannot be read to its end.
fn torn(file: &Path, error: &dyn std::fmt::Display) -> HostError {
    HostError::Archive { file: file.into(), cause: error.to_string() }
}
