//! `variables.toml` → typed rows. What cannot be declared is refused here, with its line.

use super::raw::{AtStart, Raw, RawRow, RawStart};
pub use super::raw::{
    BaseUnit, DisplayUnit, Enumeration, Experiment, Flag, Item, LogCategory, Model, RealType, Unit,
};
use std::collections::{BTreeMap, HashSet};
use std::fmt;

/// Everything that `variables.toml` says.
pub struct Declaration {
    /// What the FMU is called.
    pub model: Model,
    /// Capability flags by the standard's names.
    pub capabilities: BTreeMap<String, Flag>,
    /// Default experiment.
    pub experiment: Experiment,
    /// Categories of log messages.
    pub log: Vec<LogCategory>,
    /// Units with their display units.
    pub units: Vec<Unit>,
    /// Types of real variables.
    pub types: Vec<RealType>,
    /// Types of enumerations.
    pub enumerations: Vec<Enumeration>,
    /// Titles of the groups of rows.
    pub groups: Vec<String>,
    /// The variables; a row's index is its value reference.
    pub rows: Vec<Row>,
}

/// One variable.
pub struct Row {
    /// Name on the FMU's face.
    pub name: String,
    /// The name before expansion, the same for every row of a template.
    pub template: String,
    /// The letters that the template stands for.
    pub letters: Vec<String>,
    /// Index of the group.
    pub group: usize,
    /// One line of explanation.
    pub description: String,
    /// The Rust field that it means.
    pub field: String,
    /// Type and range.
    pub kind: Kind,
    /// What a host may do with it, and when it changes.
    pub role: Role,
}

/// Type and range of a variable.
pub enum Kind {
    /// A number of the real type with this index.
    Real {
        /// Index of the type.
        of: usize,
        /// Least legal value, in SI units.
        min: Option<f64>,
        /// Greatest legal value, in SI units.
        max: Option<f64>,
        /// Usual size, in SI units.
        nominal: Option<f64>,
        /// May grow for ever, as an angle does.
        unbounded: bool,
    },
    /// A whole number.
    Integer {
        /// Least value.
        min: Option<i32>,
        /// Greatest value.
        max: Option<i32>,
    },
    /// True or false.
    Boolean,
    /// An item of the enumeration with this index.
    Enumeration {
        /// Index of the enumeration.
        of: usize,
    },
}

/// Causality, variability and what they ask for.
pub enum Role {
    /// A continuous input.
    Input {
        /// In SI units.
        start: f64,
    },
    /// An output: continuous if real, discrete otherwise.
    Output {
        /// Rows of the inputs that it feels at once.
        depends: Vec<usize>,
        /// Rows that it depends on at the start; `None`: all inputs and parameters.
        at_start: Option<Vec<usize>>,
    },
    /// A fixed parameter.
    Parameter {
        /// In SI units; an enumeration's by its item's value.
        start: f64,
    },
}

/// A declaration that cannot be.
#[derive(Debug)]
pub struct RowError {
    /// Line of variables.toml, from 1.
    pub line: usize,
    /// What is wrong there.
    pub fault: Fault,
}

/// What is wrong with a declaration.
#[derive(Debug)]
pub enum Fault {
    /// Not TOML, or not of this form.
    Toml(String),
    /// No such causality, variability and type in FMI 2.0, or not one that we use.
    Triple {
        /// As declared.
        causality: String,
        /// As declared.
        variability: String,
        /// Type as declared.
        kind: String,
    },
    /// An attribute is missing.
    Missing(&'static str),
    /// An attribute has no meaning here.
    Superfluous(&'static str),
    /// Not min ≤ start ≤ max, or a nominal that is not positive.
    Range,
    /// A type, item, group or variable that is not declared.
    Unknown(String),
    /// Declared twice.
    Duplicate(String),
    /// Not a name of the structured convention.
    Name(String),
}

impl fmt::Display for RowError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "modelDescription/variables.toml:{}: ", self.line)?;
        match &self.fault {
            Fault::Toml(text) => f.write_str(text),
            Fault::Triple {
                causality,
                variability,
                kind,
            } => {
                write!(
                    f,
                    "a variable cannot be {causality}, {variability} and {kind}"
                )
            }
            Fault::Missing(attribute) => write!(f, "`{attribute}` is missing"),
            Fault::Superfluous(attribute) => write!(f, "`{attribute}` has no meaning here"),
            Fault::Range => f.write_str("not min <= start <= max and nominal > 0"),
            Fault::Unknown(name) => write!(f, "`{name}` is not declared"),
            Fault::Duplicate(name) => write!(f, "`{name}` is declared twice"),
            Fault::Name(name) => write!(f, "`{name}` is not a structured name"),
        }
    }
}

impl std::error::Error for RowError {}

/// Reads a declaration.
pub fn read(text: &str) -> Result<Declaration, RowError> {
    let raw: Raw = toml::from_str(text).map_err(|error| RowError {
        line: line_of(text, error.span().map_or(0, |span| span.start)),
        fault: Fault::Toml(error.message().to_owned()),
    })?;
    let mut rows: Vec<(usize, Row, RawRow)> = vec![];
    for (group, raw_group) in raw.group.iter().enumerate() {
        for spanned in &raw_group.rows {
            let line = line_of(text, spanned.span().start);
            let row = spanned.get_ref();
            let letters: Vec<&str> = if row.letters.is_empty() {
                vec![""]
            } else {
                row.letters.iter().map(String::as_str).collect()
            };
            for letter in letters {
                let row = row.expanded(letter);
                let typed = typed(
                    &row,
                    group,
                    &raw_group.causality,
                    &raw_group.variability,
                    &raw,
                )
                .map_err(|fault| RowError { line, fault })?;
                rows.push((line, typed, row));
            }
        }
    }
    refuse_duplicates(&rows)?;
    let names: Vec<(String, bool)> = rows
        .iter()
        .map(|(_, row, _)| (row.name.clone(), matches!(row.role, Role::Output { .. })))
        .collect();
    for (line, row, raw_row) in &mut rows {
        if let Role::Output { depends, at_start } = &mut row.role {
            let line = *line;
            let fail = |fault| RowError { line, fault };
            *depends = resolve(raw_row.depends.iter().flatten(), &names, &raw.start_groups)
                .map_err(fail)?;
            *at_start = match &raw_row.at_start {
                Some(AtStart::Of(list)) => {
                    Some(resolve(list.iter(), &names, &raw.start_groups).map_err(fail)?)
                }
                _ => None,
            };
        }
    }
    Ok(Declaration {
        model: raw.model,
        capabilities: raw.capabilities,
        experiment: raw.experiment,
        log: raw.log,
        units: raw.unit,
        types: raw.types,
        enumerations: raw.enumeration,
        groups: raw.group.into_iter().map(|group| group.title).collect(),
        rows: rows.into_iter().map(|(_, row, _)| row).collect(),
    })
}

/// A row with its type looked up and its causality, variability and type found legal.
fn typed(
    row: &RawRow,
    group: usize,
    causality: &str,
    variability: &str,
    raw: &Raw,
) -> Result<Row, Fault> {
    if !is_structured(&row.name) {
        return Err(Fault::Name(row.name.clone()));
    }
    let kind = kind(row, raw)?;
    let role = match (causality, variability, &kind) {
        ("input", "continuous", Kind::Real { .. }) => Role::Input {
            start: number(&row.start)?,
        },
        ("output", "continuous", Kind::Real { .. })
        | ("output", "discrete", Kind::Integer { .. } | Kind::Boolean) => {
            row.depends.as_ref().ok_or(Fault::Missing("depends"))?;
            match &row.at_start {
                None => return Err(Fault::Missing("at_start")),
                Some(AtStart::Word(word)) if word != "everything" => {
                    return Err(Fault::Unknown(word.clone()));
                }
                Some(_) if row.start.is_some() => return Err(Fault::Superfluous("start")),
                Some(_) => Role::Output {
                    depends: vec![],
                    at_start: None,
                },
            }
        }
        ("parameter", "fixed", Kind::Real { min, max, .. }) => {
            min.ok_or(Fault::Missing("min"))?;
            max.ok_or(Fault::Missing("max"))?;
            Role::Parameter {
                start: number(&row.start)?,
            }
        }
        ("parameter", "fixed", Kind::Enumeration { of }) => {
            let Some(RawStart::Item(name)) = &row.start else {
                return Err(Fault::Missing("start"));
            };
            let item = raw.enumeration[*of]
                .items
                .iter()
                .find(|item| item.name == *name);
            Role::Parameter {
                start: f64::from(item.ok_or_else(|| Fault::Unknown(name.clone()))?.value),
            }
        }
        _ => {
            return Err(Fault::Triple {
                causality: causality.into(),
                variability: variability.into(),
                kind: row.of_type.clone(),
            });
        }
    };
    if !matches!(role, Role::Output { .. }) && (row.depends.is_some() || row.at_start.is_some()) {
        return Err(Fault::Superfluous("depends, at_start"));
    }
    in_order(&kind, &role)?;
    Ok(Row {
        name: row.name.clone(),
        template: row.template.clone(),
        letters: row.letters.clone(),
        group,
        description: row.description.clone(),
        field: row.field.clone(),
        kind,
        role,
    })
}

/// The row's type, declared or built in.
fn kind(row: &RawRow, raw: &Raw) -> Result<Kind, Fault> {
    let whole = |bound: Option<f64>| bound.map(|bound| bound as i32);
    if let Some(of) = raw
        .types
        .iter()
        .position(|declared| declared.name == row.of_type)
    {
        let RawRow {
            min,
            max,
            nominal,
            unbounded,
            ..
        } = *row;
        return Ok(Kind::Real {
            of,
            min,
            max,
            nominal,
            unbounded,
        });
    }
    if row.nominal.is_some() || row.unbounded {
        return Err(Fault::Superfluous("nominal, unbounded"));
    }
    match row.of_type.as_str() {
        "Integer" => Ok(Kind::Integer {
            min: whole(row.min),
            max: whole(row.max),
        }),
        _ if row.min.is_some() || row.max.is_some() => Err(Fault::Superfluous("min, max")),
        "Boolean" => Ok(Kind::Boolean),
        name => {
            let of = raw
                .enumeration
                .iter()
                .position(|declared| declared.name == name);
            Ok(Kind::Enumeration {
                of: of.ok_or_else(|| Fault::Unknown(name.into()))?,
            })
        }
    }
}

/// Refuses numbers that contradict each other.
fn in_order(kind: &Kind, role: &Role) -> Result<(), Fault> {
    let Kind::Real {
        min, max, nominal, ..
    } = kind
    else {
        return Ok(());
    };
    let (min, max) = (
        min.unwrap_or(f64::NEG_INFINITY),
        max.unwrap_or(f64::INFINITY),
    );
    let start = match role {
        Role::Input { start } | Role::Parameter { start } => *start,
        Role::Output { .. } => min.max(0.0).min(max),
    };
    let ordered = min <= start && start <= max && nominal.is_none_or(|nominal| nominal > 0.0);
    if ordered { Ok(()) } else { Err(Fault::Range) }
}

/// A start value that must be a number.
fn number(start: &Option<RawStart>) -> Result<f64, Fault> {
    match start {
        Some(RawStart::Number(number)) => Ok(*number),
        _ => Err(Fault::Missing("start")),
    }
}

/// Refuses two variables of the same name.
fn refuse_duplicates(rows: &[(usize, Row, RawRow)]) -> Result<(), RowError> {
    let mut seen = HashSet::new();
    match rows.iter().find(|(_, row, _)| !seen.insert(&row.name)) {
        Some((line, row, _)) => Err(RowError {
            line: *line,
            fault: Fault::Duplicate(row.name.clone()),
        }),
        None => Ok(()),
    }
}

/// Groups, names and patterns → rows of inputs and parameters, in order.
fn resolve<'a>(
    words: impl Iterator<Item = &'a String>,
    names: &[(String, bool)],
    groups: &BTreeMap<String, Vec<String>>,
) -> Result<Vec<usize>, Fault> {
    let mut found = vec![];
    for word in words {
        for pattern in groups
            .get(word)
            .map_or(std::slice::from_ref(word), Vec::as_slice)
        {
            let before = found.len();
            let hits = names
                .iter()
                .enumerate()
                .filter(|(_, (name, output))| !output && fits(pattern, name));
            found.extend(hits.map(|(row, _)| row));
            if found.len() == before {
                return Err(Fault::Unknown(pattern.clone()));
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    Ok(found)
}

/// Whether a name has the pattern's parts, `*` standing for any one part.
fn fits(pattern: &str, name: &str) -> bool {
    pattern.split('.').count() == name.split('.').count()
        && pattern
            .split('.')
            .zip(name.split('.'))
            .all(|(wanted, part)| wanted == "*" || wanted == part)
}

/// Identifiers joined by dots: the part of the structured convention that we use.
fn is_structured(name: &str) -> bool {
    let word = |part: &str| {
        part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    name.split('.').all(word)
}

/// Line of a byte offset, from 1.
fn line_of(text: &str, offset: usize) -> usize {
    1 + text
        .bytes()
        .take(offset)
        .filter(|byte| *byte == b'\n')
        .count()
}
