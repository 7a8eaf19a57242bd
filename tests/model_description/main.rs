//! The model description against the standard's rules, those above all that the usual validators
//! let pass. Each rule is shown to catch its fault: a check that never fires proves nothing.

mod dependencies;
mod fmi3;
mod rules;

use rules::problems;
use slidercrank::fmi::slave::states::{self, exchange};
use slidercrank::fmi::slave::variables::{Access, LogCategory, VARIABLES};
use slidercrank::fmi::v2::description::{declared_experiment, documentation, model_description};
use slidercrank::model_description::exchange::{FIRST_DERIVATIVE, FIRST_STATE};
use slidercrank::model_description::rows::read;
use slidercrank::scene::parameter::Kind;
use slidercrank::scene::{PARAMETERS, Scene, slot};
use std::collections::BTreeMap;
use std::{env, fs};

const COMMITTED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../modelDescription/modelDescription.xml");
const ROWS: &str = include_str!("../../modelDescription/variables.toml");

fn made() -> String {
    model_description(&Scene::default(), None, None).expect("the declared description")
}

#[test]
fn the_committed_copy_is_fresh() {
    if env::var_os("BLESS").is_some() {
        fs::write(COMMITTED, made()).expect("modelDescription.xml written");
    }
    let committed = fs::read_to_string(COMMITTED).unwrap_or_default();
    assert!(committed == made(), "modelDescription.xml is stale: run the tests once with BLESS=1");
}

#[test]
fn the_description_breaks_no_rule() {
    assert_eq!(problems(&made()), Vec::<String>::new());
    let mut scene = Scene::default();
    for parameter in PARAMETERS {
        // Edges of the ranges are legal start values too.
        let edge = match parameter.kind {
            Kind::Real { max, .. } => max,
            Kind::Integer { max, .. } => f64::from(max),
            Kind::Boolean { start, .. } => f64::from(u8::from(!start)),
            Kind::Enumeration { items, .. } => items.iter().map(|item| f64::from(item.1)).fold(0.0, f64::max),
        };
        parameter.write(&mut scene, edge).expect("a legal value");
    }
    let dated = model_description(&scene, None, Some(1_767_225_599)).expect("a description");
    assert_eq!(problems(&dated), Vec::<String>::new());
    assert!(dated.contains("generationDateAndTime=\"2025-12-31T23:59:59Z\""));
}

/// What stands in the description, what replaces it, and a word of the complaint.
const SEEDS: [(&str, &str, &str); 29] = [
    ("unit=\"N.m\" nominal", "unit=\"N.mm\" nominal", "unit"),
    ("<Unit name=\"rad\">", "<Unit name=\"m\">", "twice"),
    ("displayUnit=\"mm\" nominal", "displayUnit=\"inch\" nominal", "displayUnit"),
    (
        "<Real quantity=\"Angle\" unit=\"rad\" displayUnit=\"deg\"/>",
        "<Real quantity=\"Angle\" unit=\"rad\" displayUnit=\"gon\"/>",
        "displayUnit",
    ),
    ("<InitialUnknowns>", "<InitialUnknowns><Unknown index=\"1\"/>", "InitialUnknowns"),
    ("valueReference=\"7\"", "valueReference=\"6\"", "valueReference"),
    ("min=\"0.0001\" max=\"100.0\" start=\"0.05\"", "min=\"0.06\" max=\"100.0\" start=\"0.05\"", "start"),
    ("<Integer min=\"0\" max=\"8\" start=\"0\"/>", "<Integer min=\"0\" max=\"8\" start=\"9\"/>", "start"),
    ("<Integer min=\"0\" max=\"8\" start=\"0\"/>", "<Integer min=\"0\" max=\"8\"/>", "start"),
    ("<Boolean start=\"true\"/>", "<Boolean/>", "start"),
    ("name=\"slider.y\"", "name=\"slider.x\"", "twice"),
    ("name=\"slider.y\"", "name=\"slider.2y\"", "structured"),
    ("dependencies=\"1 2 ", "dependencies=\"1 2000 ", "dependencies"),
    ("dependencies=\"1 2 ", "dependencies=\"2 1 ", "dependencies"),
    ("dependencies=\"1 2 ", "dependencies=\"1 5 ", "dependencies"),
    ("numberOfEventIndicators=\"1\"", "", "numberOfEventIndicators"),
    ("<Derivatives>", "<Derivatives><Unknown index=\"1\"/>", "Derivatives"),
    ("name=\"der(state.crank.angle)\"", "name=\"der(state.crank.angle\"", "structured"),
    (
        "unit=\"rad/s\" displayUnit=\"rpm\" derivative=\"",
        "unit=\"rad/s\" displayUnit=\"rpm\" derivative=\"1",
        "derivatives",
    ),
    ("T00:00:00Z\"", "T00:00:00+00:00\"", "date"),
    ("declaredType=\"Torque\"", "declaredType=\"Torc\"", "declaredType"),
    ("<Outputs>\n      <Unknown index=\"3\"", "<Outputs>\n      <Unknown index=\"4\"", "Outputs"),
    ("nominal=\"100.0\" start=\"0.0\"", "nominal=\"100.0\"", "start"),
    (
        "variability=\"continuous\" initial=\"calculated\"",
        "variability=\"tunable\" initial=\"calculated\"",
        "variability",
    ),
    (" start=\"0.05\"", "", "start"),
    ("modelIdentifier=\"SliderCrank\"", "modelIdentifier=\"Slider-Crank\"", "modelIdentifier"),
    ("stopTime=\"1.0\"", "stopTime=\"-1.0\"", "stopTime"),
    ("<SimpleType name=\"Force\"", "<SimpleType name=\"gravity\"", "declaredType"),
    ("<Category name=\"logAll\"", "<Category name=\"logStatusError\"", "twice"),
];

#[test]
fn each_seeded_fault_is_caught() {
    let xml = made();
    for (from, to, word) in SEEDS {
        assert!(xml.contains(from), "{from} is not in the description");
        let found = problems(&xml.replacen(from, to, 1));
        assert!(found.iter().any(|problem| problem.contains(word)), "{to}: {found:?}");
    }
}

#[test]
fn value_references_and_tables_are_those_of_the_description() {
    let xml = made();
    let document = roxmltree::Document::parse(&xml).expect("well-formed XML");
    let scalars: Vec<_> = document.descendants().filter(|node| node.has_tag_name("ScalarVariable")).collect();
    let exchange = exchange(&Scene::default()).expect("model exchange");
    assert_eq!(scalars.len(), VARIABLES.len() + 2 * exchange.states.len());
    let references = |first: u32| (first..).take(exchange.states.len());
    let exchanged = references(FIRST_STATE).chain(references(FIRST_DERIVATIVE));
    for (scalar, reference) in scalars[VARIABLES.len()..].iter().zip(exchanged) {
        assert_eq!(scalar.attribute("valueReference"), Some(reference.to_string().as_str()));
        assert!(states::variable(reference).is_some() && VARIABLES.get(reference as usize).is_none());
    }
    for (index, (scalar, variable)) in scalars.iter().zip(VARIABLES).enumerate() {
        assert_eq!(scalar.attribute("valueReference"), Some(index.to_string().as_str()));
        assert_eq!(scalar.attribute("name"), Some(variable.name));
        let causality = match &variable.access {
            Access::Input { .. } => "input",
            Access::Parameter(parameter) => {
                assert_eq!(parameter.name, variable.name);
                "parameter"
            }
            _ => "output",
        };
        assert_eq!(scalar.attribute("causality"), Some(causality));
    }
    let categories: Vec<_> = document.descendants().filter(|node| node.has_tag_name("Category")).collect();
    let names: Vec<_> = categories.iter().filter_map(|node| node.attribute("name")).collect();
    assert_eq!(names, LogCategory::ALL.iter().map(|category| category.name()).collect::<Vec<_>>());
}

#[test]
fn every_variable_has_a_description_of_its_own_and_items_stand_in_order() {
    let xml = made();
    let document = roxmltree::Document::parse(&xml).expect("well-formed XML");
    let mut seen = BTreeMap::new();
    for scalar in document.descendants().filter(|node| node.has_tag_name("ScalarVariable")) {
        let [name, description] = ["name", "description"].map(|attribute| scalar.attribute(attribute).expect("told"));
        assert_eq!(seen.insert(description, name), None, "{name}: {description}");
        if let Some(joint) = name.strip_prefix("joint.") {
            assert!(description.starts_with(&format!("Joint {}: ", &joint[..1])), "{name}: {description}");
        }
    }
    for enumeration in document.descendants().filter(|node| node.has_tag_name("Enumeration")) {
        let items = enumeration.children().filter_map(|item| item.attribute("value")?.parse::<i32>().ok());
        assert!(items.is_sorted_by(|one, next| one < next));
    }
}

#[test]
fn the_root_tells_who_made_it_and_when() {
    let xml = made();
    let document = roxmltree::Document::parse(&xml).expect("well-formed XML");
    let root = document.root_element();
    let licence = include_str!("../../LICENSE-MIT");
    for attribute in ["author", "copyright"] {
        let told = root.attribute(attribute).expect("told");
        assert!(licence.contains(told.trim_start_matches("Copyright ")), "{told}");
    }
    let date = root.attribute("generationDateAndTime").expect("told");
    assert!(date.ends_with("T00:00:00Z") && date.len() == 20, "{date}");
    // The date is no part of what the library checks.
    let dated = model_description(&Scene::default(), None, Some(0)).expect("a description");
    assert_eq!(dated, xml.replace(date, "1970-01-01T00:00:00Z"));
}

/// Outputs that tell what the modes and the audit reckon, and a dependency of theirs at the start.
#[test]
fn modes_and_energies_feel_no_input_at_once() {
    let xml = made();
    let document = roxmltree::Document::parse(&xml).expect("well-formed XML");
    let index = |name: &str| (1 + VARIABLES.iter().position(|row| row.name == name).expect("declared")).to_string();
    let entry = |list: &str, name: &str| {
        let list = document.descendants().find(|node| node.has_tag_name(list)).expect("the list");
        let found = list.children().find(|node| node.attribute("index") == Some(&index(name))).expect("an entry");
        let dependencies = found.attribute("dependencies").expect("told one by one");
        dependencies.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    let energies = VARIABLES.iter().filter(|row| row.name.starts_with("energy.") && row.name != "energy.audit");
    let names: Vec<&str> = energies.map(|row| row.name).chain(["rod.deflection", "rod.stretch"]).collect();
    assert_eq!(names.len(), 16);
    for name in names {
        assert!(
            entry("Outputs", name).iter().all(|known| ![index("crank.torque"), index("slider.load")].contains(known))
        );
        let at_start = entry("InitialUnknowns", name);
        let counts = ["energy.kinetic", "energy.potential", "energy.gravity", "energy.contact"].contains(&name);
        assert_eq!(at_start.contains(&index("energy.audit")), counts, "{name}");
        assert_eq!(at_start.contains(&index("gravity")), ["energy.potential", "energy.gravity"].contains(&name));
        assert_eq!(at_start.contains(&index("crank.speed_start")), name == "energy.kinetic");
    }
}

#[test]
fn start_values_and_guid_follow_the_scene() {
    let mut scene = Scene::default();
    scene.crank.length = 0.0625;
    let mut experiment = declared_experiment().expect("the declared experiment");
    experiment.stop = 0.24;
    let xml = model_description(&scene, Some(experiment), None).expect("a description");
    assert!(xml.contains("start=\"0.0625\""));
    assert!(xml.contains("stopTime=\"0.24\""));
    assert!(xml.contains(&slot::guid(&scene)));
    assert!(!made().contains(&slot::guid(&scene)));
    assert!(made().contains(&slot::guid(&Scene::default())));
}

#[test]
fn the_page_names_every_variable_and_leaves_no_place_unfilled() {
    let page = documentation(&Scene::default(), "declared defaults").expect("the page");
    assert!(!page.contains("{{") && !page.contains("{J}"));
    for variable in VARIABLES {
        let template = ["A", "B", "C", "T"]
            .iter()
            .fold(variable.name.to_owned(), |name, letter| name.replace(&format!("joint.{letter}."), "joint.J."));
        let named = [variable.name, &template].iter().any(|name| page.contains(&format!("<code>{name}</code>")));
        assert!(named, "{}", variable.name);
    }
}

#[test]
fn the_page_tells_whether_the_package_has_modes_of_its_own() {
    let page = |scene: &Scene| documentation(scene, "").expect("the page");
    let mut scene = Scene::default();
    assert!(page(&scene).contains("not of its variables: this one has none."));
    (scene.rod.flexible.bending_modes, scene.rod.flexible.axial_modes) = (3, 2);
    scene.rod.flexible.table = Some(slidercrank::model::rod::beam::table(&scene));
    assert!(page(&scene).contains("this one has a table of 3 bending and 2 axial modes, <code>modes.toml</code>"));
    // The format as the page tells it names every key.
    let text = slidercrank::scene::write::write_table(scene.rod.flexible.table.as_ref().expect("the table"));
    let keys = text.lines().filter_map(|line| line.split_once(" = ")).map(|(key, _)| key);
    let keys: Vec<&str> = keys.filter(|key| key.chars().all(|c| c.is_ascii_lowercase() || c == '_')).collect();
    assert!(keys.contains(&"slope_end") && keys.contains(&"coupling"), "{keys:?}");
    for key in keys {
        let named = ["<code>", "{ ", ", "].iter().any(|before| page(&scene).contains(&format!("{before}{key}")));
        assert!(named, "{key}");
    }
}

/// What stands in the declaration, what replaces it, and the complaint.
const WRONG_ROWS: [(&str, &str, &str); 17] = [
    ("causality = \"input\"", "causality = \"local\"", "cannot be local, continuous and Torque"),
    ("type = \"Boolean\", field", "type = \"DriveMode\", field", "cannot be output, discrete and DriveMode"),
    ("start = 0.05, min = 1e-4", "start = 0.05, min = 0.1", "not min <= start <= max and nominal > 0"),
    ("start = 0.05, min = 1e-4", "min = 1e-4", "`start` is missing"),
    ("start = 0.05, min = 1e-4, ", "start = 0.05, ", "`min` is missing"),
    ("name = \"slider.v\"", "name = \"slider.x\"", "`slider.x` is declared twice"),
    ("name = \"slider.v\"", "name = \"slider v\"", "`slider v` is not a structured name"),
    ("at_start = [\"crank.angle_start\"]", "at_start = [\"crank.angel\"]", "`crank.angel` is not declared"),
    ("start = 0, min = 0, max = 8", "start = 9, min = 0, max = 8", "not min <= start <= max and nominal > 0"),
    ("start = 0, min = 0, max = 8", "start = 0.5, min = 0, max = 8", "0.5 is no integer"),
    ("start = 0, min = 0, max = 8", "start = 0, min = 0, max = 8.5", "8.5 is no integer"),
    ("start = 0, min = 0, max = 8", "start = 0, min = 0", "`max` is missing"),
    ("start = true, field", "start = 1, field", "`start` is missing"),
    ("start = true, field", "start = true, min = 0, field", "`min, max` has no meaning here"),
    ("\"Crank angle, not wrapped\"", "\"Tilt of the slider\"", "`Tilt of the slider` is declared twice"),
    ("name = \"speed\", value = 2", "name = \"speed\", value = 0", "the items of `DriveMode` do not rise in value"),
    ("start = \"automatic\"", "start = \"verner9\"", "`verner9` is not declared"),
];

#[test]
fn a_wrong_row_is_refused_with_its_line() {
    for (from, to, complaint) in WRONG_ROWS {
        let (before, _) = ROWS.split_once(from).expect("a part of the declaration");
        let error = read(&ROWS.replacen(from, to, 1)).err().expect("a wrong row").to_string();
        assert!(error.ends_with(complaint), "{error}");
        let line = before.matches('\n').count() + 1;
        // A group's causality is found wrong at the group's first row, three lines on.
        let lines = [line, line + 3].map(|line| format!("variables.toml:{line}: "));
        assert!(lines.iter().any(|line| error.contains(line)), "{error}");
    }
}
