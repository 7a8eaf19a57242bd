//! Tables of one run.

use super::figure::{Pair, force};
use super::table::Table;
use super::units::{Shown, grouped, significant};
use crate::host::Description;
use crate::run::{ANGLE, Cost, JOINTS, Recording};
use anyhow::Result;
use std::f64::consts::TAU;

/// Tables of a slider-crank: peaks with its own and with ideal joints, errors, work and time.
pub fn mechanism(pair: &Pair) -> Result<[Table; 3]> {
    let actual = pair.actual;
    let mut peaks = Table::default();
    peaks.row(["peak", "this", "ideal", "ratio"]);
    for joint in JOINTS {
        peak(&mut peaks, &format!("force in joint {joint}"), "N", [actual, pair.ideal].map(|run| force(run, joint)))?;
    }
    for (name, variable, unit) in [("drive torque", "drive.torque", "N.m"), ("slider acceleration", "slider.a", "m/s2")]
    {
        let column = |run: &Recording| run.column(variable).map(<[f64]>::to_vec);
        peak(&mut peaks, name, unit, [actual, pair.ideal].map(column))?;
    }

    let mut errors = Table::default();
    errors.row(["slider against ideal", "max", "rms"]);
    for (name, unit) in [("position", "m"), ("velocity", "m/s"), ("acceleration", "m/s2")] {
        let error = actual.column(&format!("accuracy.{name}"))?;
        let (max, rms) = (largest(error), (error.iter().map(|e| e * e).sum::<f64>() / error.len() as f64).sqrt());
        let shown = Shown::of(unit, max);
        errors.row([name.into(), shown.print(max), shown.print(rms)]);
    }

    let last = |variable: &str| Ok::<f64, anyhow::Error>(actual.column(variable)?.last().copied().unwrap_or_default());
    let turns = (last(ANGLE)? - actual.column(ANGLE)?.first().copied().unwrap_or_default()).abs() / TAU;
    let mut work = Table::default();
    work.row(["crank turns".into(), significant(turns)]);
    for name in ["steps", "rejected", "evaluations", "events"] {
        work.row([format!("solver {name}"), grouped(last(&format!("solver.{name}"))?)]);
    }
    cost(&mut work, &actual.cost, actual.trajectory.len());
    Ok([peaks, errors, work])
}

fn peak(table: &mut Table, name: &str, unit: &str, columns: [Result<Vec<f64>>; 2]) -> Result<()> {
    let [actual, ideal] = columns.map(|column| column.map(|column| largest(&column)));
    let (actual, ideal) = (actual?, ideal?);
    let shown = Shown::of(unit, actual.max(ideal));
    let ratio = if ideal > 0.0 { format!("{:.2}", actual / ideal) } else { "–".into() };
    table.row([name.into(), shown.print(actual), shown.print(ideal), ratio]);
    Ok(())
}

/// Tables of any FMU: range and last value of every output, and time.
pub fn outputs(description: &Description, recording: &Recording) -> Result<String> {
    let mut table = Table::default();
    table.row(["output", "least", "greatest", "last", "unit"]);
    for name in recording.trajectory.names() {
        let column = recording.column(name)?;
        let variable = description.variable(name)?;
        let least = column.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = column.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let last = column.last().copied().unwrap_or_default();
        let [least, greatest, last] = [least, greatest, last].map(significant);
        table.row([name.clone(), least, greatest, last, description.unit(variable).unwrap_or_default().into()]);
    }
    let mut time = Table::default();
    cost(&mut time, &recording.cost, recording.trajectory.len());
    Ok(format!("{}\n{}", table.print(), time.print()))
}

fn cost(table: &mut Table, cost: &Cost, points: usize) {
    table.row(["simulated".into(), Shown::of("s", cost.simulated).print(cost.simulated)]);
    table.row(["communication points".into(), grouped(points as f64)]);
    let spent = [
        ("fmi2DoStep per simulated second", cost.stepping),
        ("with inputs and outputs", cost.wall),
        ("the same, CPU time", cost.cpu),
    ];
    for (name, spent) in spent {
        let share = spent.as_secs_f64() / cost.simulated;
        let times = format!("{} times real time", significant(1.0 / share));
        table.row([name.into(), Shown::of("s", share).print(share), times]);
    }
}

fn largest(column: &[f64]) -> f64 {
    column.iter().fold(0.0, |peak: f64, value| peak.max(value.abs()))
}
