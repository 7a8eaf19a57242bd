//! Rows → Rust: the scene's enumerations, the scene's parameters, the FMU's variables.

use super::exchange::{FIRST_DERIVATIVE, FIRST_STATE};
use super::rows::{Declaration, Enumeration, Experiment, Kind, Role, Row};
use std::fmt::Write;

/// Most continuous states that a scene has.
const MOST_STATES: usize = 64;

/// The scene's enumerations as `enumeration!` invocations.
pub fn enumerations(declaration: &Declaration) -> String {
    let mut out = String::new();
    for enumeration in &declaration.enumerations {
        let name = &enumeration.name;
        line(&mut out, &format!("enumeration! {{ #[doc = {:?}] {name} {{", sentence(&enumeration.description)));
        for item in &enumeration.items {
            let default = if item.value == default_of(declaration, enumeration) { "#[default] " } else { "" };
            let doc = sentence(&item.description);
            line(
                &mut out,
                &format!(
                    "    #[doc = {doc:?}] {default}{} = {} = {:?} {:?},",
                    camel(&item.name),
                    item.value,
                    item.name,
                    item.properties
                ),
            );
        }
        line(&mut out, "} }");
    }
    out
}

/// The laws of an enumeration as a macro that hands their list to another one: each item's type and the file of the same
/// name. An item `none` is no law.
pub fn laws(declaration: &Declaration, of: &str, list: &str) -> String {
    let mut out = String::new();
    line(&mut out, &format!("macro_rules! {list} {{ ($then:ident) => {{ $then! {{"));
    let items = declaration.enumerations.iter().filter(|enumeration| enumeration.name == of).flat_map(|of| &of.items);
    for item in items.filter(|item| item.name != "none") {
        line(&mut out, &format!("    {} in {},", camel(&item.name), item.name));
    }
    line(&mut out, "} }; }");
    out
}

/// The scene's parameters, with the digest and the guid that go with their start values.
pub fn parameters(declaration: &Declaration, digest: &[u8; 32], guid: &str) -> String {
    let mut out = String::new();
    let rows = || declaration.rows.iter().filter_map(|row| start_of(row).map(|start| (row, start)));
    line(&mut out, &format!("/// Number of parameters.\npub const PARAMETER_COUNT: usize = {};", rows().count()));
    line(&mut out, "/// Every parameter, in the order of the declaration.\npub static PARAMETERS: &[Parameter] = &[");
    for (Row { name, description, field, kind, .. }, start) in rows() {
        let kind = match kind {
            Kind::Real { of, min, max, .. } => {
                let unit = &declaration.types[*of].unit;
                let (min, max) = (min.unwrap_or(f64::MIN), max.unwrap_or(f64::MAX));
                format!(
                    "Kind::Real {{ unit: {unit:?}, start: {start:?}, min: {min:?}, max: {max:?}, \
                     get: |scene| scene.{field}, set: |scene, value| scene.{field} = value }}"
                )
            }
            Kind::Enumeration { of } => {
                let name = &declaration.enumerations[*of].name;
                format!(
                    "Kind::Enumeration {{ start: {start}, items: {name}::ITEMS, get: |scene| scene.{field}.value(), \
                     set: |scene, value| {{ scene.{field} = {name}::from_value(value)?; Some(()) }} }}"
                )
            }
            Kind::Integer { min, max } => {
                let (min, max) = (min.unwrap_or(i32::MIN), max.unwrap_or(i32::MAX));
                format!(
                    "Kind::Integer {{ start: {start}, min: {min}, max: {max}, \
                     get: |scene| scene.{field}, set: |scene, value| scene.{field} = value }}"
                )
            }
            Kind::Boolean => {
                let start = start != 0.0;
                format!(
                    "Kind::Boolean {{ start: {start}, \
                     get: |scene| scene.{field}, set: |scene, value| scene.{field} = value }}"
                )
            }
        };
        line(&mut out, &format!("    Parameter {{ name: {name:?}, description: {description:?}, kind: {kind} }},"));
    }
    line(&mut out, "];");
    let Experiment { stop, step, .. } = declaration.experiment;
    line(&mut out, &format!("/// [s] Stop time of a run that names none.\npub const DEFAULT_STOP: f64 = {stop:?};"));
    line(&mut out, &format!("/// [s] Step of a run that names none.\npub const DEFAULT_STEP: f64 = {step:?};"));
    line(&mut out, &format!("/// Digest of the declaration.\npub const DECLARATION: [u8; 32] = {digest:?};"));
    line(
        &mut out,
        &format!("/// The guid of a package with the declared start values.\npub const DEFAULT_GUID: &str = {guid:?};"),
    );
    out
}

/// The FMU's variables by value reference, and its log categories.
pub fn variables(declaration: &Declaration) -> String {
    let mut out = String::new();
    line(
        &mut out,
        "/// Every variable; the index is the value reference, of whatever type.\npub static VARIABLES: &[Variable] = &[",
    );
    let mut parameter = 0;
    for Row { name, field, kind, role, .. } in &declaration.rows {
        let access = match (role, kind) {
            (Role::Input { start }, _) => format!(
                "Access::Input {{ start: {start:?}, get: |inputs| inputs.{field}, set: |inputs, value| inputs.{field} = value }}"
            ),
            (Role::Output { .. }, Kind::Real { .. }) => {
                format!("Access::RealOutput(|outputs| outputs.{field})")
            }
            (Role::Output { .. }, Kind::Boolean) => {
                format!("Access::BooleanOutput(|outputs| outputs.{field})")
            }
            (Role::Output { .. }, _) => format!("Access::IntegerOutput(|outputs| outputs.{field})"),
            (Role::Parameter { .. }, _) => {
                parameter += 1;
                format!("Access::Parameter(&crate::scene::PARAMETERS[{}])", parameter - 1)
            }
        };
        line(&mut out, &format!("    Variable {{ name: {name:?}, access: {access} }},"));
    }
    line(&mut out, "];");
    for (list, first, of) in [("STATES", FIRST_STATE, ""), ("DERIVATIVES", FIRST_DERIVATIVE, "derivative of ")] {
        line(
            &mut out,
            &format!(
                "/// Continuous states or their derivatives; the first has the value reference {first}.\npub static {list}: &[Variable] = &["
            ),
        );
        let access = if of.is_empty() { "State" } else { "Derivative" };
        for place in 0..MOST_STATES {
            let name = format!("{of}continuous state {}", place + 1);
            line(&mut out, &format!("    Variable {{ name: {name:?}, access: Access::{access}({place}) }},"));
        }
        line(&mut out, "];");
    }
    line(&mut out, "log_categories! {");
    for category in &declaration.log {
        let doc = sentence(&category.description);
        let item = camel(category.name.trim_start_matches("log"));
        line(&mut out, &format!("    #[doc = {doc:?}] {item} = {:?},", category.name));
    }
    line(&mut out, "}");
    out
}

/// Start values of the parameters, in order.
pub fn starts(declaration: &Declaration) -> impl Iterator<Item = f64> {
    declaration.rows.iter().filter_map(start_of)
}

fn start_of(row: &Row) -> Option<f64> {
    match row.role {
        Role::Parameter { start } => Some(start),
        _ => None,
    }
}

/// Start of the parameters of this enumeration, or its first item.
fn default_of(declaration: &Declaration, enumeration: &Enumeration) -> i32 {
    let of_this = |row: &&Row| match row.kind {
        Kind::Enumeration { of } => declaration.enumerations[of].name == enumeration.name,
        _ => false,
    };
    let start = declaration.rows.iter().find(of_this).and_then(start_of);
    start.map_or(1, |start| start as i32)
}

/// `hunt_crossley` → `HuntCrossley`.
fn camel(name: &str) -> String {
    let word = |word: &str| {
        word.chars().enumerate().map(|(i, c)| if i == 0 { c.to_ascii_uppercase() } else { c }).collect::<String>()
    };
    name.split('_').map(word).collect()
}

fn sentence(text: &str) -> String {
    format!("{text}.")
}

fn line(out: &mut String, text: &str) {
    // Writing to a String cannot fail.
    let _ = writeln!(out, "{text}");
}
