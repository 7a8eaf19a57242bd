//! Rows → `modelDescription.xml`.

use super::clocks::Clock;
use super::definitions::{type_definitions, unit_definition};
use super::element::{Attributes, Xml, date, leaf, leaves, parent};
use super::exchange::{self, Exchange, Local};
use super::rows::{Declaration, Experiment, Flag, Kind, Role, Row};
use super::structure::Numbering;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use std::collections::BTreeMap;
use std::io;

/// What differs from one package to the next.
pub struct Package<'a> {
    /// Fingerprint that the binary checks.
    pub guid: &'a str,
    /// Start values of the parameters, in order; an enumeration's by its item's value, a Boolean's as
    /// 0 or 1.
    pub starts: &'a [f64],
    /// Model exchange, where the scene's equations can be handed to another integrator.
    pub exchange: Option<&'a Exchange>,
    /// The clocks, which FMI 2.0 does not know.
    pub clocks: &'a [Clock],
    /// Default experiment.
    pub experiment: Experiment,
    /// When it was made, as [`made`] tells it; none leaves the date out.
    pub made: Option<&'a str>,
}

impl<'a> Package<'a> {
    /// A package with no guid and the declared experiment: the text that a guid is made from.
    pub fn anonymous(declaration: &Declaration, starts: &'a [f64]) -> Self {
        Self { guid: "", starts, exchange: None, clocks: &[], experiment: declaration.experiment, made: None }
    }
}

/// When a package was made: so many seconds after 1970 if they are told, else on the day of the version.
pub fn made(declaration: &Declaration, seconds: Option<u64>) -> String {
    seconds.map_or_else(|| declaration.model.date.to_string(), date)
}

/// The model description of a package.
pub fn write(declaration: &Declaration, package: &Package) -> io::Result<String> {
    let mut xml = begin()?;
    let mut root = root(declaration, package, "2.0", "guid");
    let indicators = package.exchange.map(|exchange| exchange.indicators.len().to_string());
    root.extend(indicators.map(|count| ("numberOfEventIndicators", count)));
    let numbering = Numbering::by_place(declaration, package.exchange);
    parent(&mut xml, "fmiModelDescription", root, |xml| {
        if package.exchange.is_some() {
            leaf(xml, "ModelExchange", capabilities(declaration, &declaration.model_exchange))?;
        }
        leaf(xml, "CoSimulation", capabilities(declaration, &declaration.capabilities))?;
        parent(xml, "UnitDefinitions", vec![], |xml| {
            declaration.units.iter().try_for_each(|unit| unit_definition(xml, unit))
        })?;
        parent(xml, "TypeDefinitions", vec![], |xml| type_definitions(xml, declaration))?;
        log_categories(xml, declaration)?;
        leaf(xml, "DefaultExperiment", experiment(&package.experiment))?;
        parent(xml, "ModelVariables", vec![], |xml| {
            rows_with_starts(declaration, package)
                .try_for_each(|(reference, row, start)| variable(xml, declaration, reference, row, start))?;
            let locals = package.exchange.map(|exchange| exchange::states(declaration, exchange, numbering));
            locals.unwrap_or_default().into_iter().try_for_each(|Local { general, real, .. }| {
                parent(xml, "ScalarVariable", general, |xml| leaf(xml, "Real", real))
            })
        })?;
        parent(xml, "ModelStructure", vec![], |xml| {
            parent(xml, "Outputs", vec![], |xml| leaves(xml, "Unknown", numbering.outputs(declaration)))?;
            // The schema takes no list without entries: an ideal mechanism at a prescribed speed has no states.
            if let Some(exchange) = package.exchange.filter(|exchange| !exchange.states.is_empty()) {
                let derivatives = exchange::derivatives(declaration, exchange, numbering);
                parent(xml, "Derivatives", vec![], |xml| leaves(xml, "Unknown", derivatives))?;
            }
            parent(xml, "InitialUnknowns", vec![], |xml| {
                leaves(xml, "Unknown", numbering.initial_outputs(declaration))?;
                let states = package.exchange.map(|exchange| exchange::initial_unknowns(exchange, numbering));
                leaves(xml, "Unknown", states.unwrap_or_default())
            })
        })
    })?;
    text(xml)
}

/// A document with nothing in it yet.
pub(super) fn begin() -> io::Result<Xml> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    Ok(xml)
}

/// What has been written.
pub(super) fn text(xml: Xml) -> io::Result<String> {
    let mut bytes = xml.into_inner();
    bytes.push(b'\n');
    String::from_utf8(bytes).map_err(io::Error::other)
}

/// The description's own attributes in a version of FMI, which has its own name for the guid.
pub(super) fn root(
    declaration: &Declaration,
    package: &Package,
    version: &str,
    guid: &'static str,
) -> Attributes<'static> {
    let model = &declaration.model;
    let mut attributes = vec![
        ("fmiVersion", version.into()),
        ("modelName", model.name.clone()),
        (guid, package.guid.into()),
        ("description", model.description.clone()),
        ("author", model.author.clone()),
        ("version", env!("CARGO_PKG_VERSION").into()),
        ("copyright", model.copyright.clone()),
        ("license", model.license.clone()),
        ("generationTool", format!("{} {}", model.generation_tool, env!("CARGO_PKG_VERSION"))),
    ];
    attributes.extend(package.made.map(|made| ("generationDateAndTime", made.into())));
    attributes.push(("variableNamingConvention", "structured".into()));
    attributes
}

/// What the FMU can, after the name of its library.
pub(super) fn capabilities<'a>(declaration: &'a Declaration, flags: &'a BTreeMap<String, Flag>) -> Attributes<'a> {
    let value = |flag: &Flag| match flag {
        Flag::Boolean(can) => can.to_string(),
        Flag::Order(order) => order.to_string(),
    };
    let mut attributes = vec![("modelIdentifier", declaration.model.identifier.clone())];
    attributes.extend(flags.iter().map(|(name, flag)| (name.as_str(), value(flag))));
    attributes
}

pub(super) fn log_categories(xml: &mut Xml, declaration: &Declaration) -> io::Result<()> {
    parent(xml, "LogCategories", vec![], |xml| {
        declaration.log.iter().try_for_each(|category| {
            let (name, description) = (category.name.clone(), category.description.clone());
            leaf(xml, "Category", vec![("name", name), ("description", description)])
        })
    })
}

/// Every row with its value reference, and with its start value if it has one.
pub(super) fn rows_with_starts<'a>(
    declaration: &'a Declaration,
    package: &Package<'a>,
) -> impl Iterator<Item = (usize, &'a Row, Option<f64>)> {
    let mut starts = package.starts.iter().copied();
    declaration.rows.iter().enumerate().map(move |(reference, row)| {
        let start = match row.role {
            Role::Input { start } => Some(start),
            Role::Output { .. } => None,
            Role::Parameter { start } => Some(starts.next().unwrap_or(start)),
        };
        (reference, row, start)
    })
}

pub(super) fn experiment(experiment: &Experiment) -> Attributes<'static> {
    let Experiment { start, stop, tolerance, step } = *experiment;
    let number = |value: f64| format!("{value:?}");
    vec![
        ("startTime", number(start)),
        ("stopTime", number(stop)),
        ("tolerance", number(tolerance)),
        ("stepSize", number(step)),
    ]
}

fn variable(
    xml: &mut Xml,
    declaration: &Declaration,
    reference: usize,
    row: &Row,
    start: Option<f64>,
) -> io::Result<()> {
    parent(xml, "ScalarVariable", general(reference, row), |xml| {
        let (name, attributes) = type_and_range(declaration, &row.kind, start);
        leaf(xml, name, attributes)
    })
}

/// The attributes that variables of all types have.
pub(super) fn general(reference: usize, row: &Row) -> Attributes<'static> {
    let (causality, variability, initial) = match row.role {
        Role::Input { .. } => ("input", "continuous", None),
        Role::Output { continuous: true, .. } => ("output", "continuous", Some("calculated")),
        Role::Output { .. } => ("output", "discrete", Some("calculated")),
        Role::Parameter { .. } => ("parameter", "fixed", Some("exact")),
    };
    let mut attributes = vec![
        ("name", row.name.clone()),
        ("valueReference", reference.to_string()),
        ("description", row.description.clone()),
        ("causality", causality.into()),
        ("variability", variability.into()),
    ];
    // The standard forbids `initial` for inputs.
    attributes.extend(initial.map(|initial| ("initial", initial.into())));
    attributes
}

/// The element that tells a variable's type. The unit stands here as well as in the declared type:
/// some hosts look no further than the variable.
pub(super) fn type_and_range<'a>(
    declaration: &'a Declaration,
    kind: &Kind,
    start: Option<f64>,
) -> (&'a str, Attributes<'a>) {
    let number = |value: f64| format!("{value:?}");
    let mut attributes: Attributes = vec![];
    let name = match kind {
        Kind::Real { of, min, max, nominal, unbounded } => {
            let of = &declaration.types[*of];
            attributes.push(("declaredType", of.name.clone()));
            attributes.push(("unit", of.unit.clone()));
            attributes.extend(of.display.clone().map(|display| ("displayUnit", display)));
            attributes.extend(min.map(|min| ("min", number(min))));
            attributes.extend(max.map(|max| ("max", number(max))));
            attributes.extend(nominal.map(|nominal| ("nominal", number(nominal))));
            attributes.extend(unbounded.then(|| ("unbounded", "true".into())));
            attributes.extend(start.map(|start| ("start", number(start))));
            "Real"
        }
        Kind::Integer { min, max } => {
            attributes.extend(min.map(|min| ("min", min.to_string())));
            attributes.extend(max.map(|max| ("max", max.to_string())));
            attributes.extend(start.map(|start| ("start", start.to_string())));
            "Integer"
        }
        Kind::Boolean => {
            attributes.extend(start.map(|start| ("start", (start != 0.0).to_string())));
            "Boolean"
        }
        Kind::Enumeration { of } => {
            attributes.push(("declaredType", declaration.enumerations[*of].name.clone()));
            attributes.extend(start.map(|start| ("start", start.to_string())));
            "Enumeration"
        }
    };
    (name, attributes)
}
