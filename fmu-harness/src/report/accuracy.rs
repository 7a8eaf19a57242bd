//! Kinematic accuracy as a table and as columns.

use super::table::Table;
use super::units::three_digits;
use crate::accuracy::{Accuracy, Case};
use crate::frame::{Column, Frame};
use anyhow::Result;

/// A quantity: name, factor for display, and function that reads it.
type Entry = (&'static str, f64, fn(&Accuracy) -> f64);

/// A quantity: name, and function that reads it.
type Field = (&'static str, fn(&Accuracy) -> f64);

const ENTRIES: [Entry; 15] = [
    ("position: max [µm]", 1e6, |a| a.position.max),
    ("RMS", 1e6, |a| a.position.rms),
    ("mean", 1e6, |a| a.position.mean),
    ("MAD", 1e6, |a| a.position.mad),
    ("velocity: max [m/s]", 1.0, |a| a.velocity.max),
    ("RMS", 1.0, |a| a.velocity.rms),
    ("peak over ideal", 1.0, |a| a.velocity.peak_ratio),
    ("acceleration: max [m/s²]", 1.0, |a| a.acceleration.max),
    ("RMS", 1.0, |a| a.acceleration.rms),
    ("peak over ideal", 1.0, |a| a.acceleration.peak_ratio),
    ("bottom dead centre: error [µm]", 1e6, |a| a.dead_centre.error),
    ("spread", 1e6, |a| a.dead_centre.spread),
    ("range", 1e6, |a| a.dead_centre.range),
    ("tilt, at most [µrad]", 1e6, |a| a.dead_centre.most_tilt),
    ("peak force [kN]", 1e-3, |a| a.peak_force),
];

/// A table with one row for each case.
pub fn table(heading: &str, cases: &[Case], found: &[Result<Accuracy>]) -> Table {
    let mut table = Table::default();
    table.line([heading].into_iter().chain(ENTRIES.map(|(name, ..)| name)).map(String::from).collect());
    for (case, found) in cases.iter().zip(found) {
        let line = |cells: [String; ENTRIES.len()]| [case.name.clone()].into_iter().chain(cells).collect();
        match found {
            Ok(accuracy) => table.line(line(ENTRIES.map(|(_, factor, of)| three_digits(factor * of(accuracy))))),
            Err(error) => table.gap(line(ENTRIES.map(|_| "–".into())), &format!("{error:#}")),
        }
    }
    table
}

/// All quantities in SI units.
pub fn frame(cases: &[Case], found: &[Result<Accuracy>]) -> Frame {
    let kept: Vec<(&Case, &Accuracy)> =
        cases.iter().zip(found).filter_map(|(case, found)| Some((case, found.as_ref().ok()?))).collect();
    let column = |of: fn(&Accuracy) -> f64| kept.iter().map(|(_, accuracy)| of(accuracy)).collect::<Vec<_>>();
    let columns: [Field; 21] = [
        ("position.max", |a| a.position.max),
        ("position.rms", |a| a.position.rms),
        ("position.mean", |a| a.position.mean),
        ("position.mad", |a| a.position.mad),
        ("position.peak_ratio", |a| a.position.peak_ratio),
        ("velocity.max", |a| a.velocity.max),
        ("velocity.rms", |a| a.velocity.rms),
        ("velocity.mean", |a| a.velocity.mean),
        ("velocity.mad", |a| a.velocity.mad),
        ("velocity.peak_ratio", |a| a.velocity.peak_ratio),
        ("acceleration.max", |a| a.acceleration.max),
        ("acceleration.rms", |a| a.acceleration.rms),
        ("acceleration.mean", |a| a.acceleration.mean),
        ("acceleration.mad", |a| a.acceleration.mad),
        ("acceleration.peak_ratio", |a| a.acceleration.peak_ratio),
        ("dead_centre.error", |a| a.dead_centre.error),
        ("dead_centre.spread", |a| a.dead_centre.spread),
        ("dead_centre.range", |a| a.dead_centre.range),
        ("dead_centre.tilt", |a| a.dead_centre.tilt),
        ("dead_centre.most_tilt", |a| a.dead_centre.most_tilt),
        ("peak_force", |a| a.peak_force),
    ];
    let names = Column::Texts(kept.iter().map(|(case, _)| case.name.clone()).collect());
    columns.into_iter().fold(Frame::default().with("case", names), |frame, (name, of)| frame.reals(name, column(of)))
}
