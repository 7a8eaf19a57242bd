//! Bars on a logarithmic scale, in named rows.

use super::plot::{Area, Drawn, FINE, GRID, INK, Paint, Role, font};
use super::units::grouped;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// [pixel] Space for the rows' names and for the labels behind the bars.
const NAMES: f64 = 128.0;
const BEHIND: f64 = 84.0;
/// [pixel] Space for the scale's numbers and its name.
const SCALE: f64 = 56.0;
/// [pixel] Space above.
const ABOVE: f64 = 10.0;
/// Minimum length of a bar, in decades.
const CLEAR: f64 = 0.3;
/// Share of a row's height that its bars take.
const FILLED: f64 = 0.74;

/// One bar.
pub struct Bar {
    /// Length in the unit of the scale, above 0.
    pub value: f64,
    /// Role, which determines the colour.
    pub role: Role,
    /// Label behind the bar.
    pub label: String,
}

/// A panel of bars.
pub struct Bars {
    /// Name and unit of the scale.
    pub label: String,
    /// Names and bars of the rows, from top to bottom.
    pub rows: Vec<(String, Vec<Bar>)>,
}

impl Bars {
    /// Range of the scale in powers of ten, from well below the shortest bar to the longest bar.
    fn decades(&self) -> (i32, i32) {
        let values = || self.rows.iter().flat_map(|(_, bars)| bars).map(|bar| bar.value.log10());
        let low = (values().fold(f64::INFINITY, f64::min) - CLEAR).floor();
        let high = values().fold(f64::NEG_INFINITY, f64::max).ceil();
        if low < high { (low as i32, high as i32) } else { (0, 1) }
    }
}

impl Paint for Bars {
    fn draw(&self, area: &Area) -> Drawn {
        let at = |x: f64, y: f64| ((x * f64::from(FINE)) as i32, (y * f64::from(FINE)) as i32);
        let (width, height) = area.dim_in_pixel();
        let (width, height) = (f64::from(width / FINE), f64::from(height / FINE));
        let (low, high) = self.decades();
        let (right, floor) = (width - BEHIND, height - SCALE);
        let x = |exponent: f64| NAMES + (right - NAMES) * (exponent - f64::from(low)) / f64::from(high - low);
        let anchored = |size: f64, h: HPos, v: VPos| font(size).pos(Pos::new(h, v));

        for decade in low..=high {
            let x = x(f64::from(decade));
            area.draw(&PathElement::new(vec![at(x, ABOVE), at(x, floor)], GRID.stroke_width(FINE)))?;
            let number = if decade < 0 { format!("{}", 10f64.powi(decade)) } else { grouped(10f64.powi(decade)) };
            area.draw(&Text::new(number, at(x, floor + 7.0), anchored(12.0, HPos::Center, VPos::Top)))?;
        }
        let middle = at(0.5 * (NAMES + right), floor + 28.0);
        area.draw(&Text::new(self.label.as_str(), middle, anchored(13.0, HPos::Center, VPos::Top)))?;

        let row_height = (floor - ABOVE) / self.rows.len().max(1) as f64;
        for (row, (name, bars)) in self.rows.iter().enumerate() {
            let top = ABOVE + row_height * (row as f64 + 0.5 * (1.0 - FILLED));
            let name_at = at(NAMES - 8.0, top + 0.5 * FILLED * row_height);
            area.draw(&Text::new(name.as_str(), name_at, anchored(12.5, HPos::Right, VPos::Center)))?;
            let thickness = FILLED * row_height / bars.len().max(1) as f64;
            for (place, bar) in bars.iter().enumerate() {
                let (upper, end) = (top + thickness * place as f64, x(bar.value.log10()));
                let corners = [at(NAMES, upper), at(end, upper + thickness)];
                area.draw(&Rectangle::new(corners, bar.role.style().filled()))?;
                let behind = at(end + 6.0, upper + 0.5 * thickness);
                area.draw(&Text::new(bar.label.as_str(), behind, anchored(11.5, HPos::Left, VPos::Center)))?;
            }
        }
        area.draw(&PathElement::new(vec![at(NAMES, ABOVE), at(NAMES, floor)], INK.stroke_width(FINE)))?;
        Ok(())
    }
}
