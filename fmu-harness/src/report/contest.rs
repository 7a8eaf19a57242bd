//! Costs of other programs for the same scene at equal error, and their ratio to ours.

use super::loglog::{Bound, LogLog, Series as Curve};
use super::named::Named;
use super::plot::{Role, Sheet};
use super::table::Table;
use super::units::{significant, three_digits};
use crate::peers::{Contest, Point, Series};
use anyhow::Result;
use std::path::Path;

/// Errors at which costs are compared.
pub const ERRORS: [f64; 4] = [1e-2, 1e-4, 1e-6, 1e-8];

/// The cost of an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reached {
    /// [s/s] Interpolated between two runs.
    Cost(f64),
    /// [s/s] Cost of the cheapest run, since all runs are more accurate.
    AtMost(f64),
    /// Smallest error of the runs, since no run is as accurate.
    Not(f64),
    /// There are no runs.
    Missing,
}

impl Reached {
    /// [s/s] The cost, if the error was reached.
    pub fn cost(self) -> Option<f64> {
        match self {
            Self::Cost(cost) | Self::AtMost(cost) => Some(cost),
            Self::Not(_) | Self::Missing => None,
        }
    }

    fn print(self) -> String {
        match self {
            Self::Cost(cost) => three_digits(cost),
            Self::AtMost(cost) => format!("≤ {}", three_digits(cost)),
            Self::Not(least) => format!("{} at best", power(least)),
            Self::Missing => "–".into(),
        }
    }
}

/// Cost of `error` in a series, interpolated in logarithmic scales between the runs that no other run beats in both
/// error and cost.
pub fn cost_at(points: &[Point], error: f64) -> Reached {
    let beaten = |own: &Point| {
        let better = |other: &Point| other.error <= own.error && other.cost <= own.cost && other != own;
        points.iter().any(better)
    };
    let mut best: Vec<Point> = points.iter().filter(|own| own.error.is_finite() && !beaten(own)).copied().collect();
    best.sort_by(|a, b| b.error.total_cmp(&a.error));
    let (Some(first), Some(last)) = (best.first(), best.last()) else { return Reached::Missing };
    if error > first.error {
        return Reached::AtMost(first.cost);
    }
    for pair in best.windows(2) {
        let (coarse, fine) = (pair[0], pair[1]);
        if fine.error <= error {
            let share = (coarse.error / error).ln() / (coarse.error / fine.error.max(f64::MIN_POSITIVE)).ln();
            return Reached::Cost(coarse.cost * (fine.cost / coarse.cost).powf(share));
        }
    }
    if error == last.error { Reached::Cost(last.cost) } else { Reached::Not(last.error) }
}

/// The cost of an error in a series; missing where the reference solution itself is less accurate.
fn known_cost(contest: &Contest, series: &Series, error: f64) -> Reached {
    if error < contest.reference_error { Reached::Missing } else { cost_at(&series.points, error) }
}

/// The table: a row for each method of each program.
pub fn table(contest: &Contest) -> Table {
    let mut table = Table::default();
    let mut head = vec![contest.scene.clone()];
    for error in ERRORS {
        head.extend([format!("CPU s/s at {}", power(error)), "× ours".into()]);
    }
    head.push("remarks".into());
    table.line(head);
    for series in &contest.series {
        let mut line = vec![name(series)];
        for error in ERRORS {
            let reached = known_cost(contest, series, error);
            let own = rival(contest, series).and_then(|ours| known_cost(contest, ours, error).cost());
            let ratio = reached.cost().zip(own).map_or("–".into(), |(theirs, own)| three_digits(theirs / own));
            line.extend([reached.print(), ratio]);
        }
        let notes = series.notes.join("; ");
        line.push(notes.clone());
        if series.points.is_empty() { table.gap(line, &notes) } else { table.line(line) }
    }
    table
}

/// A row for each scene: our cost of an error, and the cheapest of all other programs with the same kind of contacts. A
/// ratio below 1 says that the other program is cheaper.
pub fn summary(contests: &[Contest]) -> Table {
    let mut table = Table::default();
    let mut head = vec!["scene".into(), "window [ms]".into()];
    for error in ERRORS {
        head.extend([format!("error {}: CPU s/s", power(error)), "× real time".into()]);
        head.extend(["cheapest peer of all".into(), "× ours".into()]);
    }
    table.line(head);
    for contest in contests {
        let mut line = vec![contest.scene.clone(), three_digits(1e3 * contest.span)];
        for error in ERRORS {
            let reached = contest.series.first().map_or(Reached::Missing, |ours| known_cost(contest, ours, error));
            let speed = match reached {
                Reached::Cost(cost) => three_digits(1.0 / cost),
                Reached::AtMost(cost) => format!("≥ {}", three_digits(1.0 / cost)),
                Reached::Not(_) | Reached::Missing => "–".into(),
            };
            let (peer, ratio) = match reached.cost().zip(best_other(contest, error)) {
                Some((own, (cost, peer))) => (name(peer), three_digits(cost / own)),
                None => ("–".into(), "–".into()),
            };
            line.extend([reached.print(), speed, peer, ratio]);
        }
        table.line(line);
    }
    table
}

/// The cheapest series of the other programs with the same kind of contacts as our first series, with its cost.
fn best_other(contest: &Contest, error: f64) -> Option<(f64, &Series)> {
    let ours = contest.series.first()?;
    let others = contest.series.iter().filter(|series| series.peer != ours.peer && series.rigid == ours.rigid);
    let costs = others.filter_map(|series| Some((known_cost(contest, series, error).cost()?, series)));
    costs.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The series with which a series is compared: the first one with the same kind of contacts.
fn rival<'a>(contest: &'a Contest, series: &Series) -> Option<&'a Series> {
    contest.series.iter().find(|ours| ours.rigid == series.rigid)
}

/// All runs with all numbers.
pub fn write_csv(contests: &[Contest], file: &Path) -> Result<()> {
    let mut csv = csv::Writer::from_path(file)?;
    csv.write_record([
        "scene",
        "peer",
        "method",
        "tolerance_or_step",
        "error",
        "cpu_s_per_s",
        "evaluations_per_s",
        "remarks",
    ])?;
    for contest in contests {
        for series in &contest.series {
            let names = [&contest.scene, &series.peer, &series.method].map(String::clone);
            let remarks = series.notes.join("; ");
            for Point { tolerance, error, cost, evaluations } in &series.points {
                let numbers = [tolerance, error, cost, evaluations].map(f64::to_string);
                csv.write_record(names.iter().chain(&numbers).chain([&remarks]))?;
            }
            if series.points.is_empty() {
                let blank = [const { String::new() }; 4];
                csv.write_record(names.iter().chain(&blank).chain([&remarks]))?;
            }
        }
    }
    Ok(csv.flush()?)
}

/// Cost against error, a panel for each scene.
pub fn sheet(contests: &[Contest]) -> Sheet<Named> {
    Sheet {
        title: "The same scene in what people use instead".into(),
        legend: vec![],
        panels: contests.iter().map(panel).collect(),
        columns: 1,
        panel_size: (1100, 480),
    }
}

fn panel(contest: &Contest) -> Named {
    let drawn = || contest.series.iter().filter(|series| !series.points.is_empty()).enumerate();
    let names = drawn().map(|(number, series)| (Role::Member(number), name(series)));
    let curves = drawn().map(|(number, series)| Curve {
        role: Role::Member(number),
        points: series.points.iter().filter(|point| point.error.is_finite()).map(place).collect(),
        dots: true,
        odd: vec![],
    });
    let panel = LogLog {
        x_label: "largest error over the clearance".into(),
        y_label: "CPU seconds per simulated second".into(),
        series: curves.collect(),
        floor: Some(Bound { at: contest.reference_error, label: "reference's own error".into() }),
        level: Some(Bound { at: 1.0, label: "real time".into() }),
        deadline: None,
        strip: None,
        text: String::new(),
    };
    Named { heading: contest.scene.clone(), panel, names: names.collect() }
}

/// Error 0 is drawn as this number, far below any reference's error.
fn place(point: &Point) -> (f64, f64) {
    (point.error.max(f64::EPSILON), point.cost)
}

fn name(series: &Series) -> String {
    format!("{} {}", series.peer, series.method)
}

/// `1e-4`, or `3.2e-4` if the number is not a power of ten.
fn power(number: f64) -> String {
    let text = format!("{number:.1e}");
    text.replace(".0e", "e")
}

/// One sentence that compares the cheapest of all other programs with ours.
pub fn sentence(contest: &Contest) -> String {
    let Some(ours) = contest.series.first() else { return String::new() };
    let mut parts = vec![];
    for error in ERRORS {
        let Some(own) = known_cost(contest, ours, error).cost() else { continue };
        if let Some((cost, best)) = best_other(contest, error) {
            parts.push(format!("{} {} times at {}", name(best), significant(cost / own), power(error)));
        }
    }
    if parts.is_empty() {
        return format!("{}: nothing to compare.", contest.scene);
    }
    let reference = power(contest.reference_error);
    format!(
        "{}: cheapest peer of all, in our CPU time: {} (reference good to {reference}).",
        contest.scene,
        parts.join(", ")
    )
}
