//! A page about a scene: one HTML file with an animation and figures that can be zoomed.
//!
//! The folder `templates/` has its layout, `report.html` and `report.css`, and the animation, `report.js`.

pub mod calls;
pub mod film;

use super::interactive::{Figure, Interactive, figures, library};
use super::plot::{Role, Sheet};
use super::table::Table;
use anyhow::{Context, Result};
use askama::Template;
use film::Film;

/// One section of the page. Empty parts are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Heading.
    pub title: String,
    /// Paragraphs of text.
    pub text: Vec<String>,
    /// Legend of the curves' colours.
    pub legend: Vec<Key>,
    /// Figures side by side.
    pub figures: Vec<Figure>,
    /// Tables below the figures. The first row of each is its head.
    pub tables: Vec<Table>,
    /// The reason why the section is empty.
    pub missing: Option<String>,
}

/// An entry of a legend.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key {
    /// Colour in CSS.
    pub colour: String,
    /// Meaning.
    pub name: String,
}

impl Section {
    /// A new section with this heading.
    pub fn new(title: &str) -> Self {
        Self { title: title.into(), ..Self::default() }
    }

    /// An empty section with the reason.
    pub fn missing(title: &str, why: impl Into<String>) -> Self {
        Self { missing: Some(why.into()), ..Self::new(title) }
    }

    /// Adds a paragraph.
    pub fn saying(mut self, text: impl Into<String>) -> Self {
        self.text.push(text.into());
        self
    }

    /// Adds the panels of a sheet with its legend.
    pub fn showing<P: Interactive>(mut self, sheet: &Sheet<P>) -> Self {
        for (role, name) in &sheet.legend {
            let key = Key::of(*role, name);
            if !self.legend.contains(&key) {
                self.legend.push(key);
            }
        }
        self.figures.extend(figures(sheet));
        self
    }

    /// Adds a table.
    pub fn telling(mut self, table: Table) -> Self {
        self.tables.push(table);
        self
    }

    /// Name of the section's anchor.
    pub fn anchor(&self) -> String {
        self.title.to_lowercase().replace(' ', "-")
    }
}

impl Key {
    fn of(role: Role, name: &str) -> Self {
        let [red, green, blue] = role.colour();
        Self { colour: format!("rgb({red},{green},{blue})"), name: name.into() }
    }
}

/// The page.
#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    title: &'a str,
    description: &'a str,
    version: &'a str,
    film: String,
    sections: &'a [Section],
    style: &'a str,
    library: String,
    program: &'a str,
}

/// The page as HTML: title, a line about the scene, the animation, and the sections in their order.
///
/// # Errors
/// If a number of the animation is not finite.
pub fn page(title: &str, description: &str, film: &Film, sections: &[Section]) -> Result<String> {
    let page = Page {
        title,
        description,
        version: env!("CARGO_PKG_VERSION"),
        film: harmless(&serde_json::to_string(film).context("the animation cannot be written as JSON")?),
        sections,
        style: include_str!("../../../templates/report.css"),
        library: library(),
        program: include_str!("../../../templates/report.js"),
    };
    page.render().context("the page")
}

/// Escapes JSON, so that it cannot end the script element around it.
fn harmless(json: &str) -> String {
    json.replace('<', "\\u003c")
}

impl Figure {
    /// JSON for a script element.
    fn data(&self) -> String {
        harmless(&self.json)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_in_the_data_ends_the_script() {
        let mut table = Table::default();
        table.row(["</table><script>alert(1)</script>"]);
        let section = Section::new("a <b>").saying("x < y").telling(table);
        let figure = Figure { json: "{\"a\":\"</script>\"}".into(), square: false, over_turns: false };
        let sections = [Section { figures: vec![figure], ..section }];
        let html = page("t", "d", &Film::default(), &sections).expect("a page");
        let own = html.split("<body>").nth(1).expect("a body");
        assert!(own.contains("x &#60; y") && own.contains("{\"a\":\"\\u003c/script>\"}"), "{own}");
        assert!(!own.contains("alert(1)</script>"), "{own}");
    }
}
