//! The shipped scenes and other scene files. A scene is a mechanism with its loads and its run.

use crate::host::Setting;
use crate::package::build::workspace;
use anyhow::{Context, Result, bail};
use slidercrank::scene::parameter::{Kind, Parameter};
use slidercrank::scene::read::{SceneFile, read};
use slidercrank::scene::units::{UnitError, quantity};
use slidercrank::scene::write::{write, write_table};
use std::fs;
use std::path::{Path, PathBuf};

/// A scene that has been read.
pub struct Scenario {
    /// Name of the file without its extension.
    pub name: String,
    /// Text of the file.
    pub text: String,
    /// Contents of the file.
    pub file: SceneFile,
}

impl Scenario {
    /// Reads the shipped scene of this name, or the file at this path.
    pub fn find(name_or_file: &str) -> Result<Self> {
        let file = file(name_or_file)?;
        let shown = file.display().to_string();
        let text = fs::read_to_string(&file).with_context(|| format!("cannot read {shown}"))?;
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let file = read(&text, &shown)?;
        Ok(Self { name, text, file })
    }

    /// The scene with other values of some parameters. If a name occurs twice, the last value counts. The text is then
    /// the complete scene in SI units.
    ///
    /// # Errors
    /// If a parameter does not exist, or if a value or the combination of values is not allowed.
    pub fn with(mut self, settings: &[Setting]) -> Result<Self> {
        if settings.is_empty() {
            return Ok(self);
        }
        for Setting { name, value } in settings {
            let parameter = Parameter::named(name).with_context(|| format!("there is no parameter `{name}`"))?;
            let number = understood(parameter, value)
                .with_context(|| format!("{name} = {value} is not allowed: {}", parameter.allowed()))?;
            parameter.write(&mut self.file.scene, number)?;
        }
        let told: Vec<String> = settings.iter().map(|Setting { name, value }| format!("{name} = {value}")).collect();
        self.file.description = format!("{}; with {}", self.file.description, told.join(", "));
        self.text = write(&self.file);
        // Reading the text checks the combination of values.
        self.file = read(&self.text, &self.name)?;
        Ok(self)
    }

    /// All that the scene is read from, by name: the text of the file, and the rod's table of modes, wherever it stands.
    pub fn texts(&self) -> Vec<(String, String)> {
        let modes = self.file.scene.rod.flexible.table.as_ref().map(|table| ("modes".into(), write_table(table)));
        [("scene".into(), self.text.clone())].into_iter().chain(modes).collect()
    }
}

/// Reads a parameter's value: a number in SI units or with a unit, a truth value, or an item by its name or number.
fn understood(parameter: &Parameter, text: &str) -> Result<f64> {
    let found = match parameter.kind {
        Kind::Real { unit, .. } => return Ok(number(text, unit)?),
        Kind::Integer { .. } => text.parse().ok().map(|number: i32| f64::from(number)),
        Kind::Boolean { .. } => match text {
            "true" | "1" => Some(1.0),
            "false" | "0" => Some(0.0),
            _ => None,
        },
        Kind::Enumeration { items, .. } => {
            let is_meant = |(name, value): &&(&str, i32)| *name == text || value.to_string() == text;
            items.iter().find(is_meant).map(|(_, value)| f64::from(*value))
        }
    };
    found.context("none of these")
}

/// A number in SI units, or a text with a unit that measures the same as `unit`.
///
/// # Errors
/// If it is neither.
pub fn number(text: &str, unit: &str) -> Result<f64, UnitError> {
    text.parse().or_else(|_| quantity(text, unit))
}

/// File of the shipped scene of this name, or the file at this path.
pub fn file(name_or_file: &str) -> Result<PathBuf> {
    if name_or_file.ends_with(".toml") { Ok(name_or_file.into()) } else { shipped(name_or_file) }
}

/// The file of a shipped scene.
fn shipped(name: &str) -> Result<PathBuf> {
    let directory = directory();
    let file = directory.join(format!("{name}.toml"));
    if file.is_file() {
        return Ok(file);
    }
    let shipped = [names(&directory), ladder(), contests()].concat().join(", ");
    bail!(
        "there is no scene `{name}`; the shipped scenes are {shipped}; a scene of your own is a file whose name ends in .toml"
    )
}

/// The folder of the shipped scenes.
pub fn directory() -> PathBuf {
    workspace().join("fmu-harness").join("scenes")
}

/// Names of the scenes of `effects`. Each has one effect more than the scene before.
pub fn ladder() -> Vec<String> {
    names(&directory().join("effects")).into_iter().map(|name| format!("effects/{name}")).collect()
}

/// Names of the scenes that `peers` runs with other programs.
pub fn contests() -> Vec<String> {
    names(&directory().join("peers")).into_iter().map(|name| format!("peers/{name}")).collect()
}

/// Names of the scenes in a directory, sorted.
pub fn names(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).into_iter().flatten().flatten();
    let scene = |path: PathBuf| (path.extension()? == "toml").then(|| Some(path.file_stem()?.to_str()?.to_owned()))?;
    let mut names: Vec<String> = entries.filter_map(|entry| scene(entry.path())).collect();
    names.sort();
    names
}
