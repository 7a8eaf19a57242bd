//! Tables of the coupled press: strokes, bottom dead centre against clearance, error against communication step.

mod figure;

pub use figure::{clearance_sheet, step_sheet, strokes_sheet};

use super::table::Table;
use super::units::{Shown, significant, three_digits};
use crate::ssp::PRESS;
use crate::ssp::study::{Convergence, DeadCentre, Point, Port, Study};
use crate::trajectory::Trajectory;
use anyhow::Result;
use std::f64::consts::TAU;
use std::path::Path;

/// The masters, in the order of tables and legends.
pub const METHODS: [&str; 3] = ["held", "extrapolated", "iterated"];
/// [s] Range of steps for fitting an order. Longer steps do not resolve the sheet, shorter ones reach the reference's
/// error.
const ORDER_BETWEEN: [f64; 2] = [5e-5, 5e-4];
/// Ports through which power flows into the press.
const PORTS: [&str; 2] = ["load", "torque"];
/// Joints: main bearing, crank pin, slider pin.
const PINS: [&str; 3] = ["A", "B", "C"];

/// Table of the drive and of the pin forces over a stroke.
pub fn strokes(study: &Study) -> Result<Table> {
    let strokes = &study.strokes;
    let per_minute = |speed: f64| format!("{} /min", three_digits(speed * 60.0 / TAU));
    let newton_metres = |torque: f64| Shown::of("N.m", torque).print(torque);
    let energy = |port: &Port| {
        let print = |energy: f64| format!("{} J", significant(energy));
        format!("{} (made by the coupling: {})", print(port.inside), print(port.residual()))
    };
    let mut table = Table::default();
    table.row(["servo press".into(), format!("{} strokes", strokes.strokes)]);
    table.row(["strokes".into(), per_minute(TAU / strokes.lasts)]);
    table.row(["crank's speed, least".into(), per_minute(strokes.slowest)]);
    table.row(["crank's speed, greatest".into(), per_minute(strokes.fastest)]);
    table.row(["torque, largest".into(), newton_metres(strokes.torque)]);
    table.row(["torque, root mean square".into(), newton_metres(strokes.rms_torque)]);
    table.row(["time at the torque limit".into(), format!("{} %", three_digits(1e2 * strokes.limited))]);
    table
        .row(["work on the sheet in a stroke, by the sheet's books".into(), format!("{} J", significant(strokes.cut))]);
    for name in PORTS {
        let port = strokes.ports.get(name).copied().unwrap_or_default();
        table.row([format!("into the press through the {name}, whole run"), energy(&port)]);
    }
    for joint in PINS {
        let largest = pin_force(&study.trajectory, joint)?.into_iter().fold(0.0, f64::max);
        table.row([format!("force in {joint}, largest"), Shown::of("N", largest).print(largest)]);
    }
    Ok(table)
}

/// [N] |F| of a joint of the press at every communication point.
fn pin_force(run: &Trajectory, joint: &str) -> Result<Vec<f64>> {
    let [x, y] = ["x", "y"].map(|axis| run.column(&format!("{PRESS}.joint.{joint}.force.{axis}")));
    Ok(x?.iter().zip(y?).map(|(x, y)| x.hypot(*y)).collect())
}

/// Minimum, mean and maximum of numbers.
pub fn range(numbers: &[f64]) -> [f64; 3] {
    let mean = numbers.iter().sum::<f64>() / numbers.len() as f64;
    let by = |pick: fn(f64, f64) -> f64, from: f64| numbers.iter().copied().fold(from, pick);
    [by(f64::min, f64::INFINITY), mean, by(f64::max, f64::NEG_INFINITY)]
}

/// A length in micrometres.
pub fn clearances(points: &[DeadCentre]) -> Table {
    // What rounds to 0 has no sign.
    let micro = |metres: f64| format!("{:.1}", (metres * 1e7).round() / 10.0 + 0.0);
    let mut table = Table::default();
    let head = ["clearance of A and B [µm]", "slider turns back: least [µm]", "mean", "greatest"];
    table.line(head.into_iter().chain(["under load: least [µm]", "mean", "greatest"]).map(String::from).collect());
    for point in points {
        let mut line = vec![micro(point.clearance)];
        line.extend([&point.dead_centre, &point.loaded].into_iter().flat_map(|numbers| range(numbers)).map(micro));
        table.line(line);
    }
    table
}

/// A row for each master and step.
pub fn steps(study: &Study) -> Table {
    let mut table = Table::default();
    let head = ["master", "step [µs]", "ideal joints: speed error [rad/s]", "slider error [µm]"];
    let more = ["energy made at the load [J]", "at the torque [J]", "passes a step", "CPU s/s"];
    let worn = ["with play: speed error [rad/s]", "slider error [µm]", "energy made at the load [J]"];
    table.line(head.into_iter().chain(more).chain(worn).map(String::from).collect());
    for (ideal, worn) in study.ideal.points.iter().zip(&study.worn.points) {
        table.line(vec![
            ideal.method.clone(),
            three_digits(ideal.step * 1e6),
            small(ideal.speed),
            small(ideal.position * 1e6),
            small(residual(ideal, "load")),
            small(residual(ideal, "torque")),
            three_digits(ideal.passes),
            three_digits(ideal.cost),
            small(worn.speed),
            small(worn.position * 1e6),
            small(residual(worn, "load")),
        ]);
    }
    let floor = |convergence: &Convergence| [convergence.floor.speed, convergence.floor.position * 1e6].map(small);
    let blank = || "–".to_owned();
    let mut line = vec!["between two references".into(), blank()];
    line.extend(floor(&study.ideal));
    line.extend([const { String::new() }; 4].map(|_| blank()));
    line.extend(floor(&study.worn));
    line.push(blank());
    table.line(line);
    table
}

/// [J] Energy that the coupling generated at a port.
fn residual(point: &Point, port: &str) -> f64 {
    point.ports.get(port).map_or(f64::NAN, Port::residual)
}

/// Two significant digits.
fn small(number: f64) -> String {
    format!("{number:.1e}")
}

/// Order of the coupling: exponent of the step in the error of the crank's speed, by least squares.
pub fn order(convergence: &Convergence, method: &str) -> Option<f64> {
    let [least, most] = ORDER_BETWEEN;
    let inside = |point: &&Point| point.method == method && (0.99 * least..=1.01 * most).contains(&point.step);
    let logs = convergence.points.iter().filter(inside).map(|point| (point.step.ln(), point.speed.ln()));
    let logs: Vec<(f64, f64)> = logs.collect();
    let count = logs.len() as f64;
    let (x, y) = (logs.iter().map(|log| log.0).sum::<f64>() / count, logs.iter().map(|log| log.1).sum::<f64>() / count);
    let across: f64 = logs.iter().map(|log| (log.0 - x) * (log.1 - y)).sum();
    let along: f64 = logs.iter().map(|log| (log.0 - x).powi(2)).sum();
    (along > 0.0).then_some(across / along)
}

/// Sentences about the tables.
pub fn sentence(study: &Study) -> String {
    let told = |method: &&str| Some(format!("{:.1} {method}", order(&study.ideal, method)?));
    let orders: Vec<String> = METHODS.iter().filter_map(told).collect();
    let at = |convergence: &Convergence, method: &str| {
        let mut points = convergence.points.iter().filter(|point| point.method == method);
        points.find(|point| (point.step / 1e-4 - 1.0).abs() < 1e-6).map_or("–".into(), |point| small(point.speed))
    };
    let errors = |convergence: &Convergence| METHODS.map(|method| at(convergence, method)).join(", ");
    format!(
        "With ideal joints the error of the crank's speed falls with the communication step to the power {}. At 100 µs it \
         is {} rad/s, in this order; with play {} rad/s. Two references differ by {} rad/s with ideal joints, by {} rad/s \
         with play.",
        orders.join(", "),
        errors(&study.ideal),
        errors(&study.worn),
        small(study.ideal.floor.speed),
        small(study.worn.floor.speed),
    )
}

/// All runs in SI units.
pub fn write_csv(study: &Study, file: &Path) -> Result<()> {
    let mut csv = csv::Writer::from_path(file)?;
    let head = ["joints", "master", "step_s", "speed_error_rad_per_s", "slider_error_m", "passes", "cpu_s_per_s"];
    let books = PORTS.iter().flat_map(|port| ["inside", "outside", "exchanged"].map(|book| format!("{port}_{book}_J")));
    csv.write_record(head.into_iter().map(String::from).chain(books))?;
    for (joints, convergence) in [("ideal", &study.ideal), ("worn", &study.worn)] {
        for point in &convergence.points {
            let mut numbers = vec![point.step, point.speed, point.position, point.passes, point.cost];
            for name in PORTS {
                let Port { inside, outside, exchanged } = point.ports.get(name).copied().unwrap_or_default();
                numbers.extend([inside, outside, exchanged]);
            }
            let names = [joints.to_owned(), point.method.clone()];
            csv.write_record(names.into_iter().chain(numbers.iter().map(f64::to_string)))?;
        }
    }
    Ok(csv.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ssp::study::Floor;

    fn convergence(error: impl Fn(f64) -> f64) -> Convergence {
        let point = |step: f64| Point {
            method: "held".into(),
            step,
            speed: error(step),
            position: 0.0,
            passes: 1.0,
            cost: 1.0,
            ports: Default::default(),
        };
        let points = [1e-5, 5e-5, 1e-4, 2e-4, 5e-4, 2e-3].map(point).into();
        Convergence { points, floor: Floor { speed: 0.0, position: 0.0 } }
    }

    #[test]
    fn an_order_is_the_power_of_the_step_within_the_span_and_no_other_masters() {
        let held = convergence(|step| if (2e-5..1e-3).contains(&step) { 7.0 * step.powf(1.5) } else { 1.0 });
        let found = order(&held, "held").expect("four points");
        assert!((found - 1.5).abs() < 1e-9, "{found}");
        assert_eq!(order(&held, "iterated"), None);
    }

    #[test]
    fn a_range_is_least_mean_and_greatest() {
        assert_eq!(range(&[3.0, -1.0, 4.0]), [-1.0, 2.0, 4.0]);
    }
}
