//! A panel with the names of its curves at its side, for more curves than fit into one line of a legend.

use super::loglog::LogLog;
use super::plot::{Area, Drawn, FINE, INK, Paint, Role, font};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// [pixel] Space for the names.
const NAMES: u32 = 260;
/// [pixel] Height of a line, position of the first line, length of a sample.
const LINE: f64 = 20.0;
const FIRST: f64 = 34.0;
const SAMPLE: f64 = 26.0;

/// A panel, its heading and its names.
pub struct Named {
    /// Heading above the names.
    pub heading: String,
    /// The curves.
    pub panel: LogLog,
    /// Names of the curves.
    pub names: Vec<(Role, String)>,
}

impl Paint for Named {
    fn draw(&self, area: &Area) -> Drawn {
        let at = |x: f64, y: f64| ((x * f64::from(FINE)) as i32, (y * f64::from(FINE)) as i32);
        let width = area.dim_in_pixel().0;
        let (curves, names) = area.split_horizontally(width - NAMES * FINE);
        self.panel.draw(&curves)?;
        let style = |size: f64| font(size).pos(Pos::new(HPos::Left, VPos::Center));
        names.draw(&Text::new(self.heading.as_str(), at(0.0, FIRST - 1.3 * LINE), style(14.0).color(&INK)))?;
        for (number, (role, name)) in self.names.iter().enumerate() {
            let y = FIRST + LINE * number as f64;
            names.draw(&PathElement::new(vec![at(0.0, y), at(SAMPLE, y)], role.style()))?;
            names.draw(&Circle::new(at(0.5 * SAMPLE, y), 3 * FINE as i32, role.dot()))?;
            names.draw(&Text::new(name.as_str(), at(SAMPLE + 8.0, y), style(12.5)))?;
        }
        Ok(())
    }
}
