//! Panels as figures that can be zoomed and that show numbers. Only this file uses the interactive plotting library.

use super::figure::TURNS;
use super::loglog::{self, LogLog};
use super::plot::{Curve, Mark, Panel, Role, Sheet};
use super::thinning::thinned;
use plotly::common::{DashType, ExponentFormat, Line, Marker, MarkerSymbol, Mode};
use plotly::layout::{Axis, AxisType, HoverMode, Margin};
use plotly::{Layout, Plot, Scatter};

/// Maximum number of points of a curve.
const MOST_POINTS: usize = 12_000;
/// Runs without an error are drawn at this multiple of the largest error.
const BEYOND: f64 = 8.0;
/// Ends of a line across a scale, beyond all points.
const ACROSS: f64 = 2.0;

/// The library as one script element.
pub fn library() -> String {
    let sources = Plot::offline_js_sources();
    // The next element typesets formulas, which these figures do not have.
    sources.split_inclusive("</script>").next().unwrap_or_default().to_owned()
}

/// An interactive figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Traces and layout as JSON for the library.
    pub json: String,
    /// Whether both axes have the same scale.
    pub square: bool,
    /// Whether its abscissa is crank turns since the start.
    pub over_turns: bool,
}

/// A panel that can be drawn by this library.
pub trait Interactive {
    /// Name and unit of its abscissa; empty if it shares the abscissa of a panel below.
    fn abscissa(&self) -> &str;
    /// The figure over this abscissa. Curves have the names of their roles in the legend.
    fn figure(&self, abscissa: &str, legend: &[(Role, String)]) -> Figure;
}

/// All panels of a sheet, each with an abscissa of its own.
pub fn figures<P: Interactive>(sheet: &Sheet<P>) -> Vec<Figure> {
    let below = |place: usize| sheet.panels[place..].iter().step_by(sheet.columns).map(P::abscissa);
    let abscissa = |place| below(place).find(|abscissa| !abscissa.is_empty()).unwrap_or_default();
    let panels = sheet.panels.iter().enumerate();
    panels.map(|(place, panel)| panel.figure(abscissa(place), &sheet.legend)).collect()
}

impl Interactive for Panel {
    fn abscissa(&self) -> &str {
        &self.x_label
    }

    fn figure(&self, abscissa: &str, legend: &[(Role, String)]) -> Figure {
        let mut plot = Plot::new();
        for curve in &self.curves {
            let trace = trace(&drawn(curve), mode(curve.mark), curve.role);
            let trace = match legend.iter().find(|(role, _)| *role == curve.role) {
                Some((_, name)) => trace.name(name),
                None => trace,
            };
            plot.add_trace(trace);
        }
        let (x, y) = (axis(abscissa), axis(&self.y_label).auto_margin(true));
        let y = if self.square { y.scale_anchor("x") } else { y };
        plot.set_layout(layout(x, y).hover_mode(HoverMode::Closest).show_legend(false));
        Figure { json: plot.to_json(), square: self.square, over_turns: abscissa == TURNS }
    }
}

impl Interactive for LogLog {
    fn abscissa(&self) -> &str {
        &self.x_label
    }

    fn figure(&self, abscissa: &str, legend: &[(Role, String)]) -> Figure {
        let mut plot = Plot::new();
        let reached = || self.series.iter().flat_map(|series| &series.points);
        let largest = reached().map(|(x, _)| *x).fold(1e-300, f64::max);
        let least = reached().map(|(x, _)| *x).fold(largest, f64::min);
        let outside = BEYOND * largest;
        for series in &self.series {
            let name = legend.iter().find(|(role, _)| *role == series.role).map_or("", |(_, name)| name);
            if !series.points.is_empty() {
                let points = trace(&series.points, Mode::LinesMarkers, series.role);
                plot.add_trace(points.name(name).legend_group(name));
            }
            let mut alone = series.points.is_empty();
            for (kind, symbol, what) in [
                (loglog::Mark::Failed, MarkerSymbol::X, "failed"),
                (loglog::Mark::Stopped, MarkerSymbol::TriangleUp, "stopped"),
            ] {
                let costs = series.odd.iter().filter(|(mark, _)| *mark == kind).filter_map(|(_, cost)| *cost);
                let points: Vec<(f64, f64)> = costs.map(|cost| (outside, cost)).collect();
                if !points.is_empty() {
                    let marker = Marker::new().symbol(symbol).size(8).color(colour(series.role));
                    let trace = trace(&points, Mode::Markers, series.role).marker(marker);
                    plot.add_trace(trace.name(format!("{name}: {what}")).legend_group(name).show_legend(alone));
                    alone = false;
                }
            }
        }
        let ordinates = || reached().map(|(_, y)| *y);
        let (low, high) = (ordinates().fold(f64::INFINITY, f64::min), ordinates().fold(0.0, f64::max));
        if let Some(floor) = &self.floor {
            plot.add_trace(bound(&[(floor.at, low / ACROSS), (floor.at, high * ACROSS)], &floor.label));
        }
        if let Some(level) = &self.level {
            plot.add_trace(bound(&[(least / ACROSS, level.at), (outside, level.at)], &level.label));
        }
        let logarithmic =
            |label: &str| axis(label).type_(AxisType::Log).dtick(1.0).exponent_format(ExponentFormat::Power);
        let layout = layout(logarithmic(abscissa), logarithmic(&self.y_label));
        plot.set_layout(layout.hover_mode(HoverMode::Closest).show_legend(true));
        Figure { json: plot.to_json(), square: false, over_turns: false }
    }
}

/// A line for a bound.
fn bound(points: &[(f64, f64)], label: &str) -> Box<Scatter<f32, f32>> {
    let line = Line::new().color(colour(Role::Limit)).width(1.2).dash(DashType::Dash);
    trace(points, Mode::Lines, Role::Limit).line(line).name(label)
}

/// The points that are drawn: a line over time keeps its peaks, a path keeps its bends up to a maximum number.
fn drawn(curve: &Curve) -> Vec<(f64, f64)> {
    match curve.mark {
        Mark::Line => thinned(&curve.points, MOST_POINTS),
        _ => {
            let every = curve.points.len().div_ceil(MOST_POINTS).max(1);
            curve.points.iter().step_by(every).copied().collect()
        }
    }
}

fn mode(mark: Mark) -> Mode {
    match mark {
        Mark::Line | Mark::Path | Mark::Dashes => Mode::Lines,
        Mark::Dots | Mark::Up | Mark::Down | Mark::Named(_) => Mode::Markers,
    }
}

/// Numbers rounded to seven digits, enough for a screen.
fn trace(points: &[(f64, f64)], mode: Mode, role: Role) -> Box<Scatter<f32, f32>> {
    let (x, y) = points.iter().map(|(x, y)| (*x as f32, *y as f32)).unzip();
    let line = Line::new().color(colour(role)).width(role.width());
    Scatter::new(x, y).mode(mode).line(line).marker(Marker::new().color(colour(role)).size(5))
}

fn colour(role: Role) -> String {
    let [red, green, blue] = role.colour();
    format!("rgb({red},{green},{blue})")
}

fn axis(label: &str) -> Axis {
    Axis::new().title(label).zero_line(false)
}

fn layout(x: Axis, y: Axis) -> Layout {
    Layout::new().x_axis(x).y_axis(y).auto_size(true).margin(Margin::new().left(56).right(12).top(28).bottom(44))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::loglog::{Bound, Series};
    use serde_json::{Value, json};

    fn data(figure: &Figure) -> Value {
        serde_json::from_str(&figure.json).expect("JSON")
    }

    #[test]
    fn a_panel_keeps_its_points_names_and_scales() {
        let curve = Curve { role: Role::Actual, points: vec![(0.0, 1.5), (0.5, -2.0)], mark: Mark::Dots };
        let panel = |x_label: &str| Panel {
            x_label: x_label.into(),
            y_label: "force [N]".into(),
            curves: vec![Curve { points: curve.points.clone(), ..curve }],
            square: true,
        };
        let sheet = Sheet {
            title: String::new(),
            legend: vec![(Role::Actual, "journal".into())],
            panels: vec![panel(""), panel(TURNS)],
            columns: 1,
            panel_size: (1, 1),
        };
        for figure in figures(&sheet) {
            assert!(figure.square && figure.over_turns);
            let data = data(&figure);
            let trace = &data["data"][0];
            assert_eq!((&trace["x"], &trace["y"]), (&json!([0.0, 0.5]), &json!([1.5, -2.0])));
            assert_eq!((&trace["name"], &trace["mode"]), (&json!("journal"), &json!("markers")));
            assert_eq!(trace["marker"]["color"], "rgb(24,84,158)");
            assert_eq!(data["layout"]["xaxis"]["title"]["text"], TURNS);
            assert_eq!(data["layout"]["yaxis"]["scaleanchor"], "x");
        }
    }

    #[test]
    fn runs_without_an_error_stand_beside_the_others() {
        let odd = vec![(loglog::Mark::Failed, Some(0.5)), (loglog::Mark::Stopped, None)];
        let series = |role, points, odd| Series { role, points, dots: true, odd };
        let panel = LogLog {
            x_label: "error".into(),
            y_label: "cost".into(),
            series: vec![
                series(Role::Member(0), vec![(1e-6, 2.0), (0.0078125, 0.1)], vec![]),
                series(Role::Member(1), vec![], odd),
            ],
            floor: Some(Bound { at: 1e-8, label: "floor".into() }),
            level: None,
            deadline: None,
            strip: None,
            text: String::new(),
        };
        let legend = [(Role::Member(0), "one".to_owned()), (Role::Member(1), "other".to_owned())];
        let data = data(&panel.figure("error", &legend));
        let traces = data["data"].as_array().expect("traces");
        let names: Vec<&Value> = traces.iter().map(|trace| &trace["name"]).collect();
        assert_eq!(names, ["one", "other: failed", "floor"]);
        assert_eq!((&traces[1]["x"], &traces[1]["y"]), (&json!([0.0625]), &json!([0.5])));
        assert_eq!(traces[1]["showlegend"], true);
        assert_eq!(data["layout"]["xaxis"]["type"], "log");
    }

    #[test]
    fn the_library_is_one_script() {
        let library = library();
        assert!(library.starts_with("<script") && library.ends_with("</script>") && library.contains("Plotly"));
        assert_eq!(library.matches("</script>").count(), 1);
    }
}
