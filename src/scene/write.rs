//! Writes a scene as a scene file, complete and in SI units.

use super::modal::ModalTable;
use super::parameter::{Kind, PARAMETERS};
use super::profile::Profile;
use super::read::SceneFile;
use super::run::End;
use std::fmt::Write;

/// The text of a scene file that `read` converts back to the same scene, to the bit.
pub fn write(file: &SceneFile) -> String {
    let quoted = |text: &str| toml::Value::from(text).to_string();
    let mut out = String::new();
    line(&mut out, "name", &quoted(&file.name));
    line(&mut out, "description", &quoted(&file.description));
    match file.run.end {
        End::Turns(turns) => line(&mut out, "run.turns", &format!("{turns:?}")),
        End::Time(time) => line(&mut out, "run.stop", &format!("{time:?}")),
    }
    line(&mut out, "run.step", &format!("{:?}", file.run.step));
    line(&mut out, "crank.torque", &profile(&file.inputs.crank_torque));
    line(&mut out, "slider.load", &profile(&file.inputs.slider_load));
    for parameter in PARAMETERS {
        let value = match parameter.kind {
            Kind::Real { get, .. } => format!("{:?}", get(&file.scene)),
            Kind::Integer { get, .. } => get(&file.scene).to_string(),
            Kind::Boolean { get, .. } => get(&file.scene).to_string(),
            Kind::Enumeration { items, get, .. } => {
                let item = items.iter().find(|(_, value)| *value == get(&file.scene));
                quoted(item.map_or("", |(name, _)| *name))
            }
        };
        line(&mut out, parameter.name, &value);
    }
    // Numbers and lists of numbers can always be represented in TOML.
    if let Some(Ok(table)) = file.scene.rod.flexible.table.as_ref().map(toml::Value::try_from) {
        line(&mut out, "rod.flexible.table", &table.to_string());
    }
    out
}

/// The text of a file that `rod.flexible.table` may name.
pub fn write_table(table: &ModalTable) -> String {
    toml::to_string(table).unwrap_or_default()
}

fn profile(profile: &Profile) -> String {
    match profile {
        Profile::Constant(value) => format!("{value:?}"),
        Profile::Points { against, points } => {
            format!("{{ against = {:?}, points = {points:?} }}", against.name())
        }
    }
}

/// A key behind another key that has a value itself, such as `gravity.angle` behind `gravity`, is quoted.
fn line(out: &mut String, key: &str, value: &str) {
    let quote = if ["gravity.", "slider.load."].iter().any(|other| key.starts_with(other)) { "\"" } else { "" };
    // Writing to a String cannot fail.
    let _ = writeln!(out, "{quote}{key}{quote} = {value}");
}
