//! Rows → `modelDescription.xml` of FMI 3.0.
//!
//! Value references are those of FMI 2.0. Behind them is that of the independent variable, which FMI 2.0 does not declare.

use super::arrays::{CORNERS, CornerArray, corner_arrays};
use super::clocks::Clock;
use super::definitions::unit_definition;
use super::element::{Xml, leaf, leaves, parent};
use super::exchange::{self, Local};
use super::rows::{Declaration, Kind, Role, Row};
use super::structure::Numbering;
use super::xml::{
    Package, begin, capabilities, experiment, general, log_categories, root, rows_with_starts, text, type_and_range,
};
use std::io;

/// The model description of a package.
pub fn write(declaration: &Declaration, package: &Package) -> io::Result<String> {
    let mut xml = begin()?;
    let (exchange, numbering) = (package.exchange, Numbering::by_reference(package.exchange));
    parent(&mut xml, "fmiModelDescription", root(declaration, package, "3.0", "instantiationToken"), |xml| {
        if exchange.is_some() {
            leaf(xml, "ModelExchange", capabilities(declaration, &declaration.model_exchange_fmi3))?;
        }
        leaf(xml, "CoSimulation", capabilities(declaration, &declaration.capabilities_fmi3))?;
        parent(xml, "UnitDefinitions", vec![], |xml| {
            declaration.units.iter().try_for_each(|unit| unit_definition(xml, unit))
        })?;
        parent(xml, "TypeDefinitions", vec![], |xml| type_definitions(xml, declaration))?;
        log_categories(xml, declaration)?;
        leaf(xml, "DefaultExperiment", experiment(&package.experiment))?;
        parent(xml, "ModelVariables", vec![], |xml| {
            independent(xml, declaration.rows.len())?;
            rows_with_starts(declaration, package)
                .try_for_each(|(reference, row, start)| variable(xml, declaration, reference, row, start))?;
            let states = exchange.map(|exchange| exchange::states(declaration, exchange, numbering));
            let indicators = exchange.map(exchange::indicators);
            let locals = states.into_iter().chain(indicators).flatten();
            let locals = locals.map(|Local { general, real, .. }| [general, real].concat());
            leaves(xml, "Float64", locals.collect())?;
            for CornerArray { of_type, attributes } in corner_arrays() {
                parent(xml, of_type, attributes, |xml| leaf(xml, "Dimension", vec![("start", CORNERS.to_string())]))?;
            }
            leaves(xml, "Clock", package.clocks.iter().map(Clock::variable).collect())
        })?;
        parent(xml, "ModelStructure", vec![], |xml| {
            leaves(xml, "Output", numbering.outputs(declaration))?;
            leaves(xml, "Output", package.clocks.iter().map(|clock| clock.output(numbering)).collect())?;
            let derivatives = exchange.map(|exchange| exchange::derivatives(declaration, exchange, numbering));
            leaves(xml, "ContinuousStateDerivative", derivatives.unwrap_or_default())?;
            leaves(xml, "InitialUnknown", numbering.initial_outputs(declaration))?;
            let clocks = package.clocks.iter().map(|clock| clock.initial_unknown(numbering));
            leaves(xml, "InitialUnknown", clocks.collect())?;
            let states = exchange.map(|exchange| exchange::initial_unknowns(exchange, numbering));
            leaves(xml, "InitialUnknown", states.unwrap_or_default())?;
            let indicators = exchange.map(exchange::indicators).unwrap_or_default().into_iter();
            let indicators = indicators.map(|Local { reference, .. }| numbering.unknown(reference as usize, None));
            leaves(xml, "EventIndicator", indicators.collect())
        })
    })?;
    text(xml)
}

/// Every type of reals and every enumeration.
fn type_definitions(xml: &mut Xml, declaration: &Declaration) -> io::Result<()> {
    for real in &declaration.types {
        let mut attributes = vec![
            ("name", real.name.clone()),
            ("description", real.description.clone()),
            ("quantity", real.quantity.clone()),
            ("unit", real.unit.clone()),
        ];
        attributes.extend(real.display.clone().map(|display| ("displayUnit", display)));
        leaf(xml, "Float64Type", attributes)?;
    }
    for enumeration in &declaration.enumerations {
        let (name, description) = (enumeration.name.clone(), enumeration.description.clone());
        parent(xml, "EnumerationType", vec![("name", name), ("description", description)], |xml| {
            enumeration.items.iter().try_for_each(|item| {
                let (name, description) = (item.name.clone(), item.description.clone());
                let value = item.value.to_string();
                leaf(xml, "Item", vec![("name", name), ("value", value), ("description", description)])
            })
        })?;
    }
    Ok(())
}

/// The time.
fn independent(xml: &mut Xml, reference: usize) -> io::Result<()> {
    let attributes = [
        ("name", "time"),
        ("valueReference", &reference.to_string()),
        ("description", "Simulation time"),
        ("causality", "independent"),
        ("variability", "continuous"),
        ("unit", "s"),
    ];
    leaf(xml, "Float64", attributes.map(|(name, value)| (name, value.to_owned())).to_vec())
}

fn variable(
    xml: &mut Xml,
    declaration: &Declaration,
    reference: usize,
    row: &Row,
    start: Option<f64>,
) -> io::Result<()> {
    let (of_type, range) = type_and_range(declaration, &row.kind, start);
    let name = match row.kind {
        Kind::Real { .. } => "Float64",
        Kind::Integer { .. } => "Int32",
        Kind::Boolean | Kind::Enumeration { .. } => of_type,
    };
    let mut attributes = general(reference, row);
    // Values within a step: of what is continuous.
    let continuous = matches!(row.kind, Kind::Real { .. }) && !matches!(row.role, Role::Parameter { .. });
    attributes.extend(continuous.then(|| ("intermediateUpdate", "true".into())));
    attributes.extend(range);
    leaf(xml, name, attributes)
}
