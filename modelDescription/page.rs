//! Rows → `documentation/index.html`: the prose of page.html with the tables filled in.

use super::number::number;
use super::restitution::{ASKED, DELIVERED};
use super::rows::{Declaration, Kind, Role, Row};

/// What a page says of its package.
pub struct Subject<'a> {
    /// Name and description of the scene.
    pub scene: &'a str,
    /// Start values of the parameters, in order.
    pub starts: &'a [f64],
    /// Numbers of bending and of axial modes of the rod's table, if there is one.
    pub modes: Option<[usize; 2]>,
    /// Below it some damping laws refuse.
    pub least_restitution: f64,
}

/// Off by more than this, a restitution is marked.
const FAR: f64 = 0.05;

/// The documentation page.
pub fn write(declaration: &Declaration, subject: &Subject) -> String {
    let starts = starts(declaration, subject.starts);
    let is_parameter = |row: &Row| matches!(row.role, Role::Parameter { .. });
    include_str!("page.html")
        .replace("{{version}}", env!("CARGO_PKG_VERSION"))
        .replace("{{description}}", &escaped(&declaration.model.description))
        .replace("{{scene}}", &escaped(subject.scene))
        .replace("{{modes}}", &modes(subject.modes))
        .replace("{{least_restitution}}", &subject.least_restitution.to_string())
        .replace("{{signals}}", &groups(declaration, &starts, |row| !is_parameter(row)))
        .replace("{{parameters}}", &groups(declaration, &starts, is_parameter))
        .replace("{{enumerations}}", &enumerations(declaration))
        .replace("{{restitution}}", &restitution())
}

/// Whether this package has a table of modes.
fn modes(modes: Option<[usize; 2]>) -> String {
    match modes {
        None => "this one has none.".to_owned(),
        Some([bending, axial]) => {
            format!(
                "this one has a table of {bending} bending and {axial} axial modes, <code>modes.toml</code> beside this page."
            )
        }
    }
}

/// Start value of each row, where it has one.
fn starts(declaration: &Declaration, parameters: &[f64]) -> Vec<Option<f64>> {
    let mut parameters = parameters.iter().copied();
    let start = |row: &Row| match row.role {
        Role::Input { start } => Some(start),
        Role::Output { .. } => None,
        Role::Parameter { start } => Some(parameters.next().unwrap_or(start)),
    };
    declaration.rows.iter().map(start).collect()
}

/// A titled table for each group that has such rows.
fn groups(declaration: &Declaration, starts: &[Option<f64>], wanted: impl Fn(&Row) -> bool) -> String {
    let mut out = String::new();
    for (index, title) in declaration.groups.iter().enumerate() {
        let rows: Vec<usize> = (0..declaration.rows.len())
            .filter(|row| declaration.rows[*row].group == index && wanted(&declaration.rows[*row]))
            .collect();
        if rows.is_empty() {
            continue;
        }
        let has_start = rows.iter().any(|row| starts[*row].is_some());
        let start = if has_start { "<th>start</th><th>range</th>" } else { "" };
        out += &format!("<h3>{}</h3>\n<table>\n", escaped(title));
        out += &format!("<tr><th>name</th><th>type</th>{start}<th>meaning</th></tr>\n");
        // The rows of one template follow each other.
        for same in rows.chunk_by(|a, b| declaration.rows[*a].template == declaration.rows[*b].template) {
            out += &line(declaration, starts, same);
        }
        out += "</table>\n";
    }
    out
}

/// The table's line for all rows of one template.
fn line(declaration: &Declaration, starts: &[Option<f64>], same: &[usize]) -> String {
    let row = &declaration.rows[same[0]];
    let name = match row.letters[..] {
        [] => format!("<code>{}</code>", row.name),
        _ => format!("<code>{}</code>, J = {}", row.template.replace("{J}", "J"), row.letters.join(", ")),
    };
    let cells: Vec<String> = same.iter().filter_map(|row| Some(shown(declaration, *row, starts[*row]?))).collect();
    let start = match &cells[..] {
        [] => String::new(),
        [first, rest @ ..] if rest.iter().all(|cell| cell == first) => {
            format!("<td>{first}</td><td>{}</td>", range(declaration, row))
        }
        _ => {
            let each: Vec<String> =
                row.letters.iter().zip(&cells).map(|(letter, cell)| format!("{letter}: {cell}")).collect();
            format!("<td>{}</td><td>{}</td>", each.join("<br>"), range(declaration, row))
        }
    };
    let description = escaped(&row.meaning);
    format!("<tr><td>{name}</td><td>{}</td>{start}<td>{description}</td></tr>\n", type_of(declaration, row))
}

fn type_of(declaration: &Declaration, row: &Row) -> String {
    match row.kind {
        Kind::Real { of, .. } => match declaration.types[of].unit.as_str() {
            "1" => "real".to_owned(),
            unit => format!("real, {unit}"),
        },
        Kind::Integer { .. } => "integer".to_owned(),
        Kind::Boolean => "boolean".to_owned(),
        Kind::Enumeration { of } => declaration.enumerations[of].name.clone(),
    }
}

/// A start value, in the display unit too where there is one.
fn shown(declaration: &Declaration, row: usize, start: f64) -> String {
    match declaration.rows[row].kind {
        Kind::Enumeration { of } => {
            let items = &declaration.enumerations[of].items;
            let item = items.iter().find(|item| f64::from(item.value) == start);
            item.map_or_else(String::new, |item| format!("<code>{}</code>", item.name))
        }
        Kind::Boolean => format!("<code>{}</code>", start != 0.0),
        Kind::Real { of, .. } if start != 0.0 => {
            let of = &declaration.types[of];
            let unit = declaration.units.iter().find(|unit| unit.name == of.unit);
            let display =
                unit.and_then(|unit| unit.display.iter().find(|display| Some(&display.name) == of.display.as_ref()));
            display.map_or(number(start), |display| {
                // The display factor rounds: nine digits are enough to show.
                let value = format!("{:.8e}", start * display.factor).parse().unwrap_or(start);
                format!("{} ({} {})", number(start), number(value), display.name)
            })
        }
        _ => number(start),
    }
}

fn range(declaration: &Declaration, row: &Row) -> String {
    match row.kind {
        Kind::Real { min: Some(min), max: Some(max), .. } => {
            format!("{} to {}", number(min), number(max))
        }
        Kind::Integer { min: Some(min), max: Some(max) } => format!("{min} to {max}"),
        Kind::Boolean => "<code>true</code> or <code>false</code>".to_owned(),
        Kind::Enumeration { of } => {
            let items = declaration.enumerations[of].items.len();
            format!("1 to {items}, below")
        }
        _ => String::new(),
    }
}

fn enumerations(declaration: &Declaration) -> String {
    let mut out = String::new();
    for enumeration in &declaration.enumerations {
        out += &format!("<h3>{}</h3>\n", enumeration.name);
        out += &format!("<p>{}</p>\n<table>\n", escaped(&enumeration.description));
        out += "<tr><th>value</th><th>name</th><th>meaning</th></tr>\n";
        for item in &enumeration.items {
            let (value, name, meaning) = (item.value, &item.name, escaped(&item.description));
            out += &format!("<tr><td>{value}</td><td><code>{name}</code></td><td>{meaning}</td></tr>\n");
        }
        out += "</table>\n";
    }
    out
}

fn restitution() -> String {
    let head: String = ASKED.iter().map(|asked| format!("<th>{asked}</th>")).collect();
    let mut out = format!("<table>\n<tr><th>law</th>{head}</tr>\n");
    for (law, delivered) in DELIVERED {
        out += &format!("<tr><td><code>{law}</code></td>");
        for (asked, delivered) in ASKED.into_iter().zip(delivered) {
            let far = if (asked - delivered).abs() > FAR { " far" } else { "" };
            out += &format!("<td class=\"number{far}\">{delivered:.3}</td>");
        }
        out += "</tr>\n";
    }
    out + "</table>\n"
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
