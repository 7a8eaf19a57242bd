//! `variables.toml` as it is written, before anything is looked up.

use serde::Deserialize;
use std::collections::BTreeMap;
use toml::Spanned;
use toml::value::Datetime;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Raw {
    pub model: Model,
    pub capabilities: BTreeMap<String, Flag>,
    pub model_exchange: BTreeMap<String, Flag>,
    pub capabilities_fmi3: BTreeMap<String, Flag>,
    pub model_exchange_fmi3: BTreeMap<String, Flag>,
    pub terminal: Vec<Terminal>,
    pub experiment: Experiment,
    pub log: Vec<LogCategory>,
    pub unit: Vec<Unit>,
    #[serde(rename = "type")]
    pub types: Vec<RealType>,
    pub enumeration: Vec<Enumeration>,
    pub start_groups: BTreeMap<String, Vec<String>>,
    pub group: Vec<RawGroup>,
}

/// What the FMU is called.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Class name.
    pub name: String,
    /// Name of the binary; a C identifier.
    pub identifier: String,
    /// One line of explanation.
    pub description: String,
    /// Who made the model.
    pub author: String,
    /// Whose it is.
    pub copyright: String,
    /// SPDX expression.
    pub license: String,
    /// The day of the version: when a package says that it was made, unless its maker says otherwise.
    pub date: Datetime,
    /// What writes the package.
    pub generation_tool: String,
}

/// Value of a capability flag.
#[derive(Deserialize)]
#[serde(untagged)]
pub enum Flag {
    /// Can or cannot.
    Boolean(bool),
    /// How far.
    Order(u32),
}

/// Variables that are connected together.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Terminal {
    /// Name in the XML.
    pub name: String,
    /// One line of explanation.
    pub description: String,
    /// Its variables.
    pub members: Vec<TerminalMember>,
}

/// A variable of a terminal.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TerminalMember {
    /// Name of the variable.
    pub variable: Spanned<String>,
    /// Name that the other side knows it by.
    pub name: String,
    /// `signal`, or `inflow` for what sums to zero where terminals are connected.
    pub kind: String,
}

/// Default experiment.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// [s]
    pub start: f64,
    /// [s]
    pub stop: f64,
    /// Relative.
    pub tolerance: f64,
    /// [s] Communication step.
    pub step: f64,
}

/// A category of log messages.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogCategory {
    /// As the standard names it.
    pub name: String,
    /// One line of explanation.
    pub description: String,
}

/// A unit of the FMU's face.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Unit {
    /// Such as `N.m`.
    pub name: String,
    /// Exponents, where they are whole numbers.
    pub base: Option<BaseUnit>,
    /// Other units to show values in.
    #[serde(default)]
    pub display: Vec<DisplayUnit>,
}

/// Exponents of the SI base units.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
#[derive(Default)]
pub struct BaseUnit {
    /// Of the kilogram.
    pub kg: i32,
    /// Of the metre.
    pub m: i32,
    /// Of the second.
    pub s: i32,
    /// Of the radian.
    pub rad: i32,
}

/// A unit to show values in: shown = factor · value.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DisplayUnit {
    /// Such as `rpm`.
    pub name: String,
    /// Shown over SI.
    pub factor: f64,
}

/// A type of real variables.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RealType {
    /// Name in the XML.
    pub name: String,
    /// Physical quantity.
    pub quantity: String,
    /// SI unit.
    pub unit: String,
    /// Unit to show values in.
    pub display: Option<String>,
    /// One line of explanation.
    pub description: String,
}

/// An enumeration; a Rust `enum` of the same name is made from it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Enumeration {
    /// Name in the XML and in Rust.
    pub name: String,
    /// One line of explanation.
    pub description: String,
    /// Items in order of value.
    pub items: Vec<Item>,
}

/// An item of an enumeration.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Item {
    /// As scene files name it.
    pub name: String,
    /// As FMI calls name it.
    pub value: i32,
    /// One line of explanation.
    pub description: String,
    /// What programs may ask of it.
    #[serde(default)]
    pub properties: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawGroup {
    pub title: String,
    pub causality: String,
    pub variability: String,
    pub rows: Vec<Spanned<RawRow>>,
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawRow {
    pub name: String,
    #[serde(skip)]
    pub template: String,
    #[serde(default, rename = "for")]
    pub letters: Vec<String>,
    #[serde(rename = "type")]
    pub of_type: String,
    pub field: String,
    pub description: String,
    #[serde(skip)]
    pub meaning: String,
    pub start: Option<RawStart>,
    pub min: Option<f64>,
    pub max: Option<f64>,
    pub nominal: Option<f64>,
    #[serde(default)]
    pub unbounded: bool,
    pub depends: Option<Vec<String>>,
    pub at_start: Option<AtStart>,
}

#[derive(Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum RawStart {
    Boolean(bool),
    Number(f64),
    Item(String),
}

#[derive(Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum AtStart {
    Word(String),
    Of(Vec<String>),
}

impl RawRow {
    /// The row for each of its letters, or itself if it has none.
    pub fn expanded(&self) -> Vec<Self> {
        match self.letters[..] {
            [] => vec![self.filled("")],
            _ => self.letters.iter().map(|letter| self.filled(letter)).collect(),
        }
    }

    fn filled(&self, letter: &str) -> Self {
        let fill = |text: &String| text.replace("{J}", letter).replace("{j}", &letter.to_lowercase());
        let mut row = self.clone();
        row.template = self.name.clone();
        row.name = fill(&self.name);
        row.field = fill(&self.field);
        row.description = fill(&self.description);
        row.meaning = self.description.replace("{J}", "J");
        if let Some(AtStart::Of(names)) = &mut row.at_start {
            names.iter_mut().for_each(|name| *name = fill(name));
        }
        row
    }
}
