//! Figures, tables and columns of a motion over many turns.

use super::plot::{Curve, Mark, Panel, Role, Sheet};
use super::table::Table;
use super::units::{Shown, known, significant, three_digits};
use crate::dynamics::bifurcation::{Branch, Range};
use crate::dynamics::continuation::{Branch as Orbits, Found};
use crate::dynamics::exponents::Exponents;
use crate::dynamics::lyapunov::Exponent;
use crate::dynamics::machine::clearances;
use crate::dynamics::orbit::Orbit;
use crate::dynamics::portrait::Portrait;
use crate::dynamics::section::Visit;
use crate::dynamics::verdict::{SAME, Verdict};
use crate::frame::{Column, Frame};
use nalgebra::Complex;
use slidercrank::model::signals::{Outputs, RevoluteOutputs};
use slidercrank::scene::Scene;
use slidercrank::scene::parameter::Parameter;
use std::f64::consts::TAU;

/// Number of decades below its peak down to which a spectrum is drawn.
const DECADES: f64 = 12.0;

/// The journal of a joint.
fn journal(joint: char, outputs: &Outputs) -> RevoluteOutputs {
    match joint {
        'A' => outputs.joint_a,
        'B' => outputs.joint_b,
        _ => outputs.joint_c,
    }
}

/// The figure of one scene.
pub fn sheet(title: &str, scene: &Scene, portrait: &Portrait) -> Sheet {
    let journals: Vec<(char, f64)> = clearances(scene).into_iter().filter(|(joint, _)| *joint != 'T').collect();
    let mut panels = vec![phase_portrait(&portrait.path)];
    for &(joint, clearance) in &journals {
        panels.push(in_bearing(joint, clearance, &portrait.path, Mark::Path, "path"));
        panels.push(in_bearing(joint, clearance, &portrait.visits, Mark::Dots, "once a turn"));
    }
    panels.push(slider_section(&portrait.visits));
    if !journals.is_empty() {
        panels.push(impacts(portrait, &journals));
    }
    panels.push(spectrum(&portrait.spectrum));
    panels.push(convergence(portrait));
    if let Some(Ok(exponents)) = &portrait.exponents {
        panels.push(all_exponents(exponents, portrait.turn));
    }
    let legend = vec![(Role::Actual, "motion, and its passages once a turn".into()), (Role::Limit, "clearance".into())];
    Sheet { title: format!("{title}: {}", sentence(portrait)), legend, panels, columns: 3, panel_size: (440, 400) }
}

fn curve(role: Role, points: Vec<(f64, f64)>, mark: Mark) -> Curve {
    Curve { role, points, mark }
}

/// An output with its name and unit.
struct Quantity {
    name: &'static str,
    unit: &'static str,
    of: fn(&Outputs) -> f64,
}

/// Two quantities of the section's points, in suitable units.
fn plane(visits: &[Visit], [x, y]: [Quantity; 2], mark: Mark) -> Panel {
    let shown = |quantity: &Quantity| {
        let peak = visits.iter().map(|visit| (quantity.of)(&visit.outputs).abs()).fold(0.0, f64::max);
        Shown::of(quantity.unit, peak)
    };
    let (of_x, of_y) = (shown(&x), shown(&y));
    let point = |visit: &Visit| ((x.of)(&visit.outputs) * of_x.factor, (y.of)(&visit.outputs) * of_y.factor);
    Panel {
        x_label: of_x.axis(x.name),
        y_label: of_y.axis(y.name),
        curves: vec![curve(Role::Actual, visits.iter().map(point).collect(), mark)],
        square: false,
    }
}

fn phase_portrait(path: &[Visit]) -> Panel {
    let velocity = Quantity { name: "slider velocity", unit: "m/s", of: |outputs| outputs.slider.v };
    let acceleration = Quantity { name: "slider acceleration", unit: "m/s2", of: |outputs| outputs.slider.a };
    plane(path, [velocity, acceleration], Mark::Path)
}

fn slider_section(visits: &[Visit]) -> Panel {
    let of_position = |outputs: &Outputs| outputs.accuracy.position;
    let position = Quantity { name: "slider's position error, once a turn", unit: "m", of: of_position };
    let velocity = Quantity { name: "velocity error", unit: "m/s", of: |outputs| outputs.accuracy.velocity };
    plane(visits, [position, velocity], Mark::Dots)
}

fn in_bearing(joint: char, clearance: f64, visits: &[Visit], mark: Mark, what: &str) -> Panel {
    let shown = Shown::of("m", clearance);
    let circle = (0..=180).map(|step| TAU * f64::from(step) / 180.0);
    let circle = circle.map(|angle| (clearance * angle.cos() * shown.factor, clearance * angle.sin() * shown.factor));
    let place = |visit: &Visit| {
        let [x, y] = journal(joint, &visit.outputs).eccentricity;
        (x * shown.factor, y * shown.factor)
    };
    Panel {
        x_label: shown.axis(&format!("journal of {joint} along the guide, {what}")),
        y_label: shown.axis("across"),
        curves: vec![
            curve(Role::Limit, circle.collect(), Mark::Line),
            curve(Role::Actual, visits.iter().map(place).collect(), mark),
        ],
        square: true,
    }
}

fn impacts(portrait: &Portrait, journals: &[(char, f64)]) -> Panel {
    let curves = journals.iter().enumerate().map(|(number, (joint, _))| {
        let of_joint = portrait.impacts.iter().filter(|impact| impact.joint == *joint);
        let points = of_joint.map(|impact| (impact.crank.to_degrees(), impact.speed));
        curve(if journals.len() == 1 { Role::Actual } else { Role::Member(number) }, points.collect(), Mark::Dots)
    });
    let names: String = journals.iter().map(|(joint, _)| *joint).collect();
    Panel {
        x_label: format!("crank angle at impact in {names} [°]"),
        y_label: "approach speed [m/s]".into(),
        curves: curves.collect(),
        square: false,
    }
}

fn spectrum(density: &[(f64, f64)]) -> Panel {
    let peak = density.iter().map(|(_, density)| *density).fold(0.0, f64::max);
    let kept = density.iter().skip(1).filter(|(_, density)| *density > peak * 10f64.powf(-DECADES));
    Panel {
        x_label: "log10 of frequency [Hz]".into(),
        y_label: "log10 of the acceleration's density [(m/s²)²/Hz]".into(),
        curves: vec![curve(Role::Actual, kept.map(|(f, d)| (f.log10(), d.log10())).collect(), Mark::Line)],
        square: false,
    }
}

fn convergence(portrait: &Portrait) -> Panel {
    let history = &portrait.exponent.history;
    let turns = |time: f64| (time - history.first().map_or(0.0, |(first, _)| *first)) / portrait.turn;
    let points: Vec<(f64, f64)> = history.iter().map(|(time, mean)| (turns(*time), mean * portrait.turn)).collect();
    let ends = points.first().into_iter().chain(points.last()).map(|point| (point.0, 0.0)).collect();
    Panel {
        x_label: "turns".into(),
        y_label: "mean exponent so far [1/turn]".into(),
        curves: vec![curve(Role::Limit, ends, Mark::Line), curve(Role::Actual, points, Mark::Line)],
        square: false,
    }
}

/// All exponents with their standard errors, in order.
fn all_exponents(exponents: &Exponents, turn: f64) -> Panel {
    let bars = exponents.all.iter().enumerate().map(|(number, Exponent { value, error, .. })| {
        let (place, reach) = (1.0 + number as f64, if error.is_finite() { *error } else { 0.0 });
        let ends = [-reach, reach].map(|reach| (place, (value + reach) * turn));
        curve(Role::Actual, ends.to_vec(), Mark::Line)
    });
    let points = exponents.all.iter().zip(1..).map(|(exponent, number)| (f64::from(number), exponent.value * turn));
    let zero = vec![(1.0, 0.0), (exponents.all.len() as f64, 0.0)];
    let mut curves = vec![curve(Role::Limit, zero, Mark::Line), curve(Role::Actual, points.collect(), Mark::Dots)];
    curves.extend(bars);
    Panel { x_label: "number of the exponent".into(), y_label: "exponent [1/turn]".into(), curves, square: false }
}

/// All exponents with their sum and dimension; `None` if they were not asked for.
pub fn exponent_table(portrait: &Portrait) -> Option<Table> {
    let mut table = Table::default();
    table.row(["exponents from the tangent", "[1/s]", "standard error [1/s]", "[1/turn]"]);
    let exponents = match portrait.exponents.as_ref()? {
        Ok(exponents) => exponents,
        Err(error) => {
            table.gap(["all", "–", "–", "–"].map(Into::into).to_vec(), &format!("{error:#}"));
            return Some(table);
        }
    };
    let shown = |value: f64| [value, value * portrait.turn].map(three_digits);
    for (number, Exponent { value, error, .. }) in exponents.all.iter().enumerate() {
        let [second, turn] = shown(*value);
        // Of few intervals there is no standard error.
        table.row([(number + 1).to_string(), second, known(*error), turn]);
    }
    let [second, turn] = shown(exponents.sum());
    table.row(["sum".into(), second, String::new(), turn]);
    table.row([
        "dimension of Kaplan and Yorke".into(),
        format!("{:.3}", exponents.dimension()),
        String::new(),
        String::new(),
    ]);
    let share = format!("{} of {}", exponents.left_out, exponents.intervals);
    table.row(["intervals left out near grazing".into(), share, String::new(), String::new()]);
    let largest = exponents.all.first()?;
    let both = largest.error.hypot(portrait.exponent.error);
    let apart = (largest.value - portrait.exponent.value).abs() / both;
    table.row([
        "largest less that of two trajectories, in standard errors".into(),
        known(if both.is_finite() { apart } else { f64::INFINITY }),
        String::new(),
        String::new(),
    ]);
    Some(table)
}

/// The verdict with its evidence.
pub fn sentence(portrait: &Portrait) -> String {
    let (evidence, exponent) = (&portrait.evidence, &portrait.exponent);
    let [value, error] = [exponent.value, exponent.error].map(|number| known(number * portrait.turn));
    format!(
        "{}; exponent {value} ± {error} a turn; best repetition after {} turns, within {} clearances or \
         hundredths of the speed",
        evidence.verdict,
        evidence.repeats_after,
        significant(evidence.misses_by)
    )
}

/// The verdict with its evidence as a table.
pub fn table(portrait: &Portrait) -> Table {
    let (evidence, exponent) = (&portrait.evidence, &portrait.exponent);
    let mut table = Table::default();
    table.row(["what", "value"]);
    table.row(["verdict", &evidence.verdict.to_string()]);
    table.row(["largest Lyapunov exponent [1/s]", &three_digits(exponent.value)]);
    table.row(["its standard error [1/s]", &known(exponent.error)]);
    table.row(["mean time of a turn [s]", &significant(portrait.turn)]);
    table.row(["the exponent in one turn", &three_digits(exponent.value * portrait.turn)]);
    table.row(["turns looked at", &portrait.visits.len().to_string()]);
    table.row(["best repetition after turns", &evidence.repeats_after.to_string()]);
    table.row(["which misses by, in clearances or hundredths of the speed", &significant(evidence.misses_by)]);
    table.row(["counts as the same below", &significant(SAME)]);
    table.row(["impacts of journals in the last turns", &portrait.impacts.len().to_string()]);
    table
}

/// Points of the section as columns.
pub fn visits(visits: &[Visit]) -> Frame {
    let column = |of: fn(&Outputs) -> f64| visits.iter().map(move |visit| of(&visit.outputs));
    let mut frame = Frame::default()
        .reals("time", visits.iter().map(|visit| visit.time))
        .reals("crank.angle", column(|outputs| outputs.crank.angle))
        .reals("slider.x", column(|outputs| outputs.slider.x))
        .reals("slider.v", column(|outputs| outputs.slider.v))
        .reals("slider.a", column(|outputs| outputs.slider.a))
        .reals("slider.y", column(|outputs| outputs.slider.y))
        .reals("slider.angle", column(|outputs| outputs.slider.angle))
        .reals("accuracy.position", column(|outputs| outputs.accuracy.position))
        .reals("accuracy.velocity", column(|outputs| outputs.accuracy.velocity));
    for joint in ['A', 'B', 'C'] {
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let values = visits.iter().map(|visit| journal(joint, &visit.outputs).eccentricity[axis]);
            frame = frame.reals(format!("joint.{joint}.eccentricity.{name}"), values.collect::<Vec<_>>());
        }
    }
    frame
}

/// Impacts as columns.
pub fn impact_frame(portrait: &Portrait) -> Frame {
    let column = |of: fn(&crate::dynamics::section::Impact) -> f64| portrait.impacts.iter().map(of).collect::<Vec<_>>();
    Frame::default()
        .reals("time", column(|impact| impact.time))
        .with("joint", Column::Texts(portrait.impacts.iter().map(|impact| impact.joint.to_string()).collect()))
        .reals("crank.angle", column(|impact| impact.crank))
        .reals("place", column(|impact| impact.place))
        .reals("speed", column(|impact| impact.speed))
}

/// Frequency and density as columns.
pub fn spectrum_frame(portrait: &Portrait) -> Frame {
    let [frequency, density] = [0, 1].map(|which| {
        portrait.spectrum.iter().map(move |(frequency, density)| if which == 0 { *frequency } else { *density })
    });
    Frame::default().reals("frequency", frequency.collect::<Vec<_>>()).reals("density", density.collect::<Vec<_>>())
}

/// A bifurcation diagram over the parameter: slider velocity and a journal's position at every point of the section,
/// and the exponent.
pub fn bifurcation(title: &str, scene: &Scene, range: &Range, branches: &[&Branch], orbits: &[Orbits]) -> Sheet {
    let unit = Parameter::named(&range.name).map_or("1", Parameter::unit);
    let peak = range.values.iter().fold(0.0, |peak: f64, value| peak.max(value.abs()));
    let shown = Shown::of(unit, peak);
    let x_label = shown.axis(&range.name);
    let found =
        || branches.iter().filter_map(|branch| Some((branch.value * shown.factor, branch.outcome.as_ref().ok()?)));
    let over = |of: &dyn Fn(&Outputs) -> f64| -> Vec<(f64, f64)> {
        found()
            .flat_map(|(x, (visits, _))| visits.iter().map(move |visit| (x, visit.outputs)))
            .map(|(x, o)| (x, of(&o)))
            .collect()
    };
    let dots = |y_label: &str, of: &dyn Fn(&Outputs) -> f64| {
        let mut curves = vec![curve(Role::Actual, over(of), Mark::Dots)];
        curves.extend(orbits.iter().flat_map(|branch| orbit_curves(branch, shown.factor, of)));
        Panel { x_label: x_label.clone(), y_label: y_label.into(), curves, square: false }
    };
    let mut panels = vec![dots("slider velocity once a turn [m/s]", &|outputs| outputs.slider.v)];
    if let Some((joint, _)) = clearances(scene).into_iter().find(|(joint, _)| *joint != 'T') {
        let label = format!("journal of {joint} across the guide [µm]");
        panels.push(dots(&label, &|outputs| 1e6 * journal(joint, outputs).eccentricity[1]));
    }
    let exponents: Vec<(f64, f64)> = found().map(|(x, (_, evidence))| (x, evidence.exponent)).collect();
    let ends = exponents.first().into_iter().chain(exponents.last()).map(|point| (point.0, 0.0)).collect();
    panels.push(Panel {
        x_label: x_label.clone(),
        y_label: "largest exponent [1/s]".into(),
        curves: vec![curve(Role::Limit, ends, Mark::Path), curve(Role::Actual, exponents, Mark::Path)],
        square: false,
    });
    let upper = panels.len() - 1;
    panels[..upper].iter_mut().for_each(|panel| panel.x_label.clear());
    let mut legend = vec![(Role::Actual, format!("every visit of {} values", branches.len()))];
    if !orbits.is_empty() {
        legend.extend([(STABLE, "periodic, stable".into()), (UNSTABLE, "periodic, unstable".into())]);
        legend.push((SPECIAL, "where they change".into()));
    }
    Sheet { title: format!("{title}: bifurcation"), legend, panels, columns: 1, panel_size: (1100, 300) }
}

/// Colours of periodic motions.
const STABLE: Role = Role::Member(0);
const UNSTABLE: Role = Role::Member(1);
const SPECIAL: Role = Role::Member(3);

/// The stable and unstable parts of a branch, one curve for each passage of a period, and its bifurcations.
fn orbit_curves(branch: &Orbits, factor: f64, of: &dyn Fn(&Outputs) -> f64) -> Vec<Curve> {
    let mut curves = vec![];
    for passage in 0..branch.turns {
        let point = |orbit: &Orbit| Some((orbit.value * factor, of(&orbit.visits.get(passage)?.outputs)));
        for part in branch.orbits.chunk_by(|one, other| one.is_stable() == other.is_stable()) {
            let role = if part[0].is_stable() { STABLE } else { UNSTABLE };
            curves.push(curve(role, part.iter().filter_map(point).collect(), Mark::Path));
        }
        curves.push(curve(SPECIAL, branch.found.iter().filter_map(|found| point(&found.orbit)).collect(), Mark::Dots));
    }
    curves
}

/// The bifurcations of all branches.
pub fn bifurcations(range: &Range, branches: &[Orbits]) -> Table {
    let mut table = Table::default();
    table.row([range.name.as_str(), "change", "period [turns]", "largest multiplier", "its modulus"]);
    for branch in branches {
        for Found { kind, orbit } in &branch.found {
            let Complex { re, im } = orbit.largest();
            let multiplier = if im == 0.0 { format!("{re:.6}") } else { format!("{re:.6} ± {:.6}i", im.abs()) };
            table.row([
                format!("{:.6e}", orbit.value),
                kind.to_string(),
                branch.turns.to_string(),
                multiplier,
                format!("{:.6}", orbit.largest().norm()),
            ]);
        }
    }
    table
}

/// The branches, and why they end.
pub fn ends(branches: &[Orbits]) -> Table {
    let mut table = Table::default();
    table.row(["branch", "period [turns]", "motions", "of them stable", "from", "to", "its end"]);
    for (number, branch) in branches.iter().enumerate() {
        let stable = branch.orbits.iter().filter(|orbit| orbit.is_stable()).count();
        let [from, to] = [branch.orbits.first(), branch.orbits.last()]
            .map(|orbit| orbit.map_or_else(|| "–".into(), |orbit| format!("{:.6e}", orbit.value)));
        table.row([
            (number + 1).to_string(),
            branch.turns.to_string(),
            branch.orbits.len().to_string(),
            stable.to_string(),
            from,
            to,
            branch.end.clone(),
        ]);
    }
    table
}

/// All passages of all periodic motions as columns.
pub fn orbit_frame(range: &Range, branches: &[Orbits]) -> Frame {
    let rows: Vec<(usize, &Orbit, Visit)> = (1..)
        .zip(branches)
        .flat_map(|(number, branch)| branch.orbits.iter().map(move |orbit| (number, orbit)))
        .flat_map(|(number, orbit)| orbit.visits.iter().map(move |visit| (number, orbit, *visit)))
        .collect();
    let column = |of: &dyn Fn(&(usize, &Orbit, Visit)) -> f64| rows.iter().map(of).collect::<Vec<_>>();
    let mut frame = Frame::default()
        .reals(range.name.clone(), column(&|(_, orbit, _)| orbit.value))
        .reals("branch", column(&|(number, ..)| *number as f64))
        .reals("turns", column(&|(_, orbit, _)| orbit.turns as f64))
        .reals("stable", column(&|(_, orbit, _)| f64::from(u8::from(orbit.is_stable()))))
        .reals("multiplier", column(&|(_, orbit, _)| orbit.largest().norm()));
    let passages: Vec<Visit> = rows.iter().map(|(.., visit)| *visit).collect();
    for (name, column) in visits(&passages).columns() {
        frame = frame.with(name.clone(), column.clone());
    }
    frame
}

/// All points of the section for all values as columns.
pub fn bifurcation_frame(range: &Range, branches: &[&Branch]) -> Frame {
    let mut rows: Vec<(f64, Visit)> = Vec::new();
    let mut verdicts = Vec::new();
    for branch in branches {
        if let Ok((visits, evidence)) = &branch.outcome {
            rows.extend(visits.iter().map(|visit| (branch.value, *visit)));
            verdicts.extend(visits.iter().map(|_| evidence.verdict.to_string()));
        }
    }
    let all: Vec<Visit> = rows.iter().map(|(_, visit)| *visit).collect();
    let mut frame =
        Frame::default().reals(range.name.clone(), rows.iter().map(|(value, _)| *value).collect::<Vec<_>>());
    for (name, column) in visits(&all).columns() {
        frame = frame.with(name.clone(), column.clone());
    }
    frame.with("verdict", Column::Texts(verdicts))
}

/// Intervals of the parameter with the same verdict.
pub fn verdicts(range: &Range, branches: &[Branch]) -> Table {
    let name = |branch: &Branch| match &branch.outcome {
        Ok((_, evidence)) => match evidence.verdict {
            Verdict::Periodic(turns) => format!("period {turns}"),
            other => other.to_string(),
        },
        Err(error) => format!("failed: {error:#}"),
    };
    let mut table = Table::default();
    table.row([range.name.as_str(), "to", "values", "verdict"]);
    let mut start = 0;
    for end in 1..=branches.len() {
        if end == branches.len() || name(&branches[end]) != name(&branches[start]) {
            let [from, to] = [start, end - 1].map(|place| format!("{:.4e}", branches[place].value));
            let line = vec![from, to, (end - start).to_string(), name(&branches[start])];
            match &branches[start].outcome {
                Ok(_) => table.line(line),
                Err(error) => table.gap(line, &format!("{error:#}")),
            }
            start = end;
        }
    }
    table
}
