//! `variables.toml` → typed rows. What cannot be declared is refused here, with its line.

pub use super::fault::{Fault, RowError};
use super::raw::{AtStart, Raw, RawRow};
pub use super::raw::{Enumeration, Experiment, Flag, LogCategory, Model, RealType, Terminal, Unit};
use super::typed::typed;
use std::collections::{BTreeMap, HashSet};

/// Everything that `variables.toml` says.
pub struct Declaration {
    /// What the FMU is called.
    pub model: Model,
    /// Capability flags by the standard's names.
    pub capabilities: BTreeMap<String, Flag>,
    /// What the element ModelExchange promises.
    pub model_exchange: BTreeMap<String, Flag>,
    /// The capability flags of FMI 3.0.
    pub capabilities_fmi3: BTreeMap<String, Flag>,
    /// What FMI 3.0's element ModelExchange promises.
    pub model_exchange_fmi3: BTreeMap<String, Flag>,
    /// Terminals of FMI 3.0.
    pub terminals: Vec<Terminal>,
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
    /// One line of explanation, of no other variable.
    pub description: String,
    /// The same for all rows of the template, with `J` for the letter.
    pub meaning: String,
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
    /// An output.
    Output {
        /// Whether it changes between communication points rather than in jumps.
        continuous: bool,
        /// Rows of the inputs that it feels at once.
        depends: Vec<usize>,
        /// Rows that it depends on at the start; `None`: all inputs and parameters.
        at_start: Option<Vec<usize>>,
    },
    /// A fixed parameter.
    Parameter {
        /// In SI units; an enumeration's by its item's value, a Boolean's as 0 or 1.
        start: f64,
    },
}

/// A row in the making: its line, as it is typed and as it was written.
type Draft = (usize, Row, RawRow);

/// Reads a declaration.
pub fn read(text: &str) -> Result<Declaration, RowError> {
    let raw: Raw = toml::from_str(text).map_err(|error| RowError {
        line: line_of(&line_ends(text), error.span().map_or(0, |span| span.start)),
        fault: Fault::Toml(error.message().to_owned()),
    })?;
    let mut drafts = drafts(text, &raw)?;
    refuse_duplicates(&drafts)?;
    refuse_disorder(text, &raw.enumeration)?;
    link(&mut drafts, &raw.start_groups)?;
    refuse_unknown_members(text, &raw.terminal, &drafts)?;
    Ok(Declaration {
        model: raw.model,
        capabilities: raw.capabilities,
        model_exchange: raw.model_exchange,
        capabilities_fmi3: raw.capabilities_fmi3,
        model_exchange_fmi3: raw.model_exchange_fmi3,
        terminals: raw.terminal,
        experiment: raw.experiment,
        log: raw.log,
        units: raw.unit,
        types: raw.types,
        enumerations: raw.enumeration,
        groups: raw.group.into_iter().map(|group| group.title).collect(),
        rows: drafts.into_iter().map(|(_, row, _)| row).collect(),
    })
}

/// Every row for each of its letters, typed; what it depends on is still open.
fn drafts(text: &str, raw: &Raw) -> Result<Vec<Draft>, RowError> {
    let mut drafts = vec![];
    let ends = line_ends(text);
    for (index, group) in raw.group.iter().enumerate() {
        for spanned in &group.rows {
            let line = line_of(&ends, spanned.span().start);
            for row in spanned.get_ref().expanded() {
                let typed = typed(&row, index, raw).map_err(|fault| RowError { line, fault })?;
                drafts.push((line, typed, row));
            }
        }
    }
    Ok(drafts)
}

/// Finds the rows that each output depends on.
fn link(drafts: &mut [Draft], groups: &BTreeMap<String, Vec<String>>) -> Result<(), RowError> {
    let known = |(index, (_, row, _)): (usize, &Draft)| match row.role {
        Role::Input { .. } => Some((index, row.name.clone(), true)),
        Role::Parameter { .. } => Some((index, row.name.clone(), false)),
        Role::Output { .. } => None,
    };
    let knowns: Vec<Known> = drafts.iter().enumerate().filter_map(known).collect();
    let inputs: Vec<Known> = knowns.iter().filter(|(_, _, input)| *input).cloned().collect();
    for (line, row, written) in drafts {
        let Role::Output { depends, at_start, .. } = &mut row.role else {
            continue;
        };
        let fail = |fault| RowError { line: *line, fault };
        *depends = resolve(written.depends.iter().flatten(), &inputs, groups).map_err(fail)?;
        if let Some(AtStart::Of(list)) = &written.at_start {
            *at_start = Some(resolve(list.iter(), &knowns, groups).map_err(fail)?);
        }
    }
    Ok(())
}

/// Row, name, and whether it is an input.
type Known = (usize, String, bool);

/// Groups, names and patterns → rows, in order.
fn resolve<'a>(
    words: impl Iterator<Item = &'a String>,
    knowns: &[Known],
    groups: &BTreeMap<String, Vec<String>>,
) -> Result<Vec<usize>, Fault> {
    let mut found = vec![];
    for word in words {
        for pattern in groups.get(word).map_or(std::slice::from_ref(word), Vec::as_slice) {
            let before = found.len();
            let hits = knowns.iter().filter(|(_, name, _)| fits(pattern, name));
            found.extend(hits.map(|(row, ..)| *row));
            if found.len() == before {
                return Err(Fault::Unknown(pattern.clone()));
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    Ok(found)
}

/// Refuses terminals with variables that do not exist.
fn refuse_unknown_members(text: &str, terminals: &[Terminal], drafts: &[Draft]) -> Result<(), RowError> {
    let mut members = terminals.iter().flat_map(|terminal| &terminal.members);
    match members.find(|member| drafts.iter().all(|(_, row, _)| row.name != *member.variable.get_ref())) {
        Some(member) => Err(RowError {
            line: line_of(&line_ends(text), member.variable.span().start),
            fault: Fault::Unknown(member.variable.get_ref().clone()),
        }),
        None => Ok(()),
    }
}

/// Refuses two variables of the same name or of the same description.
fn refuse_duplicates(drafts: &[Draft]) -> Result<(), RowError> {
    let mut seen = HashSet::new();
    for (line, row, _) in drafts {
        for words in [&row.name, &row.description] {
            if !seen.insert(words) {
                return Err(RowError { line: *line, fault: Fault::Duplicate(words.clone()) });
            }
        }
    }
    Ok(())
}

/// Refuses an enumeration whose items do not rise in value, at the first that does not.
fn refuse_disorder(text: &str, enumerations: &[Enumeration]) -> Result<(), RowError> {
    let place = |from: usize, name: &str| from + text[from..].find(&format!("name = {name:?}")).unwrap_or_default();
    for Enumeration { name, items, .. } in enumerations {
        if let Some(pair) = items.windows(2).find(|pair| pair[0].value >= pair[1].value) {
            let line = line_of(&line_ends(text), place(place(0, name), &pair[1].name));
            return Err(RowError { line, fault: Fault::Disorder(name.clone()) });
        }
    }
    Ok(())
}

/// Whether a name has the pattern's parts, `*` standing for any one part.
fn fits(pattern: &str, name: &str) -> bool {
    pattern.split('.').count() == name.split('.').count()
        && pattern.split('.').zip(name.split('.')).all(|(wanted, part)| wanted == "*" || wanted == part)
}

/// Line of a byte offset, from 1, in a text whose lines end at these places.
fn line_of(ends: &[usize], offset: usize) -> usize {
    1 + ends.partition_point(|end| *end < offset)
}

/// Places at which the lines of a text end.
fn line_ends(text: &str) -> Vec<usize> {
    text.match_indices('\n').map(|(place, _)| place).collect()
}
