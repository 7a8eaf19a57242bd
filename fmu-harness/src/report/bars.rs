//! Bars on a logarithmic scale, in named rows, and the layout of such rows.

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
        let (low, high) = self.decades();
        let share = |exponent: f64| (exponent - f64::from(low)) / f64::from(high - low);
        let number =
            |decade: i32| if decade < 0 { format!("{}", 10f64.powi(decade)) } else { grouped(10f64.powi(decade)) };
        let ticks = (low..=high).map(|decade| (share(f64::from(decade)), number(decade)));
        let rows = Rows::of(area, NAMES, BEHIND, self.rows.len());
        rows.scale(&self.label, ticks)?;
        for (row, (name, bars)) in self.rows.iter().enumerate() {
            rows.name(row, name)?;
            for (place, bar) in bars.iter().enumerate() {
                let (upper, lower) = rows.lane(row, place, bars.len());
                let end = rows.x(share(bar.value.log10()));
                let corners = [at(NAMES, upper), at(end, lower)];
                area.draw(&Rectangle::new(corners, bar.role.style().filled()))?;
                let behind = at(end + 6.0, 0.5 * (upper + lower));
                area.draw(&Text::new(bar.label.as_str(), behind, anchored(11.5, HPos::Left, VPos::Center)))?;
            }
        }
        rows.axis()
    }
}

/// Named rows above a scale.
pub(super) struct Rows<'a, 'b> {
    area: &'a Area<'b>,
    /// [pixel] Left and right end of the scale, and its height from above.
    left: f64,
    right: f64,
    floor: f64,
    /// [pixel]
    height: f64,
}

impl<'a, 'b> Rows<'a, 'b> {
    /// So many rows, with space for names at the left and for labels at the right.
    pub(super) fn of(area: &'a Area<'b>, names: f64, labels: f64, rows: usize) -> Self {
        let (width, height) = area.dim_in_pixel();
        let (right, floor) = (f64::from(width / FINE) - labels, f64::from(height / FINE) - SCALE);
        Self { area, left: names, right, floor, height: (floor - ABOVE) / rows.max(1) as f64 }
    }

    /// [pixel] Abscissa of a place on the scale: 0 at its start, 1 at its end.
    pub(super) fn x(&self, share: f64) -> f64 {
        self.left + (self.right - self.left) * share
    }

    /// Draws the scale with these ticks.
    pub(super) fn scale(&self, label: &str, ticks: impl Iterator<Item = (f64, String)>) -> Drawn {
        for (share, number) in ticks {
            self.upright(share, GRID.stroke_width(FINE))?;
            let below = at(self.x(share), self.floor + 7.0);
            self.area.draw(&Text::new(number, below, anchored(12.0, HPos::Center, VPos::Top)))?;
        }
        let middle = at(self.x(0.5), self.floor + 28.0);
        self.area.draw(&Text::new(label, middle, anchored(13.0, HPos::Center, VPos::Top)))?;
        Ok(())
    }

    /// Draws a line across all rows.
    pub(super) fn upright(&self, share: f64, style: ShapeStyle) -> Drawn {
        let ends = vec![at(self.x(share), ABOVE), at(self.x(share), self.floor)];
        self.area.draw(&PathElement::new(ends, style))?;
        Ok(())
    }

    /// Draws the line at the start of the scale.
    pub(super) fn axis(&self) -> Drawn {
        self.upright(0.0, INK.stroke_width(FINE))
    }

    /// Draws the name of a row.
    pub(super) fn name(&self, row: usize, name: &str) -> Drawn {
        let (upper, lower) = self.lane(row, 0, 1);
        let place = at(self.left - 8.0, 0.5 * (upper + lower));
        self.area.draw(&Text::new(name, place, anchored(12.5, HPos::Right, VPos::Center)))?;
        Ok(())
    }

    /// [pixel] Upper and lower edge of one of the lanes of a row.
    pub(super) fn lane(&self, row: usize, lane: usize, lanes: usize) -> (f64, f64) {
        let top = ABOVE + self.height * (row as f64 + 0.5 * (1.0 - FILLED));
        let thickness = FILLED * self.height / lanes.max(1) as f64;
        (top + thickness * lane as f64, top + thickness * (lane + 1) as f64)
    }
}

/// Coordinates in drawing units.
pub(super) fn at(x: f64, y: f64) -> (i32, i32) {
    ((x * f64::from(FINE)) as i32, (y * f64::from(FINE)) as i32)
}

fn anchored(size: f64, h: HPos, v: VPos) -> TextStyle<'static> {
    font(size).pos(Pos::new(h, v))
}
