//! Rules of FMI 2.0 for a description, found from the text alone.

use roxmltree::{Document, Node};
use std::collections::{HashMap, HashSet};

/// Every rule that a description breaks.
pub fn problems(xml: &str) -> Vec<String> {
    let document = match Document::parse(xml) {
        Ok(document) => document,
        Err(error) => return vec![error.to_string()],
    };
    let root = document.root_element();
    let mut problems = header(root);
    problems.extend(definitions(root));
    let variables = below(root, "ScalarVariable");
    problems.extend(variables.iter().flat_map(|variable| declared(root, *variable)));
    problems.extend(twice("variable", variables.iter().filter_map(|node| node.attribute("name"))));
    let references = variables.iter().filter_map(|node| node.attribute("valueReference"));
    problems.extend(twice("valueReference", references));
    problems.extend(structure(root, &variables));
    problems
}

fn below<'a>(node: Node<'a, 'a>, tag: &str) -> Vec<Node<'a, 'a>> {
    node.descendants().filter(|node| node.has_tag_name(tag)).collect()
}

fn twice<'a>(what: &str, names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut seen = HashSet::new();
    names.filter(|name| !seen.insert(*name)).map(|name| format!("{what} {name} twice")).collect()
}

/// Version, identifier, date and experiment.
fn header(root: Node) -> Vec<String> {
    let mut problems = vec![];
    if root.attribute("fmiVersion") != Some("2.0") {
        problems.push("fmiVersion".to_owned());
    }
    for kind in [below(root, "CoSimulation"), below(root, "ModelExchange")] {
        let identifier = kind.first().and_then(|node| node.attribute("modelIdentifier"));
        if !identifier.is_some_and(is_identifier) {
            problems.push(format!("modelIdentifier {identifier:?} is no C identifier"));
        }
    }
    if !number(root, "numberOfEventIndicators").is_some_and(|count| count >= 0.0) {
        problems.push("numberOfEventIndicators".to_owned());
    }
    // The standard's example of a date: 2009-12-08T14:33:22Z.
    let date_form = |date: &str| {
        date.len() == 20
            && date.bytes().zip("dddd-dd-ddTdd:dd:ddZ".bytes()).all(|(byte, form)| match form {
                b'd' => byte.is_ascii_digit(),
                _ => byte == form,
            })
    };
    if root.attribute("generationDateAndTime").is_some_and(|date| !date_form(date)) {
        problems.push("date is not of the form 2009-12-08T14:33:22Z".to_owned());
    }
    for experiment in below(root, "DefaultExperiment") {
        let [start, stop, tolerance, step] =
            ["startTime", "stopTime", "tolerance", "stepSize"].map(|name| number(experiment, name).unwrap_or(f64::NAN));
        if !(start < stop && tolerance > 0.0 && step > 0.0) {
            problems.push("stopTime, tolerance or stepSize".to_owned());
        }
    }
    problems
}

/// Units, types and categories: unique, and what they refer to exists.
fn definitions(root: Node) -> Vec<String> {
    let name = |node: &Node| node.attribute("name").map(str::to_owned);
    let mut problems = vec![];
    for tag in ["Unit", "SimpleType", "Category"] {
        let names: Vec<String> = below(root, tag).iter().filter_map(name).collect();
        problems.extend(twice(tag, names.iter().map(String::as_str)));
    }
    for simple in below(root, "SimpleType") {
        problems.extend(below(simple, "Real").iter().filter_map(|real| unit_problem(root, *real)));
        let items = below(simple, "Item");
        problems.extend(twice("item", items.iter().filter_map(|item| item.attribute("value"))));
        let variables = below(root, "ScalarVariable");
        if variables.iter().any(|variable| variable.attribute("name") == simple.attribute("name")) {
            problems.push("declaredType has a variable's name".to_owned());
        }
    }
    problems
}

/// Unit and display unit of a type or variable.
fn unit_problem(root: Node, real: Node) -> Option<String> {
    let unit = real.attribute("unit");
    let defined = below(root, "Unit").into_iter().find(|node| node.attribute("name") == unit);
    let Some(defined) = defined else {
        return Some(format!("unit {unit:?} is not defined"));
    };
    let display = real.attribute("displayUnit")?;
    let known = below(defined, "DisplayUnit").iter().any(|node| node.attribute("name") == Some(display));
    (!known).then(|| format!("displayUnit {display} of {unit:?} is not defined"))
}

/// One variable: name, type, legal triple, start value in its range.
fn declared(root: Node, variable: Node) -> Vec<String> {
    let name = variable.attribute("name").unwrap_or_default();
    let mut problems = vec![];
    let mut complain = |what: &str| problems.push(format!("{name}: {what}"));
    if !is_structured(name) {
        complain("not a structured name");
    }
    let Some(kind) = variable.first_element_child() else {
        complain("no type");
        return problems;
    };
    let tag = kind.tag_name().name();
    let triple = ["causality", "variability", "initial"].map(|name| variable.attribute(name));
    let legal = match triple {
        [Some("input"), Some("continuous"), None] => tag == "Real",
        [Some("output"), Some("continuous"), Some("calculated")] => tag == "Real",
        [Some("output"), Some("discrete"), Some("calculated")] => tag != "Enumeration",
        [Some("parameter"), Some("fixed"), Some("exact")] => true,
        // A state or a derivative.
        [Some("local"), Some("continuous"), Some("calculated")] => tag == "Real",
        _ => false,
    };
    if !legal {
        complain("causality, variability and initial do not go together");
    }
    let wants_start = !matches!(triple[0], Some("output" | "local"));
    if wants_start != kind.attribute("start").is_some() {
        complain("start is missing or has no meaning");
    }
    let [start, min, max] = ["start", "min", "max"].map(|name| number(kind, name));
    let start = start.unwrap_or(0.0_f64.clamp(min.unwrap_or(0.0).min(0.0), max.unwrap_or(0.0).max(0.0)));
    if start < min.unwrap_or(f64::NEG_INFINITY) || start > max.unwrap_or(f64::INFINITY) {
        complain("start is outside min and max");
    }
    if number(kind, "nominal").is_some_and(|nominal| nominal <= 0.0) {
        complain("nominal is not positive");
    }
    if let Some(of) = kind.attribute("declaredType") {
        let types = below(root, "SimpleType");
        let of_kind = types.iter().find(|node| node.attribute("name") == Some(of));
        if of_kind.and_then(Node::first_element_child).map(|node| node.tag_name().name()) != Some(tag) {
            complain("declaredType is not defined, or of another kind");
        }
        if tag == "Enumeration"
            && !of_kind.is_some_and(|of| below(*of, "Item").iter().any(|item| number(*item, "value") == Some(start)))
        {
            complain("start is no item");
        }
    }
    if tag == "Real" {
        problems.extend(unit_problem(root, kind).map(|problem| format!("{name}: {problem}")));
    }
    problems
}

/// Outputs, derivatives and initial unknowns: complete, in order, with dependencies that exist.
fn structure(root: Node, variables: &[Node]) -> Vec<String> {
    let causality: HashMap<usize, &str> =
        (1..).zip(variables.iter().filter_map(|node| node.attribute("causality"))).collect();
    let of = |kinds: &[&str]| -> Vec<usize> {
        (1..=variables.len()).filter(|index| causality.get(index).is_some_and(|of| kinds.contains(of))).collect()
    };
    let state_of = |index: &usize| number(variables[index - 1].first_element_child()?, "derivative");
    let derivatives: Vec<usize> = of(&["local"]).into_iter().filter(|index| state_of(index).is_some()).collect();
    let states: Vec<usize> = of(&["local"]).into_iter().filter(|index| state_of(index).is_none()).collect();
    let mut problems = vec![];
    if derivatives.iter().filter_map(state_of).map(|state| state as usize).collect::<Vec<_>>() != states {
        problems.push("the derivatives are not of the states in order".to_owned());
    }
    for (list, unknown, known) in [
        ("Outputs", of(&["output"]), [of(&["input"]), states.clone()].concat()),
        ("Derivatives", derivatives, [of(&["input"]), states].concat()),
        ("InitialUnknowns", of(&["output", "local"]), of(&["input", "parameter"])),
    ] {
        let unknowns: Vec<Node> = below(root, list).into_iter().flat_map(|list| below(list, "Unknown")).collect();
        let index = |node: &Node| node.attribute("index").and_then(|index| index.parse().ok());
        if unknowns.iter().filter_map(index).collect::<Vec<usize>>() != unknown {
            problems.push(format!("{list} is not the list of its unknowns in order"));
        }
        for dependencies in unknowns.iter().filter_map(|node| node.attribute("dependencies")) {
            let indices: Vec<usize> = dependencies.split_whitespace().filter_map(|index| index.parse().ok()).collect();
            if !indices.iter().all(|index| known.contains(index)) || !indices.is_sorted_by(|a, b| a < b) {
                problems.push(format!("{list}: dependencies {dependencies}"));
            }
        }
    }
    problems
}

/// The structured convention: parts joined by dots, each with an index or without, and `der(…)` around such a name.
fn is_structured(name: &str) -> bool {
    let inner = name.strip_prefix("der(").and_then(|rest| rest.strip_suffix(')')).unwrap_or(name);
    inner.split('.').all(|part| match part.strip_suffix(']').and_then(|part| part.split_once('[')) {
        Some((word, index)) => is_identifier(word) && index.bytes().all(|byte| byte.is_ascii_digit()),
        None => is_identifier(part),
    })
}

fn is_identifier(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

fn number(node: Node, name: &str) -> Option<f64> {
    node.attribute(name)?.parse().ok()
}
