//! The contents of modelDescription.xml.

use super::error::HostError;
use super::parser::Parser;
use std::collections::HashMap;

/// The part of modelDescription.xml that a host needs.
#[derive(Clone, Debug, Default)]
pub struct Description {
    /// Attributes of the root element, such as `modelName`, `guid` and `generationTool`.
    pub model: Attributes,
    /// Attributes of the element CoSimulation, if there is one.
    pub co_simulation: Option<Attributes>,
    /// Whether the FMU has an interface for model exchange.
    pub model_exchange: bool,
    /// Attributes of DefaultExperiment.
    pub experiment: Attributes,
    /// Names of the units.
    pub units: Vec<String>,
    /// Attributes of BaseUnit by the unit's name, for units that have one.
    pub bases: HashMap<String, Attributes>,
    /// The simple types, by name.
    pub types: HashMap<String, SimpleType>,
    /// Names of the log categories.
    pub log_categories: Vec<String>,
    /// Every variable, in the order of the file.
    pub variables: Vec<Variable>,
    /// The lists of ModelStructure.
    pub structure: Structure,
}

/// Attributes of one element.
#[derive(Clone, Debug, Default)]
pub struct Attributes(pub(super) HashMap<String, String>);

/// A type that variables may refer to.
#[derive(Clone, Debug, Default)]
pub struct SimpleType {
    /// Attributes of its kind, such as unit and range.
    pub attributes: Attributes,
    /// Items of an enumeration: name and value.
    pub items: Vec<(String, i32)>,
}

/// The five types of FMI 2.0. A type of FMI 3.0 counts as the type of FMI 2.0 that it corresponds to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// fmi2Real.
    Real,
    /// fmi2Integer.
    Integer,
    /// fmi2Boolean.
    Boolean,
    /// fmi2String.
    String,
    /// An fmi2Integer whose values have names.
    Enumeration,
    /// A type that only FMI 3.0 has, or an array; this program does not read its values.
    Other,
}

/// One scalar variable.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Unique name.
    pub name: String,
    /// Its value reference.
    pub reference: u32,
    /// Its type.
    pub kind: Kind,
    /// Attributes of ScalarVariable: causality, variability, initial, description.
    pub attributes: Attributes,
    /// Attributes of the type's element: start, unit, min, max, declaredType.
    pub of_kind: Attributes,
}

/// The lists of ModelStructure. Variables are numbered from 1.
#[derive(Clone, Debug, Default)]
pub struct Structure {
    /// Outputs.
    pub outputs: Vec<Unknown>,
    /// Derivatives.
    pub derivatives: Vec<Unknown>,
    /// Initial unknowns, which can be read in initialization mode.
    pub initial_unknowns: Vec<Unknown>,
}

/// One entry of ModelStructure.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// The variable's number, from 1.
    pub index: usize,
    /// Numbers of the variables that it depends on; `None` if the file does not list them.
    pub dependencies: Option<Vec<usize>>,
}

impl Attributes {
    /// The text of an attribute.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(String::as_str)
    }

    /// The value of an attribute that is a number.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.get(name)?.trim().parse().ok()
    }

    /// All attributes, by name.
    pub fn sorted(&self) -> Vec<(&str, &str)> {
        let mut sorted: Vec<_> = self.0.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect();
        sorted.sort_unstable();
        sorted
    }

    /// Whether an attribute is present and true.
    pub fn flag(&self, name: &str) -> bool {
        matches!(self.get(name), Some("true" | "1"))
    }
}

impl Variable {
    /// Causality: `parameter`, `input`, `output`, `local`, …
    pub fn causality(&self) -> &str {
        self.attributes.get("causality").unwrap_or("local")
    }

    /// Variability: `constant`, `fixed`, `tunable`, `discrete` or `continuous`.
    pub fn variability(&self) -> &str {
        self.attributes.get("variability").unwrap_or("continuous")
    }
}

impl Description {
    /// Reads the text of modelDescription.xml.
    pub fn parse(xml: &str) -> Result<Self, HostError> {
        Parser::new(xml).run()
    }

    /// The version of FMI that it was made for.
    pub fn version(&self) -> &str {
        self.model.get("fmiVersion").unwrap_or("not given")
    }

    /// An entry of FMI 3.0's ModelStructure, which lists variables by value reference.
    pub(super) fn unknown_by_reference(&self, attributes: &Attributes) -> Option<Unknown> {
        let number = |reference: &str| {
            let reference: u32 = reference.parse().ok()?;
            Some(1 + self.variables.iter().position(|variable| variable.reference == reference)?)
        };
        let dependencies = attributes.get("dependencies");
        let dependencies = dependencies.map(|list| list.split_whitespace().filter_map(number).collect());
        Some(Unknown { index: number(attributes.get("valueReference")?)?, dependencies })
    }

    /// The model's name.
    pub fn name(&self) -> &str {
        self.model.get("modelName").unwrap_or_default()
    }

    /// The variable of this name. The error suggests a similar name.
    pub fn variable(&self, name: &str) -> Result<&Variable, HostError> {
        self.variables.iter().find(|variable| variable.name == name).ok_or_else(|| {
            let apart = |variable: &&Variable| distance(&variable.name, name);
            let similar = |variable: &&Variable| apart(variable) <= name.chars().count() / 3;
            let nearest = self.variables.iter().filter(similar).min_by_key(apart);
            HostError::Unknown { name: name.into(), nearest: nearest.map(|variable| variable.name.clone()) }
        })
    }

    /// Unit of the variable, or else of its type.
    pub fn unit<'a>(&'a self, variable: &'a Variable) -> Option<&'a str> {
        self.of_type(variable, "unit")
    }

    /// Display unit of the variable, or else of its type.
    pub fn display_unit<'a>(&'a self, variable: &'a Variable) -> Option<&'a str> {
        self.of_type(variable, "displayUnit")
    }

    /// Items of the enumeration that is the variable's type.
    pub fn items(&self, variable: &Variable) -> &[(String, i32)] {
        self.declared_type(variable).map_or(&[], |declared| &declared.items)
    }

    fn of_type<'a>(&'a self, variable: &'a Variable, attribute: &str) -> Option<&'a str> {
        let own = variable.of_kind.get(attribute);
        own.or_else(|| self.declared_type(variable)?.attributes.get(attribute))
    }

    fn declared_type(&self, variable: &Variable) -> Option<&SimpleType> {
        self.types.get(variable.of_kind.get("declaredType")?)
    }
}

/// Levenshtein distance: the number of letters to insert, delete or replace.
fn distance(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, letter) in from.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, other) in to.iter().enumerate() {
            let changed = diagonal + usize::from(letter != *other);
            diagonal = row[j + 1];
            row[j + 1] = changed.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[to.len()]
}
