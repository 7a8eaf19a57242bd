//! Lines on two logarithmic scales, each with its name at the side.

use super::plot::{Area, Drawn, FINE, GRID, INK, Paint, font};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Room left of, right of, above and below the coordinate system [pixel].
const ROOM: [f64; 4] = [76.0, 236.0, 34.0, 58.0];
/// Height of a line of the legend [pixel].
const LEGEND: f64 = 19.0;
/// Radius of a point [pixel].
const DOT: f64 = 3.2;
/// Colours that are told apart by colour-blind readers too: Okabe and Ito, Color Universal Design, 2008; each is used
/// again with hollow points.
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(90, 90, 90),
];

/// One line.
pub struct Line {
    /// In the legend.
    pub name: String,
    /// Above 0.
    pub points: Vec<(f64, f64)>,
}

/// A panel.
pub struct LogLog {
    /// Above it.
    pub title: String,
    /// Name and unit of the abscissa.
    pub x_label: String,
    /// Name and unit of the ordinate.
    pub y_label: String,
    /// Abscissas below this mean nothing; drawn as a line.
    pub floor: f64,
    /// What is drawn.
    pub lines: Vec<Line>,
}

impl LogLog {
    /// The decades that hold all values, as powers of ten.
    fn decades(&self, of: fn(&(f64, f64)) -> f64) -> (i32, i32) {
        let values = || self.lines.iter().flat_map(|line| &line.points).map(|point| of(point).log10());
        let low = values().fold(f64::INFINITY, f64::min).floor();
        let high = values().fold(f64::NEG_INFINITY, f64::max).ceil();
        if low < high { (low as i32, high as i32) } else { (0, 1) }
    }
}

impl Paint for LogLog {
    fn draw(&self, area: &Area) -> Drawn {
        let at = |x: f64, y: f64| ((x * f64::from(FINE)) as i32, (y * f64::from(FINE)) as i32);
        let (width, height) = area.dim_in_pixel();
        let (width, height) = (f64::from(width / FINE), f64::from(height / FINE));
        let [left, right, above, below] = ROOM;
        let (right, bottom) = (width - right, height - below);
        let ((x_low, x_high), (y_low, y_high)) = (self.decades(|point| point.0), self.decades(|point| point.1));
        let share = |value: f64, low: i32, high: i32| (value - f64::from(low)) / f64::from(high - low);
        let x = |value: f64| left + (right - left) * share(value.log10(), x_low, x_high);
        let y = |value: f64| bottom - (bottom - above) * share(value.log10(), y_low, y_high);
        let anchored = |size: f64, h: HPos, v: VPos| font(size).pos(Pos::new(h, v));

        let thin = GRID.stroke_width(FINE);
        for decade in x_low..=x_high {
            let x = x(10f64.powi(decade));
            area.draw(&PathElement::new(vec![at(x, above), at(x, bottom)], thin))?;
            let style = anchored(12.0, HPos::Center, VPos::Top);
            area.draw(&Text::new(format!("1e{decade}"), at(x, bottom + 7.0), style))?;
        }
        for decade in y_low..=y_high {
            let y = y(10f64.powi(decade));
            area.draw(&PathElement::new(vec![at(left, y), at(right, y)], thin))?;
            let style = anchored(12.0, HPos::Right, VPos::Center);
            area.draw(&Text::new(format!("{}", 10f64.powi(decade)), at(left - 8.0, y), style))?;
        }
        let frame = [(left, above), (left, bottom), (right, bottom)].map(|(x, y)| at(x, y));
        area.draw(&PathElement::new(frame.to_vec(), INK.stroke_width(FINE)))?;
        let middle = at(0.5 * (left + right), bottom + 28.0);
        area.draw(&Text::new(self.x_label.as_str(), middle, anchored(13.0, HPos::Center, VPos::Top)))?;
        let corner = at(left - 58.0, above - 12.0);
        let heading = format!("{}: {}", self.title, self.y_label);
        area.draw(&Text::new(heading, corner, anchored(13.0, HPos::Left, VPos::Bottom)))?;
        if self.floor > 10f64.powi(x_low) && self.floor < 10f64.powi(x_high) {
            let x = x(self.floor);
            area.draw(&PathElement::new(vec![at(x, above), at(x, bottom)], INK.stroke_width(FINE)))?;
            let style = anchored(11.5, HPos::Left, VPos::Top);
            area.draw(&Text::new("error of the reference", at(x + 5.0, above + 2.0), style))?;
        }
        for (place, line) in self.lines.iter().enumerate() {
            let color = COLORS[place % COLORS.len()];
            let solid = place < COLORS.len();
            let dot = |center: (i32, i32)| {
                let size = (DOT * f64::from(FINE)) as i32;
                let inside = if solid { color.filled() } else { WHITE.filled() };
                [Circle::new(center, size, inside), Circle::new(center, size, color.stroke_width(FINE))]
            };
            let style = color.stroke_width(if place == 0 { 3 * FINE } else { 3 * FINE / 2 });
            let points: Vec<(i32, i32)> = line.points.iter().map(|point| at(x(point.0), y(point.1))).collect();
            area.draw(&PathElement::new(points.clone(), style))?;
            let row = above + 8.0 + LEGEND * place as f64;
            let sample = [(right + 14.0, row), (right + 40.0, row)].map(|(x, y)| at(x, y));
            area.draw(&PathElement::new(sample.to_vec(), style))?;
            for center in points.into_iter().chain([at(right + 27.0, row)]) {
                for circle in dot(center) {
                    area.draw(&circle)?;
                }
            }
            let style = anchored(12.0, HPos::Left, VPos::Center);
            area.draw(&Text::new(line.name.as_str(), at(right + 47.0, row), style))?;
        }
        Ok(())
    }
}
