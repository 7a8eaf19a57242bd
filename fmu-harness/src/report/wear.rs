//! Wear as tables, figure and columns.

use super::plot::{Curve, Mark, Panel, Role, Sheet};
use super::table::Table;
use super::units::{Shown, three_digits};
use crate::frame::{Column, Frame};
use crate::sweep::quantity::Reduction;
use crate::wear::Worn;
use crate::wear::extrapolation::Extrapolation;
use crate::wear::joint::Wearing;

/// What the numbers are, and are not.
pub const SENTENCE: &str = "The sliding work is that of the simulated mechanism; wear follows Archard's law with constant \
coefficients; the mean depth is fed back as clearance and radius, the worn profile is not. Nothing here has been compared \
with an experiment.";

const BODIES: [&str; 2] = ["bearing", "journal"];
const MICRO: f64 = 1e6;
const PICO: f64 = 1e12;

/// State after a step, of one joint.
struct State {
    clearance: f64,
    /// Sum of the error estimates of all steps so far.
    error: f64,
    /// Standard deviation due to the scatter of all steps so far.
    scatter: f64,
    /// Growth per stroke and its standard error.
    growth: [f64; 2],
}

/// A quantity of a state: name, and function that reads it.
type Field = (&'static str, fn(&State) -> f64);

/// Strokes at the start and after each step.
fn strokes(worn: &Worn) -> Vec<f64> {
    let mut sum = 0.0;
    let after = worn.extrapolation.steps.iter().map(|step| {
        sum += step.length;
        sum
    });
    [0.0].into_iter().chain(after).collect()
}

/// States of a joint at the start and after each step.
fn states(worn: &Worn, joints: &[Wearing], number: usize) -> Vec<State> {
    let (mut error, mut variance) = (0.0, 0.0);
    let state = |row: usize| {
        if let Some(step) = row.checked_sub(1).map(|step| &worn.extrapolation.steps[step]) {
            error += step.error[number];
            variance += step.scatter[number].powi(2);
        }
        let run = worn.run_after(row);
        let clearance = run.clearances[number];
        let growth = joints[number].growth(clearance, &run.works[number]);
        State { clearance, error, scatter: f64::sqrt(variance), growth }
    };
    (0..=worn.extrapolation.steps.len()).map(state).collect()
}

/// Clearances and the error at bottom dead centre over the strokes.
pub fn history(worn: &Worn, joints: &[Wearing]) -> Table {
    let mut table = Table::default();
    let mut head = vec!["strokes".to_owned()];
    for Wearing { letter, .. } in joints {
        head.push(format!("{letter}: clearance [µm]"));
        head.extend(["± extrapolation", "± scatter", "growth [pm/stroke]", "±"].map(String::from));
    }
    head.extend(["bottom dead centre [µm]", "±"].map(String::from));
    table.line(head);
    let states: Vec<Vec<State>> = (0..joints.len()).map(|number| states(worn, joints, number)).collect();
    for (row, strokes) in strokes(worn).into_iter().enumerate() {
        let mut line = vec![format!("{strokes:.3e}")];
        for state in states.iter().map(|states| &states[row]) {
            line.push(format!("{:.3}", MICRO * state.clearance));
            line.extend([state.error, state.scatter].map(|part| uncertainty(MICRO * part)));
            let [growth, error] = state.growth.map(|part| PICO * part);
            line.extend([three_digits(growth), uncertainty(error)]);
        }
        let [mean, error] = worn.run_after(row).dead_centre.map(|part| MICRO * part);
        line.extend([three_digits(mean), uncertainty(error)]);
        table.line(line);
    }
    table
}

/// An error with three digits, however small.
fn uncertainty(error: f64) -> String {
    if (f64::MIN_POSITIVE..1e-3).contains(&error) { format!("{error:.2e}") } else { three_digits(error) }
}

/// Worn depths of bearing and journal of each joint at the end.
pub fn depths(worn: &Worn, joints: &[Wearing]) -> Table {
    let mut table = Table::default();
    let head = ["body", "coefficient [m²/N]", "mean depth [µm]", "deepest [µm]", "at [°]", "deepest over mean"];
    table.row(head);
    for (number, joint) in joints.iter().enumerate() {
        for (body, profile) in worn.depths(joints, number).iter().enumerate() {
            let (mean, deepest) = (Reduction::Mean.of(profile), Reduction::Max.of(profile));
            let place = profile.iter().position(|depth| *depth == deepest).unwrap_or_default();
            let ratio = if mean > 0.0 { three_digits(deepest / mean) } else { "–".into() };
            table.row([
                format!("{} {}", joint.letter, BODIES[body]),
                format!("{:e}", joint.coefficients[body]),
                three_digits(MICRO * mean),
                three_digits(MICRO * deepest),
                three_digits(middle(place, profile.len())),
                ratio,
            ]);
        }
    }
    table
}

/// [°] Middle of a sector.
fn middle(sector: usize, sectors: usize) -> f64 {
    360.0 * (sector as f64 + 0.5) / sectors as f64
}

/// A sentence on the work that the extrapolation took.
pub fn effort(worn: &Worn) -> String {
    let Extrapolation { steps, rejected, .. } = &worn.extrapolation;
    format!("Steps: {}; tried again, shorter: {rejected}; runs: {}", steps.len(), worn.runs.len())
}

/// Depths over the angle in each body, and clearance and bottom dead centre over the strokes.
pub fn sheet(title: &str, worn: &Worn, joints: &[Wearing]) -> Sheet {
    let mut panels: Vec<Panel> = (0..joints.len()).map(|number| depth_panel(worn, joints, number)).collect();
    let strokes = strokes(worn);
    let (millions, unit) =
        if strokes.last().is_some_and(|last| *last >= 2e6) { (1e-6, "millions of strokes") } else { (1.0, "strokes") };
    let over = |values: Vec<f64>| -> Vec<(f64, f64)> {
        strokes.iter().zip(values).map(|(strokes, value)| (millions * strokes, MICRO * value)).collect()
    };
    let mut clearances = Vec::new();
    for number in 0..joints.len() {
        let states = states(worn, joints, number);
        let role = member(number, 0);
        let points = |sign: f64| {
            over(states.iter().map(|state| state.clearance + sign * (state.error + 2.0 * state.scatter)).collect())
        };
        clearances.extend([-1.0, 1.0].map(|sign| Curve { role: Role::Limit, points: points(sign), mark: Mark::Line }));
        clearances.extend([Mark::Line, Mark::Dots].map(|mark| Curve { role, points: points(0.0), mark }));
    }
    panels.push(Panel { x_label: unit.into(), y_label: "clearance [µm]".into(), curves: clearances, square: false });
    let centre = |sign: f64| {
        let runs = (0..strokes.len()).map(|row| worn.run_after(row).dead_centre);
        over(runs.map(|[mean, error]| mean + sign * 2.0 * error).collect())
    };
    let mut curves: Vec<Curve> =
        [-1.0, 1.0].map(|sign| Curve { role: Role::Limit, points: centre(sign), mark: Mark::Line }).into();
    curves.extend([Mark::Line, Mark::Dots].map(|mark| Curve { role: Role::Actual, points: centre(0.0), mark }));
    panels.push(Panel {
        x_label: unit.into(),
        y_label: "slider's error at bottom dead centre [µm]".into(),
        curves,
        square: false,
    });
    let mut legend: Vec<(Role, String)> = Vec::new();
    for (number, joint) in joints.iter().enumerate() {
        let names = [0, 1].map(|body| (member(number, body), format!("{} {}", joint.letter, BODIES[body])));
        legend.extend(names);
    }
    legend.push((Role::Limit, "extrapolation's error and two standard errors".into()));
    Sheet { title: format!("{title}: wear"), legend, panels, columns: 2, panel_size: (560, 380) }
}

/// Colour of a body of a joint; that of the bearing is the joint's.
fn member(number: usize, body: usize) -> Role {
    Role::Member(2 * number + body)
}

fn depth_panel(worn: &Worn, joints: &[Wearing], number: usize) -> Panel {
    let profiles = worn.depths(joints, number);
    let shown = Shown::of("m", profiles.iter().flatten().copied().fold(0.0, f64::max));
    let curve = |(body, profile): (usize, &Vec<f64>)| {
        let width = 360.0 / profile.len() as f64;
        let edges = profile
            .iter()
            .enumerate()
            .flat_map(|(sector, depth)| [0.0, 1.0].map(|side| ((sector as f64 + side) * width, shown.factor * depth)));
        Curve { role: member(number, body), points: edges.collect(), mark: Mark::Path }
    };
    Panel {
        x_label: format!("angle in the body's axes, joint {} [°]", joints[number].letter),
        y_label: shown.axis("worn depth"),
        curves: profiles.iter().enumerate().map(curve).collect(),
        square: false,
    }
}

/// The history in SI units, one row for the start and for each step.
pub fn history_frame(worn: &Worn, joints: &[Wearing]) -> Frame {
    let mut frame = Frame::default().reals("strokes", strokes(worn));
    for (number, joint) in joints.iter().enumerate() {
        let states = states(worn, joints, number);
        let columns: [Field; 5] = [
            ("clearance", |state| state.clearance),
            ("clearance.error", |state| state.error),
            ("clearance.scatter", |state| state.scatter),
            ("growth", |state| state.growth[0]),
            ("growth.error", |state| state.growth[1]),
        ];
        for (name, of) in columns {
            frame = frame.reals(joint.variable(name), states.iter().map(of));
        }
        frame = frame.reals(joint.variable("radius"), states.iter().map(|state| joint.radii(state.clearance)[0]));
    }
    let centre =
        |which: usize| (0..=worn.extrapolation.steps.len()).map(move |row| worn.run_after(row).dead_centre[which]);
    frame.reals("dead_centre.error", centre(0)).reals("dead_centre.error.error", centre(1))
}

/// Worn depths at the end in SI units, one row for each sector of each joint.
pub fn depth_frame(worn: &Worn, joints: &[Wearing]) -> Frame {
    let (mut letters, mut angles, mut depths) = (vec![], vec![], [vec![], vec![]]);
    for (number, joint) in joints.iter().enumerate() {
        let profiles = worn.depths(joints, number);
        let sectors = profiles[0].len();
        letters.extend((0..sectors).map(|_| joint.letter.to_string()));
        angles.extend((0..sectors).map(|sector| middle(sector, sectors).to_radians()));
        depths.iter_mut().zip(profiles).for_each(|(all, profile)| all.extend(profile));
    }
    let [bearing, journal] = depths;
    Frame::default()
        .with("joint", Column::Texts(letters))
        .reals("angle", angles)
        .reals("bearing.depth", bearing)
        .reals("journal.depth", journal)
}
