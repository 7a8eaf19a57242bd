//! Work-precision diagrams: figures with sentences, tables, and a CSV file.

use super::loglog::{Bound, LogLog, Mark, Series};
use super::plot::{Role, Sheet};
use super::table::Table;
use super::units::three_digits;
use crate::precision::choice::Price;
use crate::precision::diagram::{Diagram, Point, Verdict};
use crate::precision::exchange::ExchangePoint;
use crate::precision::hosts::{HostPoint, METHOD, TOLERANCE};
use crate::precision::ladder::{Rung, told};
use anyhow::Result;
use slidercrank::scene::Method;
use std::path::Path;

/// Name of the series of model exchange in a host.
const CVODE: &str = "CVode under FMPy";
/// Errors for which costs are given.
pub const ERRORS: [f64; 3] = [1e-2, 1e-4, 1e-6];
/// Tolerances whose errors are given.
const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];

/// Figure of error and cost of every run, with sentences below.
pub fn sheet(diagram: &Diagram) -> Sheet<LogLog> {
    let methods = diagram.methods();
    let series = methods.iter().enumerate().map(|(number, method)| Series {
        role: Role::Member(number),
        points: diagram.of_method(*method).filter_map(place).collect(),
        dots: true,
        odd: diagram.of_method(*method).filter_map(oddity).collect(),
    });
    let panel = LogLog {
        x_label: "largest position error over the clearance".into(),
        y_label: "CPU seconds per simulated second".into(),
        series: series.collect(),
        floor: Some(Bound { at: diagram.floor, label: "reference's own error".into() }),
        level: Some(Bound { at: 1.0, label: "real time".into() }),
        deadline: None,
        strip: Some("× failed, △ stopped".into()),
        text: sentence(diagram),
    };
    Sheet {
        title: format!("{}: what accuracy costs", diagram.scene),
        legend: methods.iter().enumerate().map(|(i, method)| (Role::Member(i), method.name().into())).collect(),
        panels: vec![panel],
        columns: 1,
        panel_size: (920, 600),
    }
}

/// The same figure with the results of a host's own integrator in model exchange.
pub fn sheet_with(diagram: &Diagram, exchange: &[ExchangePoint]) -> Sheet<LogLog> {
    let mut sheet = sheet(diagram);
    let of_scene = exchange.iter().filter(|point| point.scene == diagram.scene);
    let points: Vec<(f64, f64)> = of_scene
        .filter_map(|point| point.outcome.as_ref().ok())
        .map(|found| (found.error.max(f64::EPSILON), found.cost))
        .collect();
    if !points.is_empty() {
        let role = Role::Member(sheet.legend.len());
        sheet.legend.push((role, CVODE.into()));
        sheet.panels.iter_mut().for_each(|panel| {
            panel.series.push(Series { role, points: points.clone(), dots: true, odd: vec![] });
        });
    }
    sheet
}

/// Coordinates of a run that reached its end. An error of 0 is drawn far below any reference's error.
fn place(point: &Point) -> Option<(f64, f64)> {
    let reached = point.verdict == Verdict::Reached;
    Some((point.error?.max(f64::EPSILON), point.cost?)).filter(|_| reached)
}

/// Mark of a run that did not reach its end.
fn oddity(point: &Point) -> Option<(Mark, Option<f64>)> {
    match point.verdict {
        Verdict::Reached => None,
        Verdict::Failed(_) => Some((Mark::Failed, point.cost)),
        Verdict::Stopped(_) => Some((Mark::Stopped, point.cost)),
    }
}

/// Sentences about a diagram.
pub fn sentence(diagram: &Diagram) -> String {
    let Diagram { scene, window, span, floor, others, .. } = diagram;
    let mut text = format!(
        "{scene}: errors within the first {} ms against a reference that is known to {floor:.0e}, CPU time over {} ms.",
        three_digits(window * 1e3),
        three_digits(span * 1e3)
    );
    for error in ERRORS {
        text += &match diagram.cheapest(error) {
            Some(point) => format!(
                " An error of {error:e} is cheapest with {}: {} s per simulated second, {} times real time.",
                told(point.method, point.rung),
                three_digits(point.cost.unwrap_or_default()),
                three_digits(1.0 / point.cost.unwrap_or(f64::INFINITY))
            ),
            None => format!(" No run keeps an error of {error:e}."),
        };
    }
    let own = Method::default();
    if let Some(factor) = diagram.digit(own) {
        text += &format!(" With {}, the default, one more digit costs {factor:.2} times as much.", own.name());
    }
    let [failed, stopped] = diagram.losses();
    text += &format!(" Of {} runs {failed} failed and {stopped} were stopped.", diagram.points.len());
    for method in others {
        text += &format!(" {} solves another model, with rigid contacts, and is left out.", method.name());
    }
    text
}

/// Table of the cheapest method and tolerance for every error.
pub fn cheapest(diagrams: &[Diagram]) -> Table {
    let mut table = Table::default();
    let mut head = vec!["scene".to_owned(), "window [ms]".into(), "reference".into()];
    head.extend(
        ERRORS.iter().flat_map(|error| [format!("error {error:e}: CPU s/s"), "× real time".into(), "with".into()]),
    );
    head.push("one more digit costs".into());
    table.line(head);
    for diagram in diagrams {
        let mut line =
            vec![diagram.scene.clone(), three_digits(diagram.window * 1e3), format!("{:.0e}", diagram.floor)];
        for error in ERRORS {
            let run = diagram.cheapest(error).and_then(|point| Some((point.cost?, told(point.method, point.rung))));
            line.extend(match run {
                Some((cost, told)) => [three_digits(cost), three_digits(1.0 / cost), told],
                None => ["–", "–", "not reached"].map(String::from),
            });
        }
        line.push(diagram.digit(Method::default()).map_or("–".into(), |factor| format!("× {factor:.2}")));
        if ERRORS.iter().any(|error| diagram.cheapest(*error).is_some()) {
            table.line(line);
        } else {
            table.gap(line, "no run reached any of these errors");
        }
    }
    table
}

/// Table of the cheapest method at every error, interpolated between the tolerances, and of the default method's cost.
pub fn between(diagrams: &[Diagram]) -> Table {
    let mut table = Table::default();
    let own = Method::default();
    let mut head = vec!["between the tolerances".to_owned(), "window [ms]".into(), "CPU time over [ms]".into()];
    head.extend(ERRORS.iter().flat_map(|error| {
        [format!("error {error:e}: × real time"), "with".into(), format!("{}: × real time", own.name())]
    }));
    table.line(head);
    let rate = |price: Price| format!("{}{}", if price.is_bound { "≥ " } else { "" }, three_digits(1.0 / price.cost));
    for diagram in diagrams {
        let mut line =
            vec![diagram.scene.clone(), three_digits(diagram.window * 1e3), three_digits(diagram.span * 1e3)];
        for error in ERRORS {
            line.extend(match diagram.cheapest_between(error) {
                Some((method, price)) => [rate(price), method.name().into()],
                None => ["–", "–"].map(String::from),
            });
            line.push(diagram.between(own, error).map_or("–".into(), rate));
        }
        table.line(line);
    }
    table
}

/// Table of the default method's errors at its tolerances.
pub fn tolerances(diagrams: &[Diagram]) -> Table {
    let mut table = Table::default();
    let mut head = vec![format!("{}, tolerance", Method::default().name())];
    head.extend(TOLERANCES.iter().flat_map(|tolerance| [format!("{tolerance:e}: error"), "× real time".into()]));
    table.line(head);
    for diagram in diagrams {
        let mut line = vec![diagram.scene.clone()];
        for tolerance in TOLERANCES {
            let point = diagram.of_method(Method::default()).find(|point| point.rung == Rung::Tolerance(tolerance));
            let error = point.and_then(|point| point.error).map_or("–".into(), |error| format!("{error:.0e}"));
            let cost = point.and_then(|point| point.cost).map_or("–".into(), |cost| three_digits(1.0 / cost));
            line.extend([error, cost]);
        }
        table.line(line);
    }
    table
}

/// Table of the cost in a host, by communication step.
pub fn hosts(points: &[HostPoint]) -> Table {
    let mut table = Table::default();
    table.row(["FMPy", "communication step", "error", "CPU s/s", "of it in the FMU", "× real time"]);
    for HostPoint { scene, step, outcome } in points {
        let name = scene.clone();
        match outcome {
            Ok(found) => table.row([
                name,
                format!("{} µs", three_digits(step * 1e6)),
                found.error.map_or("–".into(), |error| format!("{error:.0e}")),
                three_digits(found.total),
                three_digits(found.unit),
                three_digits(1.0 / found.total),
            ]),
            Err(why) => table.gap(vec![name, format!("not measured: {why}")], why),
        }
    }
    table
}

/// Table of a host's own integrator with model exchange.
pub fn exchange(points: &[ExchangePoint]) -> Table {
    let mut table = Table::default();
    table.row([CVODE, "tolerance", "error", "CPU s/s", "× real time"]);
    for ExchangePoint { scene, tolerance, outcome } in points {
        let name = scene.clone();
        match outcome {
            Ok(found) => table.row([
                name,
                format!("{tolerance:e}"),
                format!("{:.0e}", found.error),
                three_digits(found.cost),
                three_digits(1.0 / found.cost),
            ]),
            Err(why) => table.line(vec![name, format!("{tolerance:e}"), why.clone(), "–".into(), "–".into()]),
        }
    }
    table
}

/// All runs in SI units, with all numbers.
pub fn write_csv(diagrams: &[Diagram], hosts: &[HostPoint], file: &Path) -> Result<()> {
    let mut csv = csv::Writer::from_path(file)?;
    csv.write_record([
        "scene",
        "host",
        "method",
        "setting",
        "value",
        "communication_step_s",
        "error",
        "cpu_s_per_s",
        "evaluations_per_s",
        "cost_over_s",
        "window_s",
        "reference_error",
        "verdict",
        "reason",
    ])?;
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    for diagram in diagrams {
        for point in &diagram.points {
            let Point { method, rung, error, cost, evaluations, over, verdict } = point;
            let (verdict, reason) = match verdict {
                Verdict::Reached => ("reached", ""),
                Verdict::Failed(why) => ("failed", why.as_str()),
                Verdict::Stopped(why) => ("stopped", why.as_str()),
            };
            let value = format!("{:e}", rung.number());
            let numbers =
                [*error, *cost, *evaluations, Some(*over), Some(diagram.window), Some(diagram.floor)].map(number);
            let texts = [&diagram.scene, "", method.name(), rung.parameter(), &value, ""].map(String::from);
            csv.write_record(texts.into_iter().chain(numbers).chain([verdict, reason].map(String::from)))?;
        }
    }
    for HostPoint { scene, step, outcome } in hosts {
        let [value, step] = [TOLERANCE, *step].map(|number| format!("{number:e}"));
        let texts = [scene, "FMPy", METHOD.name(), "solver.tolerance", &value, &step].map(String::from);
        let (numbers, ending) = match outcome {
            Ok(found) => {
                let window = Some(found.window);
                let numbers = [found.error, Some(found.total), Some(found.evaluations), Some(found.over), window, None];
                (numbers, ["reached".to_owned(), String::new()])
            }
            Err(why) => ([None; 6], ["not measured".to_owned(), why.clone()]),
        };
        csv.write_record(texts.into_iter().chain(numbers.map(number)).chain(ending))?;
    }
    Ok(csv.flush()?)
}
