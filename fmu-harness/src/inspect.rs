//! Prints the declarations of an FMU.

use crate::host::{Description, Unknown};
use crate::report::table::Table;
use std::fmt::Write;

/// Tables of an FMU's description and of the contents of its archive.
pub fn declared(description: &Description, platforms: &[String], entries: &[String]) -> String {
    let mut text = String::new();
    let mut head = Table::default();
    for (name, attribute) in [
        ("model", "modelName"),
        ("description", "description"),
        ("FMI", "fmiVersion"),
        ("GUID", "guid"),
        ("token", "instantiationToken"),
        ("version", "version"),
        ("made by", "generationTool"),
        ("made at", "generationDateAndTime"),
        ("author", "author"),
        ("licence", "license"),
        ("naming", "variableNamingConvention"),
    ] {
        if let Some(value) = description.model.get(attribute) {
            head.row([format!("{name}: {value}")]);
        }
    }
    head.row([format!("binaries: {}", list(platforms))]);
    head.row([format!("files: {}", list(entries))]);
    head.row([format!("log categories: {}", list(&description.log_categories))]);
    let experiment: Vec<String> =
        (description.experiment.sorted().into_iter()).map(|(name, value)| format!("{name} {value}")).collect();
    head.row([format!("default experiment: {}", list(&experiment))]);
    text += &head.print();

    let mut capabilities = Table::default();
    let offers = if description.model_exchange { "co-simulation (model exchange too)" } else { "co-simulation" };
    capabilities.row([if description.co_simulation.is_some() { offers } else { "no co-simulation" }, ""]);
    let declared = description.co_simulation.iter().flat_map(|element| element.sorted());
    declared.for_each(|(name, value)| capabilities.row([name, value]));
    let _ = write!(text, "\n{}", capabilities.print());

    let mut variables = Table::default();
    variables.row(["variable", "reference", "causality", "variability", "type", "start", "unit", "shown in"]);
    for variable in &description.variables {
        let start = variable.of_kind.get("start").unwrap_or_default();
        let items = description.items(variable).iter();
        let item = items.clone().find(|(_, value)| value.to_string() == start).map_or(start, |(name, _)| name);
        variables.row([
            variable.name.clone(),
            variable.reference.to_string(),
            variable.causality().into(),
            variable.variability().into(),
            format!("{:?}", variable.kind),
            item.into(),
            description.unit(variable).unwrap_or_default().into(),
            description.display_unit(variable).unwrap_or_default().into(),
        ]);
    }
    let _ = write!(text, "\n{}", variables.print());

    let structure = &description.structure;
    let known = |unknowns: &[Unknown]| unknowns.iter().filter(|u| u.dependencies.is_some()).count();
    let mut counts = Table::default();
    counts.row(["structure", "entries", "with dependencies"]);
    for (name, unknowns) in [
        ("outputs", &structure.outputs),
        ("derivatives", &structure.derivatives),
        ("initial unknowns", &structure.initial_unknowns),
    ] {
        counts.row([name.into(), unknowns.len().to_string(), known(unknowns).to_string()]);
    }
    let _ = write!(text, "\n{}", counts.print());
    text
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".into() } else { names.join(", ") }
}
