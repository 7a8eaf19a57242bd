//! Tables of one run.

use super::figure::{self, Pair, force};
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
        // Those between communication points, too, which are 0 without an audit.
        let forces = |run: &Recording| {
            let mut forces = force(run, joint)?;
            forces.extend(run.column(&format!("joint.{joint}.force.peak"))?);
            Ok(forces)
        };
        peak(&mut peaks, &format!("force in joint {joint}"), "N", [actual, pair.ideal].map(forces))?;
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

/// Table of the oil films: largest force, thinnest place, also in heights of the roughness. Dry contact begins at three.
pub fn oil_films(actual: &Recording) -> Result<Table> {
    let mut table = Table::default();
    table.row(["film", "largest force", "thinnest", "over roughness"]);
    for joint in figure::lubricated(actual) {
        let force = largest(actual.column(&format!("joint.{joint}.film.force"))?);
        let thinnest = figure::thickness(actual, joint)?.into_iter().fold(f64::INFINITY, f64::min);
        let roughness = actual.parameter(&format!("joint.{joint}.roughness")).unwrap_or_default();
        table.row([
            format!("in {joint}"),
            Shown::of("N", force).print(force),
            Shown::of("m", thinnest).print(thinnest),
            significant(thinnest / roughness),
        ]);
    }
    Ok(table)
}

/// Table of what lies between communication points, of the joints whose audits are asked for; `None` if there are none.
pub fn intervals(actual: &Recording) -> Result<Option<Table>> {
    let asked = |joint: &str, audit: &str| actual.parameter(&format!("joint.{joint}.{audit}.audit")) == Some(1.0);
    let mut table = Table::default();
    table.row(["joint", "largest force", "fastest touch", "touches", "friction work", "sliding", "work of wear"]);
    for joint in JOINTS.into_iter().filter(|joint| asked(joint, "peak") || asked(joint, "wear")) {
        let column = |name: &str| actual.column(&format!("joint.{joint}.{name}"));
        let of = |name: &str, unit: &str, audit: &str| -> Result<String> {
            let number = largest(column(name)?);
            Ok(if asked(joint, audit) { Shown::of(unit, number).print(number) } else { "–".into() })
        };
        let (speed, touches) = (largest(column("impact.speed")?), largest(column("impacts")?));
        table.row([
            joint.into(),
            of("force.peak", "N", "peak")?,
            Shown::of("m/s", speed).print(speed),
            grouped(touches),
            of("friction.work", "J", "wear")?,
            of("sliding", "m", "wear")?,
            of("wear.work", "J", "wear")?,
        ]);
    }
    Ok(if table.lines().len() > 1 { Some(table) } else { None })
}

/// Table of the energy audit at the end of the run; `None` without one.
pub fn energies(actual: &Recording) -> Result<Option<Table>> {
    if actual.parameter("energy.audit") != Some(1.0) {
        return Ok(None);
    }
    let mut table = Table::default();
    table.row(["energy at the end", ""]);
    for name in
        ["kinetic", "potential", "input", "contact_loss", "friction_loss", "viscous_loss", "modal_loss", "residual"]
    {
        let energy = actual.column(&format!("energy.{name}"))?.last().copied().unwrap_or_default();
        table.row([name.replace('_', " "), Shown::of("J", energy.abs()).print(energy)]);
    }
    Ok(Some(table))
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
