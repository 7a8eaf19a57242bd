//! Writes components, connections and parameter values as SystemStructure.ssd of SSP 1.0.

use super::Wire;
use crate::host::Attributes;
use anyhow::{Context, Result};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use std::collections::{BTreeMap, HashMap};
use std::io;

const NAMESPACES: [(&str, &str); 3] = [
    ("xmlns:ssc", "http://ssp-standard.org/SSP1/SystemStructureCommon"),
    ("xmlns:ssd", "http://ssp-standard.org/SSP1/SystemStructureDescription"),
    ("xmlns:ssv", "http://ssp-standard.org/SSP1/SystemStructureParameterValues"),
];
const VERSION: &str = "1.0";

type Xml = Writer<Vec<u8>>;
/// Units by name, each with the attributes of its BaseUnit.
type Units<'a> = BTreeMap<&'a str, &'a Attributes>;

/// A system of components.
pub struct Structure<'a> {
    /// Its name.
    pub name: &'a str,
    /// One-line description.
    pub description: &'a str,
    /// Name of the set of parameter values.
    pub values: &'a str,
    /// Its components.
    pub components: Vec<Component>,
    /// Connections between components.
    pub wires: &'a [Wire],
    /// [s] End of the default experiment, which starts at 0.
    pub stop: f64,
}

/// An FMU in the package.
pub struct Component {
    /// Unique in the system.
    pub name: &'static str,
    /// Path in the package.
    pub source: String,
    /// Its inputs and outputs.
    pub connectors: Vec<Connector>,
    /// Its parameter values.
    pub values: Vec<Value>,
    /// Attributes of BaseUnit of every unit that it declares.
    pub bases: HashMap<String, Attributes>,
}

/// A real input or output.
pub struct Connector {
    /// The variable's name.
    pub name: String,
    /// `input` or `output`.
    pub kind: String,
    /// Its unit.
    pub unit: Option<String>,
}

/// The value of a real parameter.
pub struct Value {
    /// The variable's name.
    pub name: String,
    /// Value in SI units.
    pub value: f64,
    /// Its unit.
    pub unit: Option<String>,
}

impl Structure<'_> {
    /// The text of the file.
    pub fn xml(&self) -> Result<String> {
        let connectors = self.components.iter().flat_map(|component| &component.connectors);
        let units = self.units(connectors.map(|connector| &connector.unit))?;
        let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
        xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        let root = xml.create_element("ssd:SystemStructureDescription").with_attributes(NAMESPACES);
        let root = root.with_attributes([("version", VERSION), ("name", self.name), ("description", self.description)]);
        // The standard's schema fixes the order: system, units, experiment.
        root.write_inner_content(|xml| {
            let system = xml.create_element("ssd:System").with_attribute(("name", self.name));
            system.write_inner_content(|xml| self.system(xml))?;
            write_units(xml, "ssd:Units", &units)?;
            let stop = self.stop.to_string();
            let experiment = xml.create_element("ssd:DefaultExperiment");
            experiment.with_attributes([("startTime", "0"), ("stopTime", stop.as_str())]).write_empty()?;
            Ok(())
        })?;
        let mut bytes = xml.into_inner();
        bytes.push(b'\n');
        Ok(String::from_utf8(bytes)?)
    }

    /// The units of these names.
    fn units<'a>(&'a self, names: impl Iterator<Item = &'a Option<String>>) -> Result<Units<'a>> {
        names.flatten().map(|name| Ok((name.as_str(), self.base(name)?))).collect()
    }

    /// BaseUnit of a unit, as the components declare it.
    fn base(&self, unit: &str) -> Result<&Attributes> {
        let found = self.components.iter().find_map(|component| component.bases.get(unit));
        found.with_context(|| format!("no component declares the unit `{unit}`"))
    }

    fn system(&self, xml: &mut Xml) -> io::Result<()> {
        xml.create_element("ssd:Elements").write_inner_content(|xml| {
            self.components.iter().try_for_each(|component| self.component(xml, component))
        })?;
        xml.create_element("ssd:Connections")
            .write_inner_content(|xml| self.wires.iter().try_for_each(|wire| connection(xml, wire)))?;
        Ok(())
    }

    fn component(&self, xml: &mut Xml, component: &Component) -> io::Result<()> {
        let element = xml.create_element("ssd:Component").with_attributes([
            ("name", component.name),
            ("type", "application/x-fmu-sharedlibrary"),
            ("source", &component.source),
            ("implementation", "CoSimulation"),
        ]);
        element.write_inner_content(|xml| {
            xml.create_element("ssd:Connectors")
                .write_inner_content(|xml| component.connectors.iter().try_for_each(|own| connector(xml, own)))?;
            if !component.values.is_empty() {
                xml.create_element("ssd:ParameterBindings")
                    .write_inner_content(|xml| self.binding(xml, &component.values))?;
            }
            Ok(())
        })?;
        Ok(())
    }

    fn binding(&self, xml: &mut Xml, values: &[Value]) -> io::Result<()> {
        xml.create_element("ssd:ParameterBinding").write_inner_content(|xml| {
            xml.create_element("ssd:ParameterValues").write_inner_content(|xml| self.parameter_set(xml, values))?;
            Ok(())
        })?;
        Ok(())
    }

    fn parameter_set(&self, xml: &mut Xml, values: &[Value]) -> io::Result<()> {
        let units = self.units(values.iter().map(|value| &value.unit)).map_err(io::Error::other)?;
        let set = xml.create_element("ssv:ParameterSet").with_attributes([("version", VERSION), ("name", self.values)]);
        set.write_inner_content(|xml| {
            xml.create_element("ssv:Parameters")
                .write_inner_content(|xml| values.iter().try_for_each(|value| parameter(xml, value)))?;
            write_units(xml, "ssv:Units", &units)
        })?;
        Ok(())
    }
}

fn connector(xml: &mut Xml, Connector { name, kind, unit }: &Connector) -> io::Result<()> {
    let element = xml.create_element("ssd:Connector").with_attributes([("name", name.as_str()), ("kind", kind)]);
    element.write_inner_content(|xml| real(xml, "ssc:Real", None, unit.as_deref()))?;
    Ok(())
}

fn parameter(xml: &mut Xml, Value { name, value, unit }: &Value) -> io::Result<()> {
    let element = xml.create_element("ssv:Parameter").with_attribute(("name", name.as_str()));
    element.write_inner_content(|xml| real(xml, "ssv:Real", Some(*value), unit.as_deref()))?;
    Ok(())
}

/// A real with its value and its unit, if there are any.
fn real(xml: &mut Xml, name: &str, value: Option<f64>, unit: Option<&str>) -> io::Result<()> {
    let value = value.map(|value| value.to_string());
    let attributes = [("value", value.as_deref()), ("unit", unit)];
    let given = attributes.into_iter().filter_map(|(name, text)| Some((name, text?)));
    xml.create_element(name).with_attributes(given).write_empty()?;
    Ok(())
}

fn connection(xml: &mut Xml, [start, end]: &Wire) -> io::Result<()> {
    let element = xml.create_element("ssd:Connection").with_attributes([
        ("startElement", start.0),
        ("startConnector", start.1),
        ("endElement", end.0),
        ("endConnector", end.1),
    ]);
    element.write_empty()?;
    Ok(())
}

fn write_units(xml: &mut Xml, element: &str, units: &Units) -> io::Result<()> {
    if units.is_empty() {
        return Ok(());
    }
    xml.create_element(element).write_inner_content(|xml| {
        units.iter().try_for_each(|(name, base)| {
            xml.create_element("ssc:Unit").with_attribute(("name", *name)).write_inner_content(|xml| {
                xml.create_element("ssc:BaseUnit").with_attributes(base.sorted()).write_empty()?;
                Ok(())
            })?;
            Ok(())
        })
    })?;
    Ok(())
}
