//! Sheets of panels as SVG, and panels of curves. Only this file, `bars`, `dots` and `loglog` use the drawing library.

use super::thinning::thinned;
use anyhow::{Result, anyhow};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::ops::Range;

/// Drawing units per pixel. The library rounds to whole units; a fine grid keeps curves smooth.
pub(super) const FINE: u32 = 8;
/// Maximum number of points of a curve; longer curves are thinned.
const MOST_POINTS: usize = 4000;
/// [drawing units] Radius of a dot.
const DOT: u32 = 9;
/// [pixel] Half the size of a symbol.
const SYMBOL: i32 = 4;
/// [pixel] Lengths of a dash and of the space behind it.
const DASH: [u32; 2] = [9, 5];
/// [pixel] Space for numbers and names of the axes.
const LABELS: (u32, u32) = (40, 74);
/// [pixel] Height of the sheet's title with its legend.
const HEAD: u32 = 60;
/// [pixel] Space around a panel: left, right, top, bottom.
const MARGINS: [u32; 4] = [12, 18, 8, 4];

pub(super) const INK: RGBColor = RGBColor(38, 44, 54);
pub(super) const GRID: RGBColor = RGBColor(226, 229, 234);

/// The role of a curve, which determines its appearance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The mechanism with its own joints.
    Actual,
    /// The mechanism with ideal joints.
    Ideal,
    /// A bound, such as a clearance circle.
    Limit,
    /// A bar.
    Whole,
    /// A bar for a part of another bar.
    Part,
    /// One of many curves, by number.
    Member(usize),
}

/// Colours that people with any colour vision can distinguish: Okabe and Ito, Color Universal Design, 2008, and grey.
const MEMBERS: [RGBColor; 9] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(150, 140, 20),
    RGBColor(110, 110, 110),
    RGBColor(0, 0, 0),
];

impl Role {
    /// Red, green, blue.
    pub(super) fn colour(self) -> [u8; 3] {
        let RGBColor(red, green, blue) = match self {
            Self::Actual | Self::Whole => RGBColor(24, 84, 158),
            Self::Ideal | Self::Part => RGBColor(247, 181, 94),
            Self::Limit => RGBColor(196, 62, 62),
            Self::Member(number) => MEMBERS[number % MEMBERS.len()],
        };
        [red, green, blue]
    }

    /// [pixel] Width of a line.
    pub(super) fn width(self) -> f64 {
        match self {
            Self::Actual => 1.1,
            Self::Ideal => 3.2,
            Self::Limit => 1.4,
            Self::Whole | Self::Part => 10.0,
            Self::Member(_) => 1.8,
        }
    }

    pub(super) fn style(self) -> ShapeStyle {
        let [red, green, blue] = self.colour();
        let color = RGBColor(red, green, blue).to_rgba();
        ShapeStyle { color, filled: false, stroke_width: (self.width() * f64::from(FINE)) as u32 }
    }

    /// Style of a point: hollow if the colour is used for the second time.
    pub(super) fn dot(self) -> ShapeStyle {
        match self {
            Self::Member(number) if number >= MEMBERS.len() => self.style(),
            _ => self.style().filled(),
        }
    }
}

/// One curve.
pub struct Curve {
    /// Its role.
    pub role: Role,
    /// Its points, in the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// The way in which they are drawn.
    pub mark: Mark,
}

/// The way in which a curve's points are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mark {
    /// A line from left to right. If there are too many points, peaks are kept.
    #[default]
    Line,
    /// A line in any direction.
    Path,
    /// A line in any direction, dashed.
    Dashes,
    /// A dot at each point.
    Dots,
    /// A hollow triangle at each point that points upwards.
    Up,
    /// A hollow triangle at each point that points downwards.
    Down,
    /// A ring at each point with this name beside it.
    Named(&'static str),
}

/// One coordinate system. Curves are drawn in their order, the last one on top.
pub struct Panel {
    /// Name and unit of the abscissa.
    pub x_label: String,
    /// Name and unit of the ordinate.
    pub y_label: String,
    /// The curves.
    pub curves: Vec<Curve>,
    /// Whether both axes have the same scale and range.
    pub square: bool,
}

/// A panel that can be drawn on a sheet.
pub trait Paint {
    /// Draws the panel into the area.
    fn draw(&self, area: &Area) -> Drawn;
}

/// A titled grid of panels.
pub struct Sheet<P = Panel> {
    /// Title, one line.
    pub title: String,
    /// Names of the curves.
    pub legend: Vec<(Role, String)>,
    /// The panels, row by row.
    pub panels: Vec<P>,
    /// Number of panels side by side.
    pub columns: usize,
    /// [pixel] Width and height of one panel.
    pub panel_size: (u32, u32),
}

impl<P: Paint> Sheet<P> {
    /// Draws the sheet as an SVG document.
    pub fn svg(&self) -> Result<String> {
        let rows = self.panels.len().div_ceil(self.columns);
        let size = (self.panel_size.0 * self.columns as u32, self.panel_size.1 * rows as u32 + HEAD);
        let mut text = String::new();
        self.draw(SVGBackend::with_string(&mut text, (size.0 * FINE, size.1 * FINE)), rows)
            .map_err(|error| anyhow!("`{}` cannot be drawn: {error}", self.title))?;
        let [fine, shown] = [FINE, 1].map(|unit| format!("width=\"{}\" height=\"{}\"", size.0 * unit, size.1 * unit));
        Ok(text.replacen(&fine, &shown, 1))
    }

    fn draw(&self, backend: SVGBackend, rows: usize) -> Drawn {
        let root = backend.into_drawing_area();
        root.fill(&WHITE)?;
        let (head, body) = root.split_vertically(HEAD * FINE);
        self.head(&head)?;
        for (panel, area) in self.panels.iter().zip(body.split_evenly((rows, self.columns))) {
            panel.draw(&area)?;
        }
        root.present()?;
        Ok(())
    }

    /// Draws the title and, below it, the legend, outside all panels.
    fn head(&self, area: &Area) -> Drawn {
        let fine = |pixels: f64| (pixels * f64::from(FINE)) as i32;
        let mut left = 18.0;
        area.draw(&Text::new(self.title.as_str(), (fine(left), fine(12.0)), bold(17.0)))?;
        for (role, name) in &self.legend {
            area.draw(&PathElement::new(
                vec![(fine(left), fine(46.0)), (fine(left + 26.0), fine(46.0))],
                role.style(),
            ))?;
            area.draw(&Text::new(name.as_str(), (fine(left + 33.0), fine(39.5)), font(13.0)))?;
            // Letters of this size are about 7 pixels wide.
            left += 33.0 + 7.0 * name.chars().count() as f64 + 22.0;
        }
        Ok(())
    }
}

/// [pixel] Size of a panel whose coordinate system is a square of this side.
pub fn square_panel(side: u32) -> (u32, u32) {
    (side + LABELS.1 + MARGINS[0] + MARGINS[1], side + LABELS.0 + MARGINS[2] + MARGINS[3])
}

/// A part of a sheet.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Result of drawing.
pub type Drawn = std::result::Result<(), Box<dyn std::error::Error>>;

pub(super) fn font(pixels: f64) -> TextStyle<'static> {
    ("sans-serif", pixels * f64::from(FINE)).into_font().color(&INK)
}

fn bold(pixels: f64) -> TextStyle<'static> {
    ("sans-serif", pixels * f64::from(FINE)).into_font().style(FontStyle::Bold).color(&INK)
}

impl Paint for Panel {
    fn draw(&self, area: &Area) -> Drawn {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let (mut x, mut y) = (range(points().map(|point| point.0)), margin(range(points().map(|point| point.1))));
        if self.square {
            let reach =
                1.08 * [x.start, x.end, y.start, y.end].iter().fold(0.0, |reach: f64, edge| reach.max(edge.abs()));
            (x, y) = (-reach..reach, -reach..reach);
        }
        let mut chart = ChartBuilder::on(area)
            .margin_left(MARGINS[0] * FINE)
            .margin_right(MARGINS[1] * FINE)
            .margin_top(MARGINS[2] * FINE)
            .margin_bottom(MARGINS[3] * FINE)
            .x_label_area_size(if self.x_label.is_empty() { LABELS.0 / 2 } else { LABELS.0 } * FINE)
            .y_label_area_size(LABELS.1 * FINE)
            .build_cartesian_2d(x.clone(), y.clone())?;
        let (x_ticks, y_ticks) = (decimals(&x), decimals(&y));
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID.stroke_width(FINE))
            .axis_style(INK.stroke_width(FINE))
            .set_all_tick_mark_size(4 * FINE)
            .label_style(font(12.0))
            .axis_desc_style(font(13.0))
            .x_labels(8)
            .y_labels(6)
            .x_label_formatter(&|value| tick(*value, x_ticks))
            .y_label_formatter(&|value| tick(*value, y_ticks))
            .x_desc(self.x_label.as_str())
            .y_desc(self.y_label.as_str())
            .draw()?;
        for curve in &self.curves {
            curve.draw(&mut chart)?;
        }
        Ok(())
    }
}

/// The coordinate system of a panel.
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

impl Curve {
    fn draw(&self, chart: &mut Chart<'_, '_>) -> Drawn {
        let style = self.role.style();
        let points = self.points.iter().copied();
        match self.mark {
            Mark::Line => chart.draw_series(LineSeries::new(thinned(&self.points, MOST_POINTS), style)).map(drop)?,
            Mark::Path => chart.draw_series(LineSeries::new(points, style)).map(drop)?,
            Mark::Dashes => {
                let [dash, space] = DASH.map(|pixels| pixels * FINE);
                chart.draw_series(DashedLineSeries::new(points, dash, space, style)).map(drop)?;
            }
            Mark::Dots => chart.draw_series(points.map(|at| Circle::new(at, DOT, style.filled()))).map(drop)?,
            Mark::Up | Mark::Down => {
                let corners = triangle(self.mark == Mark::Up);
                let symbol = |at| EmptyElement::at(at) + PathElement::new(corners.to_vec(), style);
                chart.draw_series(points.map(symbol)).map(drop)?;
            }
            Mark::Named(name) => {
                let reach = SYMBOL * FINE as i32;
                let symbol = |at| {
                    let ring = Circle::new((0, 0), reach, style);
                    EmptyElement::at(at) + ring + Text::new(name, (2 * reach, -2 * reach), font(13.0))
                };
                chart.draw_series(points.map(symbol)).map(drop)?;
            }
        }
        Ok(())
    }
}

/// [drawing units] Corners of a triangle about a point, the first one again at the end.
fn triangle(upwards: bool) -> [(i32, i32); 4] {
    let reach = if upwards { SYMBOL } else { -SYMBOL } * FINE as i32;
    [(0, -reach), (reach, reach * 2 / 3), (-reach, reach * 2 / 3), (0, -reach)]
}

/// Range of the numbers; an arbitrary range if there are none.
fn range(numbers: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low < high {
        low..high
    } else if low == high {
        low - 0.5..high + 0.5
    } else {
        0.0..1.0
    }
}

/// Widens a range, so that curves do not touch the frame.
fn margin(range: Range<f64>) -> Range<f64> {
    let margin = 0.06 * (range.end - range.start);
    range.start - margin..range.end + margin
}

/// Number of decimals that distinguish the ticks of this range.
pub(super) fn decimals(range: &Range<f64>) -> usize {
    let tick = (range.end - range.start) / 10.0;
    (-tick.log10().floor()).clamp(0.0, 9.0) as usize
}

/// Label of a tick, with a typographic minus sign and without unnecessary zeros.
pub(super) fn tick(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".into() } else { text.replace('-', "−") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_read_well() {
        assert_eq!(tick(-0.0, 2), "0");
        assert_eq!(tick(-1.50, 2), "−1.5");
        assert_eq!(tick(20.0, 0), "20");
        assert_eq!(decimals(&(0.0..2.0)), 1);
    }
}
