//! Curves over two logarithmic scales, with a strip for runs that have no coordinates, and a text below.

use super::plot::{Area, Drawn, FINE, GRID, INK, Paint, Role, font};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::RangeInclusive;

/// [pixel] Space left, above, and for the scale below.
const LEFT: f64 = 78.0;
const ABOVE: f64 = 14.0;
const SCALE: f64 = 58.0;
/// [pixel] Space right, and width of the strip.
const RIGHT: f64 = 24.0;
const STRIP: f64 = 112.0;
/// [pixel] Part of this space that stays free beside the scales.
const GAP: f64 = 20.0;
/// [pixel] Height of a line of text, width of a letter, size of a mark.
const LINE: f64 = 19.0;
const LETTER: f64 = 6.4;
const MARK: f64 = 4.5;
const SHADE: RGBColor = RGBColor(235, 232, 224);

/// Mark of a run without coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A cross.
    Failed,
    /// A triangle that points up.
    Stopped,
}

/// One curve.
pub struct Series {
    /// Role, which determines the colour.
    pub role: Role,
    /// Its points, all above 0.
    pub points: Vec<(f64, f64)>,
    /// Whether each point has a dot.
    pub dots: bool,
    /// Runs without an abscissa. A run that has no ordinate either is drawn at the top.
    pub odd: Vec<(Mark, Option<f64>)>,
}

/// A line across the panel, or the edge of its shaded area.
pub struct Bound {
    /// Its coordinate.
    pub at: f64,
    /// Its label.
    pub label: String,
}

/// A panel.
pub struct LogLog {
    /// Name and unit of the abscissa.
    pub x_label: String,
    /// Name and unit of the ordinate.
    pub y_label: String,
    /// The curves.
    pub series: Vec<Series>,
    /// The area to the left of this bound is shaded.
    pub floor: Option<Bound>,
    /// A line at an ordinate.
    pub level: Option<Bound>,
    /// A line at an abscissa.
    pub deadline: Option<Bound>,
    /// Name of the strip at the right, if there is one.
    pub strip: Option<String>,
    /// Text below the panel.
    pub text: String,
}

impl Paint for LogLog {
    fn draw(&self, area: &Area) -> Drawn {
        let (width, height) = area.dim_in_pixel();
        let (width, height) = (f64::from(width / FINE), f64::from(height / FINE));
        let lines = wrapped(&self.text, ((width - LEFT) / LETTER) as usize);
        let strip = if self.strip.is_some() { STRIP } else { 0.0 };
        let frame = Frame {
            x: decades(self.abscissae()),
            y: decades(self.ordinates()),
            left: LEFT,
            right: width - RIGHT - strip,
            top: ABOVE,
            bottom: height - SCALE - LINE * lines.len() as f64,
        };
        if let Some(floor) = &self.floor {
            let corners = [frame.point(frame.left, frame.top), frame.point(frame.x(floor.at), frame.bottom)];
            area.draw(&Rectangle::new(corners, SHADE.filled()))?;
            let style = font(11.5).pos(Pos::new(HPos::Left, VPos::Bottom));
            let at = frame.point(frame.left + 6.0, frame.bottom - 6.0);
            area.draw(&Text::new(floor.label.as_str(), at, style))?;
        }
        frame.scales(area, &self.x_label, &self.y_label)?;
        frame.lines(area, self.level.as_ref(), self.deadline.as_ref())?;
        for (number, series) in self.series.iter().enumerate() {
            frame.series(area, series)?;
            let share = (number as f64 + 1.0) / (self.series.len() as f64 + 1.0);
            frame.odd(area, series, width - RIGHT - (strip - GAP) * (1.0 - share))?;
        }
        if let Some(name) = &self.strip {
            let style = font(11.5).pos(Pos::new(HPos::Center, VPos::Top));
            let middle = width - RIGHT - 0.5 * (strip - GAP);
            area.draw(&Text::new(name.as_str(), frame.point(middle, frame.bottom + 7.0), style))?;
            let ends = [width - RIGHT - strip + GAP, width - RIGHT].map(|x| frame.point(x, frame.bottom));
            area.draw(&PathElement::new(ends, INK.stroke_width(FINE)))?;
        }
        for (number, line) in lines.iter().enumerate() {
            let at = frame.point(frame.left, frame.bottom + SCALE - 4.0 + LINE * number as f64);
            area.draw(&Text::new(line.as_str(), at, font(12.5)))?;
        }
        Ok(())
    }
}

impl LogLog {
    fn abscissae(&self) -> Vec<f64> {
        let points = self.series.iter().flat_map(|series| series.points.iter().map(|point| point.0));
        points.chain(self.floor.iter().map(|floor| floor.at)).collect()
    }

    fn ordinates(&self) -> Vec<f64> {
        let points = self.series.iter().flat_map(|series| series.points.iter().map(|point| point.1));
        points.chain(self.series.iter().flat_map(|series| series.odd.iter().filter_map(|odd| odd.1))).collect()
    }
}

/// Range of decades that contains all these numbers, in powers of ten.
fn decades(numbers: Vec<f64>) -> RangeInclusive<i32> {
    let exponents = || numbers.iter().filter(|number| **number > 0.0).map(|number| number.log10());
    let low = exponents().fold(f64::INFINITY, f64::min).floor();
    let high = exponents().fold(f64::NEG_INFINITY, f64::max).ceil();
    if low < high {
        low as i32..=high as i32
    } else if low == high {
        low as i32 - 1..=low as i32 + 1
    } else {
        0..=1
    }
}

/// Position of the coordinate system in pixels, and the decades that it shows.
struct Frame {
    x: RangeInclusive<i32>,
    y: RangeInclusive<i32>,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Frame {
    /// Coordinates in drawing units.
    fn point(&self, x: f64, y: f64) -> (i32, i32) {
        ((x * f64::from(FINE)) as i32, (y * f64::from(FINE)) as i32)
    }

    fn x(&self, value: f64) -> f64 {
        self.left + (self.right - self.left) * share(value, &self.x)
    }

    fn y(&self, value: f64) -> f64 {
        self.bottom + (self.top - self.bottom) * share(value, &self.y)
    }

    fn scales(&self, area: &Area, x_label: &str, y_label: &str) -> Drawn {
        let anchored = |size: f64, h: HPos, v: VPos| font(size).pos(Pos::new(h, v));
        for exponent in self.x.clone() {
            let x = self.x(10f64.powi(exponent));
            let ends = vec![self.point(x, self.top), self.point(x, self.bottom)];
            area.draw(&PathElement::new(ends, GRID.stroke_width(FINE)))?;
            let style = anchored(12.0, HPos::Center, VPos::Top);
            area.draw(&Text::new(decade(exponent), self.point(x, self.bottom + 7.0), style))?;
        }
        for exponent in self.y.clone() {
            let y = self.y(10f64.powi(exponent));
            let ends = vec![self.point(self.left, y), self.point(self.right, y)];
            area.draw(&PathElement::new(ends, GRID.stroke_width(FINE)))?;
            let style = anchored(12.0, HPos::Right, VPos::Center);
            area.draw(&Text::new(decade(exponent), self.point(self.left - 7.0, y), style))?;
        }
        let middle = self.point(0.5 * (self.left + self.right), self.bottom + 26.0);
        area.draw(&Text::new(x_label, middle, anchored(13.0, HPos::Center, VPos::Top)))?;
        let upright = font(13.0).transform(FontTransform::Rotate270).pos(Pos::new(HPos::Center, VPos::Top));
        area.draw(&Text::new(y_label, self.point(10.0, 0.5 * (self.top + self.bottom)), upright))?;
        let axes = vec![
            self.point(self.left, self.top),
            self.point(self.left, self.bottom),
            self.point(self.right, self.bottom),
        ];
        area.draw(&PathElement::new(axes, INK.stroke_width(FINE)))?;
        Ok(())
    }

    /// Draws the lines at an ordinate and at an abscissa, if they are inside the panel.
    fn lines(&self, area: &Area, level: Option<&Bound>, deadline: Option<&Bound>) -> Drawn {
        let line = |ends: [(f64, f64); 2]| PathElement::new(ends.map(|(x, y)| self.point(x, y)), Role::Limit.style());
        let style = font(11.5).pos(Pos::new(HPos::Right, VPos::Bottom));
        if let Some(Bound { at, label }) = level.filter(|level| is_inside(level.at, &self.y)) {
            let y = self.y(*at);
            area.draw(&line([(self.left, y), (self.right, y)]))?;
            area.draw(&Text::new(label.as_str(), self.point(self.right - 6.0, y - 3.0), style.clone()))?;
        }
        if let Some(Bound { at, label }) = deadline.filter(|deadline| is_inside(deadline.at, &self.x)) {
            let x = self.x(*at);
            area.draw(&line([(x, self.top), (x, self.bottom)]))?;
            area.draw(&Text::new(label.as_str(), self.point(x - 5.0, self.bottom - 6.0), style))?;
        }
        Ok(())
    }

    fn series(&self, area: &Area, series: &Series) -> Drawn {
        let places = series.points.iter().map(|(x, y)| self.point(self.x(*x), self.y(*y)));
        let places: Vec<(i32, i32)> = places.collect();
        if series.dots {
            for place in &places {
                area.draw(&Circle::new(*place, (0.7 * MARK * f64::from(FINE)) as i32, series.role.dot()))?;
            }
        }
        area.draw(&PathElement::new(places, series.role.style()))?;
        Ok(())
    }

    /// Draws the marks of a series in the strip, at `x`.
    fn odd(&self, area: &Area, series: &Series, x: f64) -> Drawn {
        let style = series.role.style();
        for (mark, ordinate) in &series.odd {
            let y = ordinate.map_or(self.top + MARK, |ordinate| self.y(ordinate));
            let corner = |right: f64, down: f64| self.point(x + MARK * right, y + MARK * down);
            let strokes = match mark {
                Mark::Failed => {
                    vec![vec![corner(-1.0, -1.0), corner(1.0, 1.0)], vec![corner(-1.0, 1.0), corner(1.0, -1.0)]]
                }
                Mark::Stopped => vec![vec![corner(-1.0, 1.0), corner(0.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]],
            };
            strokes.into_iter().try_for_each(|stroke| area.draw(&PathElement::new(stroke, style)))?;
        }
        Ok(())
    }
}

/// Whether a number is on the scale.
fn is_inside(value: f64, decades: &RangeInclusive<i32>) -> bool {
    (10f64.powi(*decades.start())..=10f64.powi(*decades.end())).contains(&value)
}

/// Position of a number on the scale: 0 at the first decade, 1 at the last one. Numbers outside are put at the edge.
fn share(value: f64, decades: &RangeInclusive<i32>) -> f64 {
    let (low, high) = (f64::from(*decades.start()), f64::from(*decades.end()));
    ((value.log10() - low) / (high - low)).clamp(0.0, 1.0)
}

/// `0.01`, `1`, `100`, `10⁻⁶`.
fn decade(exponent: i32) -> String {
    if (-3..=3).contains(&exponent) {
        return format!("{}", 10f64.powi(exponent));
    }
    let raised = |digit: char| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => digit.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)).unwrap_or(digit),
    };
    format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
}

/// Wraps a text to lines of at most `width` letters.
fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= letters => *line += &format!(" {word}"),
            _ => lines.push(word.into()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_hold_all_numbers_and_name_their_decades() {
        assert_eq!(decades(vec![2e-7, 0.5, 0.0]), -7..=0);
        assert_eq!(decades(vec![0.01]), -3..=-1);
        assert_eq!(decades(vec![]), 0..=1);
        assert_eq!([-12, -2, 0, 2, 4].map(decade), ["10⁻¹²", "0.01", "1", "100", "10⁴"]);
        assert_eq!([1e-3, 1e-2, 1.0, 1e9].map(|value| share(value, &(-2..=0))), [0.0, 0.0, 1.0, 1.0]);
    }

    #[test]
    fn lines_break_between_words() {
        assert_eq!(wrapped("one more digit costs", 9), ["one more", "digit", "costs"]);
    }
}
