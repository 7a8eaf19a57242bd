//! Reads modelDescription.xml into a `Description` in one pass.

use super::description::{Attributes, Description, Kind, SimpleType, Unknown, Variable};
use super::error::HostError;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;
use std::collections::HashMap;

/// Reads the XML in one pass and keeps the names of the open elements on a stack.
pub struct Parser<'a> {
    reader: Reader<&'a [u8]>,
    path: Vec<String>,
    found: Description,
    /// Name of the simple type being read.
    open_type: String,
    /// Attributes of the scalar variable being read, until the element of its type follows.
    open_variable: Attributes,
}

impl<'a> Parser<'a> {
    /// A parser at the start of `xml`.
    pub fn new(xml: &'a str) -> Self {
        let reader = Reader::from_str(xml.trim_start_matches('\u{feff}'));
        let (path, open_type) = (Vec::new(), String::new());
        Self { reader, path, found: Description::default(), open_type, open_variable: Attributes::default() }
    }

    /// Reads the document to its end.
    pub fn run(mut self) -> Result<Description, HostError> {
        loop {
            match self.reader.read_event().map_err(|error| self.fault(error.to_string()))? {
                Event::Start(element) => {
                    let name = self.element(&element)?;
                    self.path.push(name);
                }
                Event::Empty(element) => {
                    self.element(&element)?;
                }
                Event::End(_) => {
                    self.path.pop();
                }
                Event::Eof => break,
                _ => {}
            }
        }
        match self.path.last() {
            Some(open) => Err(self.fault(format!("the file ends inside <{open}>"))),
            None if self.found.model.0.is_empty() => Err(self.fault("there is no <fmiModelDescription>".into())),
            None => Ok(self.found),
        }
    }

    fn fault(&self, fault: String) -> HostError {
        HostError::Description { position: self.reader.buffer_position(), fault }
    }

    /// Reads one element, depending on the elements around it.
    fn element(&mut self, element: &BytesStart<'_>) -> Result<String, HostError> {
        let name = element.local_name().as_ref().to_owned();
        let attributes = self.attributes(element)?;
        let path: Vec<&str> = self.path.iter().skip(1).map(String::as_str).collect();
        match (path.as_slice(), name.as_str()) {
            ([], "fmiModelDescription") => self.found.model = attributes,
            ([], "CoSimulation") => self.found.co_simulation = Some(attributes),
            ([], "ModelExchange") => self.found.model_exchange = true,
            ([], "DefaultExperiment") => self.found.experiment = attributes,
            (["UnitDefinitions"], "Unit") => self.found.units.extend(attributes.get("name").map(str::to_owned)),
            (["UnitDefinitions", "Unit"], "BaseUnit") => {
                self.found.bases.extend(self.found.units.last().map(|unit| (unit.clone(), attributes)));
            }
            (["LogCategories"], "Category") => {
                self.found.log_categories.extend(attributes.get("name").map(str::to_owned));
            }
            (["TypeDefinitions"], "SimpleType") => {
                self.open_type = attributes.get("name").unwrap_or_default().into();
                self.found.types.insert(self.open_type.clone(), SimpleType::default());
            }
            (["TypeDefinitions", "SimpleType"], _) => {
                self.found.types.entry(self.open_type.clone()).or_default().attributes = attributes;
            }
            (["TypeDefinitions", "SimpleType", "Enumeration"], "Item") => self.item(&attributes),
            (["ModelVariables"], "ScalarVariable") => self.open_variable = attributes,
            (["ModelVariables", "ScalarVariable"], _) => self.variable(&name, attributes)?,
            // FMI 3.0 has one element for each type and variable.
            (["TypeDefinitions"], _) => {
                self.open_type = attributes.get("name").unwrap_or_default().into();
                self.found.types.insert(self.open_type.clone(), SimpleType { attributes, items: vec![] });
            }
            (["TypeDefinitions", "EnumerationType"], "Item") => self.item(&attributes),
            (["ModelVariables"], _) => {
                self.open_variable = attributes.clone();
                self.variable(&name, attributes)?;
            }
            (["ModelVariables", _], "Dimension") => {
                self.found.variables.last_mut().into_iter().for_each(|array| array.kind = Kind::Other);
            }
            (["ModelStructure"], "Output" | "ContinuousStateDerivative" | "InitialUnknown") => {
                let unknown = self.found.unknown_by_reference(&attributes);
                let list = match name.as_str() {
                    "Output" => &mut self.found.structure.outputs,
                    "ContinuousStateDerivative" => &mut self.found.structure.derivatives,
                    _ => &mut self.found.structure.initial_unknowns,
                };
                list.extend(unknown);
            }
            (["ModelStructure", list], "Unknown") => {
                let list = match *list {
                    "Outputs" => &mut self.found.structure.outputs,
                    "Derivatives" => &mut self.found.structure.derivatives,
                    _ => &mut self.found.structure.initial_unknowns,
                };
                list.extend(unknown(&attributes));
            }
            _ => {}
        }
        Ok(name)
    }

    fn attributes(&self, element: &BytesStart<'_>) -> Result<Attributes, HostError> {
        let mut found = HashMap::new();
        for attribute in element.attributes() {
            let attribute = attribute.map_err(|error| self.fault(error.to_string()))?;
            let name = attribute.key.as_ref().to_owned();
            let value =
                attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|error| self.fault(error.to_string()))?;
            found.insert(name, value.into_owned());
        }
        Ok(Attributes(found))
    }

    /// Reads an item of the current enumeration.
    fn item(&mut self, attributes: &Attributes) {
        let value = attributes.get("value").and_then(|value| value.parse().ok());
        let item = attributes.get("name").map(str::to_owned).zip(value);
        self.found.types.entry(self.open_type.clone()).or_default().items.extend(item);
    }

    /// Reads the element of a variable's type, which completes the variable.
    fn variable(&mut self, kind: &str, of_kind: Attributes) -> Result<(), HostError> {
        let kind = match kind {
            "Real" | "Float64" => Kind::Real,
            "Integer" | "Int32" => Kind::Integer,
            "Boolean" => Kind::Boolean,
            "String" => Kind::String,
            "Enumeration" => Kind::Enumeration,
            "Float32" | "Int8" | "UInt8" | "Int16" | "UInt16" | "UInt32" | "Int64" | "UInt64" | "Binary" | "Clock" => {
                Kind::Other
            }
            _ => return Ok(()), // Annotations are ignored.
        };
        let attributes = std::mem::take(&mut self.open_variable);
        let name = attributes.get("name").ok_or_else(|| self.fault("a variable without a name".into()))?.to_owned();
        let reference = attributes.get("valueReference").and_then(|reference| reference.parse().ok());
        let reference = reference.ok_or_else(|| self.fault(format!("`{name}` has no valueReference")))?;
        self.found.variables.push(Variable { name, reference, kind, attributes, of_kind });
        Ok(())
    }
}

/// An entry of ModelStructure; `None` if it names no variable.
fn unknown(attributes: &Attributes) -> Option<Unknown> {
    let dependencies = attributes.get("dependencies");
    let dependencies =
        dependencies.map(|list| list.split_whitespace().filter_map(|index| index.parse().ok()).collect());
    Some(Unknown { index: attributes.get("index")?.parse().ok()?, dependencies })
}
