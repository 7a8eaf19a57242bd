//! The figures of the coupled press, one function a figure.

use super::{METHODS, PINS, PORTS, pin_force, range, residual};
use crate::report::loglog::{Bound, LogLog, Series};
use crate::report::plot::{Curve, Mark, Panel, Role, Sheet};
use crate::report::units::Shown;
use crate::ssp::study::{Convergence, DeadCentre, Point, Study};
use anyhow::Result;
use std::f64::consts::{PI, TAU};

/// Strokes shown: the last whole ones, when what the start was like is forgotten.
const STROKES_SHOWN: f64 = 2.0;

/// Torque, speed, position and pin forces over two strokes, from one top dead centre on.
pub fn strokes_sheet(study: &Study) -> Result<Sheet> {
    let (run, limit) = (&study.trajectory, study.strokes.limit);
    let turns: Vec<f64> = run.column("press.crank.angle")?.iter().map(|angle| (angle - PI) / TAU).collect();
    let last = turns.last().copied().unwrap_or_default().floor();
    let shown = turns.partition_point(|turn| *turn < last - STROKES_SHOWN)..turns.partition_point(|turn| *turn <= last);
    let place = |row: usize| turns[row] - (last - STROKES_SHOWN);
    let curve = |role: Role, values: &[f64], unit: &Shown| {
        let points = shown.clone().map(|row| (place(row), values[row] * unit.factor));
        Curve { role, points: points.collect(), mark: Mark::Line }
    };
    let panel = |name: &str, unit: &Shown, curves: Vec<Curve>| Panel {
        x_label: String::new(),
        y_label: unit.axis(name),
        curves,
        square: false,
    };
    let (torque, speed, place_unit) = (Shown::of("N.m", limit), Shown::of("rad/s", 1.0), Shown::of("m", 0.5));
    let bound = |value: f64| Curve {
        role: Role::Limit,
        points: [0.0, STROKES_SHOWN].map(|turn| (turn, value * torque.factor)).into(),
        mark: Mark::Line,
    };
    let forces = PINS.into_iter().map(|joint| pin_force(run, joint)).collect::<Result<Vec<_>>>()?;
    let newton = Shown::of("N", forces.iter().flatten().copied().fold(0.0, f64::max));
    let pins = forces.iter().enumerate().map(|(number, force)| curve(Role::Member(number), force, &newton));
    let mut panels = vec![
        panel(
            "torque",
            &torque,
            vec![bound(limit), bound(-limit), curve(Role::Actual, run.column("controller.torque")?, &torque)],
        ),
        panel(
            "crank's speed",
            &speed,
            vec![
                curve(Role::Ideal, run.column("controller.set_speed")?, &speed),
                curve(Role::Actual, run.column("press.crank.speed")?, &speed),
            ],
        ),
        panel("slider", &place_unit, vec![curve(Role::Actual, run.column("press.slider.x")?, &place_unit)]),
        panel("pin force", &newton, pins.collect()),
    ];
    if let Some(lowest) = panels.last_mut() {
        lowest.x_label = "strokes, from top dead centre".into();
    }
    let legend = [
        (Role::Actual, "as it runs"),
        (Role::Ideal, "set speed"),
        (Role::Limit, "torque limit"),
        (Role::Member(0), "main bearing A"),
        (Role::Member(1), "crank pin B"),
        (Role::Member(2), "slider pin C"),
    ];
    Ok(Sheet {
        title: "Servo press: two strokes with a blanking load".into(),
        legend: legend.map(|(role, name)| (role, name.into())).into(),
        panels,
        columns: 1,
        panel_size: (960, 220),
    })
}

/// Where the slider turns back, and where it is under load, over clearance.
pub fn clearance_sheet(points: &[DeadCentre]) -> Sheet {
    let curves = |numbers: fn(&DeadCentre) -> &[f64]| {
        [Role::Limit, Role::Actual, Role::Limit].into_iter().enumerate().map(move |(place, role)| Curve {
            role,
            points: points.iter().map(|own| (own.clearance * 1e6, range(numbers(own))[place] * 1e6)).collect(),
            mark: Mark::Line,
        })
    };
    let panel = |name: &str, curves: Vec<Curve>| Panel {
        x_label: "clearance of main bearing and crank pin, the others in proportion [µm]".into(),
        y_label: format!("{name} [µm]"),
        curves,
        square: false,
    };
    Sheet {
        title: "Error of the ram over clearance".into(),
        legend: vec![(Role::Actual, "mean of the strokes".into()), (Role::Limit, "least and greatest".into())],
        panels: vec![
            panel("bottom dead centre beyond its place", curves(|own| &own.dead_centre).collect()),
            panel("position under load, over ideal joints", curves(|own| &own.loaded).collect()),
        ],
        columns: 2,
        panel_size: (600, 400),
    }
}

/// Error and energy made by the coupling over the communication step, for each master.
pub fn step_sheet(study: &Study) -> Sheet<LogLog> {
    let member = METHODS.iter().enumerate().map(|(number, method)| (Role::Member(number), (*method).to_owned()));
    let joints = [("ideal joints", &study.ideal), ("with play", &study.worn)];
    let speed = joints.map(|(name, convergence)| {
        let floor = Bound { at: convergence.floor.speed, label: "between two references".into() };
        let label = format!("rms error of the crank's speed [rad/s], {name}");
        panel(label, convergence, Some(floor), |point| point.speed)
    });
    let energy = joints.map(|(name, convergence)| {
        let label = format!("energy made at the {} [J], {name}", PORTS[0]);
        panel(label, convergence, None, |point| residual(point, PORTS[0]).abs())
    });
    Sheet {
        title: "Servo press: what the communication step does, by master".into(),
        legend: member.collect(),
        panels: speed.into_iter().chain(energy).collect(),
        columns: 2,
        panel_size: (600, 420),
    }
}

fn panel(y_label: String, convergence: &Convergence, level: Option<Bound>, value: impl Fn(&Point) -> f64) -> LogLog {
    let series = METHODS.iter().enumerate().map(|(number, method)| {
        let own = convergence.points.iter().filter(|point| point.method == *method);
        let points = own.map(|point| (point.step, value(point))).filter(|point| point.1 > 0.0);
        Series { role: Role::Member(number), points: points.collect(), dots: true, odd: vec![] }
    });
    LogLog {
        x_label: "communication step [s]".into(),
        y_label,
        series: series.collect(),
        floor: None,
        level,
        deadline: None,
        strip: None,
        text: String::new(),
    }
}
