//! The comparison of contact laws as a table, as columns and as a figure.

use super::dots::{Dot, Dots};
use super::plot::{Role, Sheet};
use super::table::Table;
use super::units::{grouped, three_digits};
use crate::frame::{Column, Frame};
use crate::laws::{Case, Comparison, JointLoads, Loads};
use crate::sweep::quantity::Reduction;
use anyhow::Result;
use slidercrank::scene::{DampingLaw, Elasticity};

/// A case with its results.
type Row = (Case, Result<Loads>);

/// A quantity of a joint: head, name, factor for display, and function that reads it from the joint's loads and those
/// of the ideal joint.
type OfJoint = (&'static str, &'static str, f64, fn(&JointLoads, Option<&JointLoads>) -> f64);

/// A quantity of the mechanism.
type OfAll = (&'static str, &'static str, f64, fn(&Loads) -> f64);

const JOINT: [OfJoint; 8] = [
    ("peak force [kN]", "force.peak", 1e-3, |joint, _| joint.peak),
    ("× ideal", "force.peak_ratio", 1.0, |joint, ideal| ideal.map_or(f64::NAN, |ideal| joint.peak / ideal.peak)),
    ("peaks of the turns: mean [kN]", "force.turn_peaks.mean", 1e-3, |joint, _| Reduction::Mean.of(&joint.turn_peaks)),
    ("least", "force.turn_peaks.min", 1e-3, |joint, _| Reduction::Min.of(&joint.turn_peaks)),
    ("deviation", "force.turn_peaks.deviation", 1e-3, |joint, _| Reduction::Deviation.of(&joint.turn_peaks)),
    ("approach [m/s]", "impact.speed", 1.0, |joint, _| joint.approach),
    ("touches", "impacts", 1.0, |joint, _| joint.touches),
    ("penetration [µm]", "penetration", 1e6, |joint, _| joint.penetration),
];

const ALL: [OfAll; 5] = [
    ("slider error: max [µm]", "accuracy.position.max", 1e6, |loads| loads.error_max),
    ("RMS [µm]", "accuracy.position.rms", 1e6, |loads| loads.error_rms),
    ("drive torque [N·m]", "drive.torque.peak", 1.0, |loads| loads.torque),
    ("lost per turn [J]", "energy.dissipated.per_turn", 1.0, |loads| loads.loss),
    ("CPU ms/s", "cpu_s_per_s", 1e3, |loads| loads.time),
];

/// The place of a dot, and the range around it.
type Place = (f64, Option<(f64, f64)>);

/// A number of the table; a number that the scene does not have is a dash.
fn cell(number: f64) -> String {
    match number {
        number if !number.is_finite() => "–".into(),
        // What is left of a loss that is none, such as -2.4e-8 J.
        number if number != 0.0 && number.abs() < 1e-3 => format!("{number:.1e}"),
        // A count.
        number if number.fract() == 0.0 => grouped(number),
        number => three_digits(number),
    }
}

/// The loads of the ideal mechanism, if it could run.
fn ideal(rows: &[Row]) -> Option<&Loads> {
    rows.iter().find(|(case, _)| *case == Case::Ideal).and_then(|(_, found)| found.as_ref().ok())
}

/// A table with one row for each case.
pub fn table(comparison: &Comparison, rows: &[Row]) -> Table {
    let mut table = Table::default();
    let of_joints = comparison.joints.iter().flat_map(|joint| {
        JOINT.iter().enumerate().map(move |(place, (head, ..))| match place {
            0 => format!("{joint}: {head}"),
            _ => (*head).to_owned(),
        })
    });
    let head = ["elasticity, law".to_owned()].into_iter().chain(of_joints).chain(ALL.map(|(head, ..)| head.to_owned()));
    let head: Vec<String> = head.collect();
    let width = head.len();
    table.line(head);
    for (case, found) in rows {
        let mut line = vec![case.name()];
        match found {
            Ok(loads) => {
                for (place, joint) in loads.joints.iter().enumerate() {
                    let ideal = ideal(rows).map(|ideal| &ideal.joints[place]);
                    line.extend(JOINT.iter().map(|(.., factor, of)| cell(factor * of(joint, ideal))));
                }
                line.extend(ALL.iter().map(|(.., factor, of)| cell(factor * of(loads))));
                table.line(line);
            }
            Err(error) => {
                line.resize(width, "–".into());
                table.gap(line, &format!("{error:#}"));
            }
        }
    }
    table
}

/// All numbers in SI units. A case that has none has its reason as status.
pub fn frame(comparison: &Comparison, rows: &[Row]) -> Frame {
    let text = |of: fn(&Row) -> String| Column::Texts(rows.iter().map(of).collect());
    let found = || rows.iter().map(|(_, found)| found.as_ref().ok());
    let mut frame = Frame::default()
        .with("elasticity", text(|(case, _)| case.elasticity().map_or("", Elasticity::name).into()))
        .with("law", text(|(case, _)| case.law().map_or("", DampingLaw::name).into()));
    for (place, joint) in comparison.joints.iter().enumerate() {
        let ideal = ideal(rows).map(|ideal| &ideal.joints[place]);
        for (_, name, _, of) in JOINT {
            let number = |loads: Option<&Loads>| loads.map_or(f64::NAN, |loads| of(&loads.joints[place], ideal));
            frame = frame.reals(format!("joint.{joint}.{name}"), found().map(number));
        }
    }
    for (_, name, _, of) in ALL {
        frame = frame.reals(name, found().map(|loads| loads.map_or(f64::NAN, of)));
    }
    frame.with("status", text(|(_, found)| found.as_ref().map_or_else(|error| format!("{error:#}"), |_| "ok".into())))
}

/// Figure of peak forces and errors by law, with a dot for each elasticity.
pub fn sheet(comparison: &Comparison, rows: &[Row]) -> Sheet<Dots> {
    let mut elasticities: Vec<Option<Elasticity>> = vec![];
    for (case, _) in rows.iter().filter(|(case, _)| *case != Case::Ideal) {
        if !elasticities.contains(&case.elasticity()) {
            elasticities.push(case.elasticity());
        }
    }
    // For each law, the dots of all elasticities.
    let panel = |label: String, level: Option<f64>, dot: &dyn Fn(&Loads) -> Place| {
        let dot = |elasticity: Option<Elasticity>, law: DampingLaw, role: Role| {
            let found = rows.iter().find(|(case, _)| *case == Case::Laws { elasticity, law });
            let (value, range) = dot(found?.1.as_ref().ok()?);
            Some(Dot { value, role, range })
        };
        let row = |law: &DampingLaw| {
            let dots =
                elasticities.iter().enumerate().map(|(place, elasticity)| dot(*elasticity, *law, Role::Member(place)));
            (law.name().to_owned(), dots.collect())
        };
        Dots { label, rows: DampingLaw::ALL.iter().map(row).collect(), level }
    };
    let mut panels = vec![];
    for (place, joint) in comparison.joints.iter().enumerate() {
        let range = |peaks: &[f64]| {
            let (low, high) = (Reduction::Min.of(peaks), Reduction::Max.of(peaks));
            low.is_finite().then_some((1e-3 * low, 1e-3 * high))
        };
        let dot = |loads: &Loads| (1e-3 * loads.joints[place].peak, range(&loads.joints[place].turn_peaks));
        let level = ideal(rows).map(|ideal| 1e-3 * ideal.joints[place].peak);
        panels.push(panel(format!("peak force in joint {joint} [kN]; line: peaks of the single turns"), level, &dot));
    }
    panels.push(panel("slider's position error, RMS [µm]".into(), None, &|loads| (1e6 * loads.error_rms, None)));
    let name = |elasticity: &Option<Elasticity>| elasticity.map_or("guide", Elasticity::name).to_owned();
    let members = elasticities.iter().enumerate().map(|(place, elasticity)| (Role::Member(place), name(elasticity)));
    let columns = panels.len().min(2);
    Sheet {
        title: format!("{}: peak force and error by damping law and elasticity", comparison.file.name),
        legend: members.chain([(Role::Ideal, "ideal joints".to_owned())]).collect(),
        panels,
        columns,
        panel_size: (600, 46 * DampingLaw::ALL.len() as u32 + 70),
    }
}
