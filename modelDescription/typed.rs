//! One row as written → one typed row, if FMI 2.0 knows such a variable and we use it.

use super::fault::Fault;
use super::raw::{AtStart, Raw, RawRow, RawStart};
use super::rows::{Kind, Role, Row};

/// A row with its type looked up and its causality, variability and type found legal.
pub(super) fn typed(row: &RawRow, index: usize, raw: &Raw) -> Result<Row, Fault> {
    let group = &raw.group[index];
    if !is_structured(&row.name) {
        return Err(Fault::Name(row.name.clone()));
    }
    let kind = kind(row, raw)?;
    let role = match (group.causality.as_str(), group.variability.as_str(), &kind) {
        ("input", "continuous", Kind::Real { .. }) => Role::Input { start: number(&row.start)? },
        ("output", variability @ "continuous", Kind::Real { .. })
        | ("output", variability @ "discrete", Kind::Real { .. } | Kind::Integer { .. } | Kind::Boolean) => {
            row.depends.as_ref().ok_or(Fault::Missing("depends"))?;
            match &row.at_start {
                None => return Err(Fault::Missing("at_start")),
                Some(AtStart::Word(word)) if word != "everything" => {
                    return Err(Fault::Unknown(word.clone()));
                }
                Some(_) if row.start.is_some() => return Err(Fault::Superfluous("start")),
                Some(_) => Role::Output { continuous: variability == "continuous", depends: vec![], at_start: None },
            }
        }
        ("parameter", "fixed", Kind::Real { .. } | Kind::Integer { .. }) => {
            row.min.ok_or(Fault::Missing("min"))?;
            row.max.ok_or(Fault::Missing("max"))?;
            Role::Parameter { start: number(&row.start)? }
        }
        ("parameter", "fixed", Kind::Boolean) => match row.start {
            Some(RawStart::Boolean(start)) => Role::Parameter { start: f64::from(u8::from(start)) },
            _ => return Err(Fault::Missing("start")),
        },
        ("parameter", "fixed", Kind::Enumeration { of }) => {
            let Some(RawStart::Item(name)) = &row.start else {
                return Err(Fault::Missing("start"));
            };
            let item = raw.enumeration[*of].items.iter().find(|item| item.name == *name);
            Role::Parameter { start: f64::from(item.ok_or_else(|| Fault::Unknown(name.clone()))?.value) }
        }
        _ => {
            return Err(Fault::Triple {
                causality: group.causality.clone(),
                variability: group.variability.clone(),
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
        group: index,
        description: row.description.clone(),
        meaning: row.meaning.clone(),
        field: row.field.clone(),
        kind,
        role,
    })
}

/// The row's type, declared or built in.
fn kind(row: &RawRow, raw: &Raw) -> Result<Kind, Fault> {
    if let Some(of) = raw.types.iter().position(|declared| declared.name == row.of_type) {
        let RawRow { min, max, nominal, unbounded, .. } = *row;
        return Ok(Kind::Real { of, min, max, nominal, unbounded });
    }
    if row.nominal.is_some() || row.unbounded {
        return Err(Fault::Superfluous("nominal, unbounded"));
    }
    match row.of_type.as_str() {
        "Integer" => Ok(Kind::Integer { min: row.min.map(whole).transpose()?, max: row.max.map(whole).transpose()? }),
        _ if row.min.is_some() || row.max.is_some() => Err(Fault::Superfluous("min, max")),
        "Boolean" => Ok(Kind::Boolean),
        name => {
            let of = raw.enumeration.iter().position(|declared| declared.name == name);
            Ok(Kind::Enumeration { of: of.ok_or_else(|| Fault::Unknown(name.into()))? })
        }
    }
}

/// The integer that a number is.
fn whole(number: f64) -> Result<i32, Fault> {
    // The cast saturates: what is no 32-bit integer does not come back as it went.
    if f64::from(number as i32) == number { Ok(number as i32) } else { Err(Fault::Fraction(number)) }
}

/// Refuses numbers that contradict each other.
fn in_order(kind: &Kind, role: &Role) -> Result<(), Fault> {
    let (min, max, nominal) = match *kind {
        Kind::Real { min, max, nominal, .. } => (min, max, nominal),
        Kind::Integer { min, max } => (min.map(f64::from), max.map(f64::from), None),
        Kind::Boolean | Kind::Enumeration { .. } => return Ok(()),
    };
    let (min, max) = (min.unwrap_or(f64::NEG_INFINITY), max.unwrap_or(f64::INFINITY));
    let start = match role {
        Role::Input { start } | Role::Parameter { start } => *start,
        Role::Output { .. } => min.max(0.0).min(max),
    };
    if matches!(kind, Kind::Integer { .. }) {
        whole(start)?;
    }
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

/// Identifiers joined by dots: the part of the structured convention that we use.
fn is_structured(name: &str) -> bool {
    let word = |part: &str| {
        part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    name.split('.').all(word)
}
