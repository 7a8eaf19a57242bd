//! Reads a scene file (TOML). Keys are the FMU's variable names; a number is in SI units, a text has a unit.
//!
//! ```toml
//! name = "wornpin"
//! description = "..."
//! gravity = 9.81
//! "gravity.angle" = "0 deg" # in quotes, since `gravity` has a value itself
//! [run]
//! turns = 20           # or stop = "0.24 s"
//! step = "10 us"
//! [crank]
//! length = "50 mm"
//! [joint.C]
//! model = "clearance"
//! [slider]
//! load = "-2 kN"       # a constant input; or points over "time" or "crank.angle":
//! # load = { against = "crank.angle", points = [["0 deg", 0], ["180 deg", "-2 kN"]] }
//! ```

use super::data::Scene;
use super::error::SceneError;
use super::parameter::{Kind, PARAMETERS, Parameter, with_unit};
use super::problem::{Fault, Problem, ReadError, nearest, position};
use super::profile::{Profile, Profiles};
pub use super::read_table::Files;
use super::read_value::{Value, integer, number, source};
use super::run::{End, Run};
use super::{read_profile, read_table};
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// Contents of a scene file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneFile {
    /// Short name.
    pub name: String,
    /// Description.
    pub description: String,
    /// The mechanism and its solver.
    pub scene: Scene,
    /// Duration and output step.
    pub run: Run,
    /// The inputs.
    pub inputs: Profiles,
}

/// Keys other than parameters: name and SI unit; `None` for a text.
const OTHER_KEYS: [(&str, Option<&str>); 8] = [
    ("name", None),
    ("description", None),
    (TABLE, None),
    ("run.turns", Some("1")),
    ("run.stop", Some("s")),
    ("run.step", Some("s")),
    ("crank.torque", Some("N.m")),
    ("slider.load", Some("N")),
];

/// Key of the rod's modes: a table, or the name of a file that contains one.
const TABLE: &str = "rod.flexible.table";

/// Maximum number of turns, and maximum duration in seconds, of a run.
const MAX_DURATION: f64 = 1e6;

/// Reads the text of a scene file. `file` is its name: it appears in messages, and files that the scene names are
/// searched next to it.
///
/// # Errors
/// All problems of the file.
pub fn read(text: &str, file: &str) -> Result<SceneFile, ReadError> {
    read_with(text, file, &|name| fs::read_to_string(Path::new(file).with_file_name(name)))
}

/// Reads the text of a scene file; `files` returns the text of files that it names.
///
/// # Errors
/// All problems of the file.
pub fn read_with(text: &str, file: &str, files: Files) -> Result<SceneFile, ReadError> {
    let mut reader = Reader { text, files, found: SceneFile::default(), places: HashMap::new(), faults: vec![] };
    match DeTable::parse(text) {
        Ok(table) => reader.table("", table.get_ref()),
        Err(error) => {
            let offset = error.span().map_or(0, |span| span.start);
            reader.faults.push((offset, Fault::Syntax(error.message().to_owned())));
        }
    }
    if reader.faults.is_empty() {
        reader.check();
    }
    if reader.faults.is_empty() {
        return Ok(reader.found);
    }
    reader.faults.sort_by_key(|(offset, _)| *offset);
    let problem = |(offset, fault)| {
        let (line, column) = position(text, offset);
        Problem { line, column, fault }
    };
    let problems = reader.faults.into_iter().map(problem).collect();
    Err(ReadError { file: file.to_owned(), problems })
}

struct Reader<'i> {
    text: &'i str,
    files: Files<'i>,
    found: SceneFile,
    /// Byte offset of every key that was set.
    places: HashMap<String, usize>,
    /// Problems and their byte offsets.
    faults: Vec<(usize, Fault)>,
}

impl<'i> Reader<'i> {
    /// Reads all entries of a table.
    fn table(&mut self, prefix: &str, table: &DeTable<'i>) {
        for (key, value) in table {
            let path = match prefix {
                "" => key.get_ref().to_string(),
                _ => format!("{prefix}.{}", key.get_ref()),
            };
            let offset = key.span().start;
            if let Err(fault) = self.entry(&path, offset, value) {
                let offset = match fault {
                    Fault::UnknownKey { .. } | Fault::Twice { .. } => offset,
                    _ => value.span().start,
                };
                self.faults.push((offset, fault));
            }
        }
    }

    fn entry(&mut self, path: &str, offset: usize, value: &Value<'i>) -> Result<(), Fault> {
        let parameter = Parameter::named(path);
        let other = OTHER_KEYS.iter().find(|(name, _)| *name == path);
        if parameter.is_none() && other.is_none() {
            return self.inner_table(path, value);
        }
        if self.places.insert(path.to_owned(), offset).is_some() {
            return Err(Fault::Twice { key: path.to_owned() });
        }
        if let Some(parameter) = parameter {
            return self.parameter(parameter, value);
        }
        let limited = |reader: &Self, unit: &str| {
            let number = number(reader.text, path, value, unit)?;
            let legal = number > 0.0 && number <= MAX_DURATION;
            legal.then_some(number).ok_or_else(|| Fault::Value {
                key: path.to_owned(),
                found: source(reader.text, value),
                allowed: format!("above 0, at most {}", with_unit(MAX_DURATION, unit)),
            })
        };
        match path {
            "name" => self.found.name = self.text_of(path, value)?,
            TABLE => match read_table::table(self.text, path, value, self.files) {
                Ok(table) => self.found.scene.rod.flexible.table = Some(table),
                Err(fault) => self.faults.push(fault),
            },
            "description" => self.found.description = self.text_of(path, value)?,
            "run.turns" => self.found.run.end = End::Turns(limited(self, "1")?),
            "run.stop" => self.found.run.end = End::Time(limited(self, "s")?),
            "run.step" => self.found.run.step = limited(self, "s")?,
            "crank.torque" => self.found.inputs.crank_torque = self.profile(path, value, "N.m")?,
            _ => self.found.inputs.slider_load = self.profile(path, value, "N")?,
        }
        Ok(())
    }

    fn inner_table(&mut self, path: &str, value: &Value<'i>) -> Result<(), Fault> {
        let known = children(path);
        match value.get_ref() {
            _ if known.is_empty() => {
                let prefix = path.rsplit_once('.').map_or("", |(prefix, _)| prefix);
                let known = children(prefix);
                let nearest = nearest(path, &known).cloned();
                Err(Fault::UnknownKey { key: path.to_owned(), nearest, known })
            }
            DeValue::Table(table) => {
                self.table(path, table);
                Ok(())
            }
            _ => Err(Fault::Type {
                key: path.to_owned(),
                found: source(self.text, value),
                wanted: format!("a table of {}", known.join(", ")),
            }),
        }
    }

    fn parameter(&mut self, parameter: &Parameter, value: &Value<'i>) -> Result<(), Fault> {
        let key = || parameter.name.to_owned();
        let found = || source(self.text, value);
        let (number, allowed) = match &parameter.kind {
            Kind::Real { unit, .. } => (number(self.text, parameter.name, value, unit)?, parameter.allowed()),
            Kind::Integer { .. } => {
                let allowed = parameter.allowed();
                let integer = integer(value).ok_or_else(|| Fault::Type {
                    key: key(),
                    found: found(),
                    wanted: allowed.clone(),
                })?;
                (integer, allowed)
            }
            Kind::Boolean { .. } => {
                let allowed = parameter.allowed();
                let wrong = || Fault::Type { key: key(), found: found(), wanted: allowed.clone() };
                let boolean = value.get_ref().as_bool().ok_or_else(wrong)?;
                (f64::from(u8::from(boolean)), allowed)
            }
            Kind::Enumeration { items, .. } => {
                let names: Vec<&str> = items.iter().map(|(name, _)| *name).collect();
                let allowed = names.join(", ");
                let Some(text) = value.get_ref().as_str() else {
                    let wanted = format!("one of the texts {allowed}");
                    return Err(Fault::Type { key: key(), found: found(), wanted });
                };
                match items.iter().find(|(name, _)| *name == text) {
                    Some((_, value)) => (f64::from(*value), allowed),
                    None => {
                        return Err(Fault::Value { key: key(), found: found(), allowed });
                    }
                }
            }
        };
        parameter.write(&mut self.found.scene, number).map_err(|_| Fault::Value { key: key(), found: found(), allowed })
    }

    fn text_of(&self, key: &str, value: &Value<'i>) -> Result<String, Fault> {
        let text = value.get_ref().as_str().ok_or_else(|| Fault::Type {
            key: key.to_owned(),
            found: source(self.text, value),
            wanted: "a text".to_owned(),
        })?;
        Ok(text.to_owned())
    }

    fn profile(&mut self, key: &str, value: &Value<'i>, unit: &str) -> Result<Profile, Fault> {
        match value.get_ref() {
            DeValue::Table(table) => {
                // `slider.load` is an input, `slider.load.offset` a parameter.
                let is_parameter = |name: &str| Parameter::named(&format!("{key}.{name}")).is_some();
                let (parameters, points): (DeTable, DeTable) =
                    table.clone().into_iter().partition(|(name, _)| is_parameter(name.get_ref()));
                self.table(key, &parameters);
                if points.is_empty() && !parameters.is_empty() {
                    return Ok(Profile::default());
                }
                read_profile::points(self.text, key, &points, value.span().start, unit).or_else(|(offset, fault)| {
                    self.faults.push((offset, fault));
                    Ok(Profile::default())
                })
            }
            _ => number(self.text, key, value, unit).map(Profile::Constant),
        }
    }

    /// Checks the consistency of the keys.
    fn check(&mut self) {
        let place = |name: &str| self.places.get(name).copied();
        let end = place("run.turns").or(place("run.stop")).unwrap_or(0);
        let turns_at_rest = matches!(self.found.run.end, End::Turns(_)) && self.found.scene.crank.speed_start == 0.0;
        if place("run.turns").is_some() && place("run.stop").is_some() {
            self.faults.push((end, Fault::Twice { key: "run.turns, run.stop".to_owned() }));
        } else if turns_at_rest {
            let name = "run.turns".to_owned();
            let allowed = "run.stop instead, for a crank that starts at rest".to_owned();
            let (End::Turns(value) | End::Time(value)) = self.found.run.end;
            let conflict = SceneError::Conflict { name, value, allowed };
            self.faults.push((end, Fault::Conflict(conflict)));
        }
        if let Err(error) = self.found.scene.check() {
            let offset = place(error.name()).unwrap_or(0);
            self.faults.push((offset, Fault::Conflict(error)));
        }
    }
}

/// Paths of the keys that are allowed in a table.
fn children(prefix: &str) -> Vec<String> {
    let names = PARAMETERS.iter().map(|parameter| parameter.name);
    let names = OTHER_KEYS.iter().map(|(name, _)| *name).chain(names);
    let inside = |name: &'static str| match prefix {
        "" => Some(name),
        _ => name.strip_prefix(prefix)?.strip_prefix('.'),
    };
    let mut children: Vec<String> = vec![];
    for rest in names.filter_map(inside) {
        let child = rest.split('.').next().unwrap_or(rest);
        let path = if prefix.is_empty() { child.to_owned() } else { format!("{prefix}.{child}") };
        if !children.contains(&path) {
            children.push(path);
        }
    }
    children
}
