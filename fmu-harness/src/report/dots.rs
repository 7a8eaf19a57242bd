//! Dots with their ranges on a linear scale that starts at 0, in named rows.

use super::bars::{Rows, at};
use super::plot::{Area, Drawn, FINE, GRID, Paint, Role, decimals, tick};
use plotters::prelude::*;

/// [pixel] Space for the rows' names and right of the scale.
const NAMES: f64 = 148.0;
const RIGHT: f64 = 28.0;
/// [pixel] Radius of a dot.
const RADIUS: f64 = 3.4;
/// Minimum number of steps between ticks.
const STEPS: f64 = 4.0;

/// One dot.
pub struct Dot {
    /// Its place in the unit of the scale, at least 0.
    pub value: f64,
    /// Role, which determines the colour.
    pub role: Role,
    /// Ends of a line through the dot, if there is one.
    pub range: Option<(f64, f64)>,
}

/// A panel of dots.
pub struct Dots {
    /// Name and unit of the scale.
    pub label: String,
    /// Names and dots of the rows, from top to bottom. A dot keeps its lane in the row even if others are missing.
    pub rows: Vec<(String, Vec<Option<Dot>>)>,
    /// A line across all rows at this value.
    pub level: Option<f64>,
}

impl Dots {
    /// End of the scale and distance of its ticks, a round number.
    fn scale(&self) -> (f64, f64) {
        let dots = self.rows.iter().flat_map(|(_, dots)| dots).flatten();
        let values = dots.flat_map(|dot| [dot.value, dot.range.map_or(0.0, |(_, high)| high)]).chain(self.level);
        let largest = values.filter(|value| value.is_finite()).fold(0.0, f64::max);
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let decade = 10f64.powf((largest / STEPS).log10().floor());
        let step = [5.0, 2.0, 1.0].map(|round| round * decade).into_iter().find(|step| largest / step >= STEPS);
        let step = step.unwrap_or(decade);
        ((largest / step).ceil() * step, step)
    }
}

impl Paint for Dots {
    fn draw(&self, area: &Area) -> Drawn {
        let (end, step) = self.scale();
        let rows = Rows::of(area, NAMES, RIGHT, self.rows.len());
        let digits = decimals(&(0.0..step));
        let ticks = (0..=(end / step).round() as u32).map(|number| f64::from(number) * step);
        rows.scale(&self.label, ticks.map(|value| (value / end, tick(value, digits))))?;
        if let Some(level) = self.level {
            rows.upright(level / end, Role::Ideal.style())?;
        }
        for (row, (name, dots)) in self.rows.iter().enumerate() {
            rows.name(row, name)?;
            let between = rows.lane(row, 0, 1).1;
            area.draw(&PathElement::new([0.0, 1.0].map(|share| at(rows.x(share), between)), GRID.stroke_width(FINE)))?;
            for (place, dot) in dots.iter().enumerate() {
                let Some(dot) = dot else { continue };
                let (upper, lower) = rows.lane(row, place, dots.len());
                let point = |value: f64| at(rows.x(value / end), 0.5 * (upper + lower));
                if let Some((low, high)) = dot.range {
                    area.draw(&PathElement::new([point(low), point(high)], dot.role.style()))?;
                }
                let radius = (RADIUS * f64::from(FINE)) as i32;
                area.draw(&Circle::new(point(dot.value), radius, dot.role.style().filled()))?;
            }
        }
        rows.axis()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end_and_step(value: f64) -> (f64, f64) {
        let dot = Dot { value, role: Role::Whole, range: None };
        Dots { label: String::new(), rows: vec![(String::new(), vec![None, Some(dot)])], level: None }.scale()
    }

    #[test]
    fn a_scale_ends_at_a_round_number_beyond_its_dots() {
        assert_eq!(
            [45.6, 80.0, 0.7, 0.0].map(end_and_step),
            [(50.0, 10.0), (80.0, 20.0), (0.7000000000000001, 0.1), (1.0, 0.2)]
        );
    }
}
